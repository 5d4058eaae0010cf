#include "libpicture/pixel_reading.h"

#include <algorithm>

#include "libpicture/luminance.h"

namespace picture {

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

} // namespace picture
