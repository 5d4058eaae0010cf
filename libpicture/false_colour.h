// false_colour.h: shows the luminance of a picture in colours, with isolines at round values and a
// legend in cd/m2. Pure functions. [any thread]
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "libpicture/files/picture.h"

namespace picture {

// The values of a legend: round steps from 0 to `top`.
struct LuminanceScale {
  double step = 1, top = 1; // cd/m2; top is a multiple of step
};
// Returns a scale of 5 to 10 steps up to `most` or the next round value above it. most: above 0.
LuminanceScale luminanceScale(double most);

// Returns the display colour of a share of the scale, from 0 to 1.
std::array<float, 3> scaleColour(double at);

// Returns the luminance that 95 % of the pixels stay below; 1 if the picture is black.
double mostLuminance(const Picture& picture);

enum class Legend : uint8_t {
  beside, // makes the picture wider
  apart   // drawn by itself, with falseColourLegend()
};

// Returns a picture in display colours (Picture::linear is false). The given picture holds linear
// radiance, where 1 is 1 cd/m2. most: the luminance at the end of the scale; none: mostLuminance()
// of the picture. width, height: the size of the result without a legend, for which luminances are
// interpolated, so that isolines are as fine as its pixels; 0: that of the picture.
Picture falseColours(const Picture& picture, std::optional<double> most,
                     Legend legend = Legend::beside, int width = 0, int height = 0);

// Returns the legend of such a picture of this height by itself, in display colours.
Picture falseColourLegend(double most, int height);

} // namespace picture
