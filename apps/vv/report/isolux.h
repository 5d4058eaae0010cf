// isolux.h: Draws the readings of a grid of points as a picture for a page: paler false colours,
// isolines at round values, and the numbers themselves where there is room. Pure functions.
// [any thread]
#pragma once

#include <string>

#include "libpicture/measure.h"

namespace vv {

// Returns the picture as SVG; empty for a sensor without rows and columns, or without light.
std::string isoluxPicture(const picture::Measurement& readings);

} // namespace vv
