#include "libpicture/pixel_reading.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "libpicture/luminance.h"
#include "student.h"

namespace picture {

namespace {

// Degrees of freedom of an interval that is trusted: it has at least 8 replicates. Most have more,
// but a picture does not say how many.
constexpr double fewestFreedom = 7;
// Half-width in standard errors where there are very many.
constexpr double normalQuantile = 1.959963985;

} // namespace

PixelReading readPixel(const Picture& picture, int x, int y) {
  const size_t at = size_t(y) * size_t(picture.width) + size_t(x);
  PixelReading reading;
  std::copy_n(&picture.planes.at(RT_RGBA)[4 * at], 3, reading.radiance);
  std::copy_n(&picture.planes.at(RT_ERROR)[3 * at], 3, reading.halfWidth);
  reading.luminance = luminanceOf(reading.radiance);
  reading.luminanceHalfWidth = luminanceOf(reading.halfWidth);
  reading.samples = uint32_t(picture.planes.at(RT_SAMPLES)[at]);
  reading.trusted = picture.planes.at(RT_TRUST)[at] > 0;
  return reading;
}

PixelReading readPlace(const Picture& picture, double x, double y) {
  const auto pixel = [](double part, int count) {
    return std::clamp(int(part / 2 * count), 0, count - 1);
  };
  return readPixel(picture, pixel(1 + x, picture.width), pixel(1 - y, picture.height));
}

PixelLights::PixelLights(const Picture& picture)
    : rgba_(picture.planes.at(RT_RGBA)), error_(picture.planes.at(RT_ERROR)),
      trust_(picture.planes.at(RT_TRUST)) {}

PixelReading PixelLights::luminance(size_t pixel) const {
  PixelReading reading;
  reading.luminance = luminanceOf(&rgba_[4 * pixel]);
  reading.luminanceHalfWidth = luminanceOf(&error_[3 * pixel]);
  return reading;
}

LightDifference differenceBetween(const PixelReading& before, const PixelReading& now) {
  const double a = double(before.luminanceHalfWidth), b = double(now.luminanceHalfWidth);
  LightDifference difference;
  difference.value = double(now.luminance) - double(before.luminance);
  difference.halfWidth = std::hypot(a, b);
  // Nothing is to be judged if the interval contains 0.
  if (!(std::abs(difference.value) > difference.halfWidth)) return difference;
  difference.chance = 0;
  if (difference.halfWidth == 0) return difference; // both pictures are exact
  // Degrees of freedom of the difference: F. E. Satterthwaite, Biometrics Bulletin 2, 1946.
  const double p = a / difference.halfWidth, q = b / difference.halfWidth;
  const double freedom = fewestFreedom / (p * p * p * p + q * q * q * q);
  // The chance is the largest one that any degrees of freedom from there on give: that of the
  // fewest, or of very many, whose half-widths are fewer standard errors.
  const double ratio = std::abs(difference.value) / difference.halfWidth;
  difference.chance =
      std::max(student::chanceBeyond(ratio * student::quantile95(fewestFreedom),
                                     std::max(int(freedom + 1e-9), int(fewestFreedom))),
               std::erfc(ratio * normalQuantile / std::numbers::sqrt2));
  return difference;
}

} // namespace picture
