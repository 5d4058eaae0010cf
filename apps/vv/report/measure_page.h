// measure_page.h: The report of --measure on one page: what each sensor reads with its isolux
// picture, the luminaires, and the command that reads it again. Pure functions. [any thread]
#pragma once

#include <string>
#include <vector>

#include "libpicture/luminaires.h"
#include "report/measure_report.h"

namespace vv {

struct MeasurePage {
  std::string world;   // the name of its file
  std::string command; // measures again
  std::string sky;     // the words of --sky; empty: none
  Promise promise;
  std::vector<picture::Luminaire> luminaires;
};

// Returns a page of HTML that needs no other file and runs no program. Everything that comes from
// the world is escaped.
std::string measurementsPage(const std::vector<picture::Measurement>& sensors,
                             const MeasurePage& page);

} // namespace vv
