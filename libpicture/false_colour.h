// false_colour.h: shows the luminance of a picture in colours, with isolines at round values and a
// legend in cd/m2. Pure functions. [any thread]
#pragma once

#include <optional>

#include "libpicture/files/picture.h"

namespace picture {

// The values of a legend: round steps from 0 to `top`.
struct LuminanceScale {
  double step = 1, top = 1; // cd/m2; top is a multiple of step
};
// Returns a scale of 5 to 10 steps up to `most` or the next round value above it. most: above 0.
LuminanceScale luminanceScale(double most);

// Returns a picture in display colours (Picture::linear is false), wider than the given one by its
// legend. The given picture holds linear radiance, where 1 is 1 cd/m2. most: the luminance at the
// end of the scale; none: one that 99.5 % of the pixels stay below.
Picture falseColours(const Picture& picture, std::optional<double> most);

} // namespace picture
