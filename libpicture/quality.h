// quality.h: the ranges of quality settings, as the library's own table gives them
// (rtGetQualityInfo), for the command line and Python. [any thread]
#pragma once

#include <string>
#include <vector>

#include "openrt/openrt.h"

namespace picture {

// Returns what the library knows about a setting (RT_SAMPLES_PER_PIXEL ...).
RTqualityInfo qualityInfo(RTenum quality);
// Returns "a whole number from 1 to 65536" or "a number from 0 to 1", for messages.
std::string qualityRange(RTenum quality);
// Returns the names of a setting's values, for example "auto", "direct" and so on for RT_TRANSPORT.
std::vector<std::string> qualityChoices(RTenum quality);

} // namespace picture
