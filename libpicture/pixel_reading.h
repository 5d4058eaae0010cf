// pixel_reading.h: Reads the light of one pixel of a picture, with its error bars. A pure function.
// [any thread]
#pragma once

#include <cstdint>

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

} // namespace picture
