// sensors.h: Writes the readings of the world's sensors (--measure). [main thread]
#pragma once

#include <string>
#include <vector>

#include "libpicture/luminaires.h"
#include "libpicture/measure.h"
#include "options/options.h"

namespace vv {

// Writes the file of --measure and says the readings. luminaires: for a page. Throws Failure if
// there is no sensor, unless the user has interrupted the run.
void writeReadings(const Options& options, const std::string& commandLine,
                   const std::vector<picture::Measurement>& sensors,
                   std::vector<picture::Luminaire> luminaires);

} // namespace vv
