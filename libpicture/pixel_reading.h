// pixel_reading.h: Reads the light of pixels of a picture, with their error bars, and judges
// changes between two pictures. Pure functions. [any thread]
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "libpicture/files/picture.h"
#include "openrt/openrt.h"

namespace picture {

// The channels that a picture needs for it.
inline constexpr uint32_t readingChannels = RT_RGBA | RT_ERROR | RT_TRUST | RT_SAMPLES;

struct PixelReading {
  // Radiance, and half of its 95 % interval, of red, green and blue: a radiance of 1 is 1 cd/m2.
  float radiance[3] = {}, halfWidth[3] = {};
  // The interval of the luminance is that of colours that err together: it is never too narrow.
  float luminance = 0, luminanceHalfWidth = 0; // cd/m2
  uint32_t samples = 0;
  bool trusted = false; // the intervals can be trusted (docs/error-bars.md)
};

// picture: has readingChannels, and linear light. x, y: from the left upper corner.
PixelReading readPixel(const Picture& picture, int x, int y);
// Reads the pixel at a place, from -1 at the left and bottom of the picture to 1 at its right and
// top.
PixelReading readPlace(const Picture& picture, double x, double y);

// The luminances of all pixels of a picture that has rgba, error and trust. The picture must live
// as long.
class PixelLights {
 public:
  explicit PixelLights(const Picture& picture);
  bool isTrusted(size_t pixel) const { return trust_[pixel] > 0; }
  PixelReading luminance(size_t pixel) const; // has only the luminance and its interval

 private:
  const std::vector<float>&rgba_, &error_, &trust_;
};

// The change of the luminance from one reading to another.
struct LightDifference {
  double value = 0, halfWidth = 0; // cd/m2, with half of the 95 % interval
  // The probability of a change that is at least as large, if nothing has changed; 1 if the
  // interval contains 0.
  double chance = 1;
  bool isSignificant = false; // among all that were judged together
};

// Returns the change between readings of two pictures (B. L. Welch, Biometrika 34, 1947). The
// pictures are taken as independent; where they share random numbers, the interval is too wide.
LightDifference differenceBetween(const PixelReading& before, const PixelReading& now);

} // namespace picture
