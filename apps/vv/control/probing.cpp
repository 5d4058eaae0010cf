#include "control/probing.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "libpicture/pixel_reading.h"

namespace vv::control {

namespace {

// Returns the pixel that holds a place from -1 to 1, or the next one to it that does not touch the
// border: the intervals there follow from the whole picture.
int pixelAt(double place, int count) {
  const int pixel = std::min(int((place + 1) / 2 * count), count - 1);
  return count < 3 ? pixel : std::clamp(pixel, 1, count - 2);
}

std::string numberText(float number) {
  return std::isfinite(number) ? fmt::format("{}", number) : "null";
}
std::string triple(const float (&v)[3]) {
  return fmt::format("[{},{},{}]", numberText(v[0]), numberText(v[1]), numberText(v[2]));
}

} // namespace

Probing probingAt(const Probe& probe, const picture::RenderSettings& settings) {
  picture::RenderSettings part = settings;
  part.channels = picture::readingChannels;
  Probing probing;
  probing.x = pixelAt(probe.place.x, settings.width);
  probing.y = pixelAt(-probe.place.y, settings.height);
  part.crop = {probing.x, probing.y, 1, 1};
  if (picture::whyNoCrop(part).empty())
    probing.x = probing.y = 0;
  else
    part.crop = {};
  probing.still = {settings.width, settings.height, settings.samples, part.channels, part.crop};
  return probing;
}

std::string resultOf(const Probing& probing, const picture::Picture& picture) {
  const picture::PixelReading read = picture::readPixel(picture, probing.x, probing.y);
  return fmt::format(
      R"({{"luminance":{},"half_width":{},"radiance":{},"radiance_half_width":{},"samples":{},"trusted":{},"hit":{}}})",
      numberText(read.luminance), numberText(read.luminanceHalfWidth), triple(read.radiance),
      triple(read.halfWidth), read.samples, read.trusted, probing.hit);
}

std::string resultOf(const picture::Measurement& read, const std::string& hit) {
  return fmt::format(R"({{"illuminance":{},"half_width":{},"samples":{},"trusted":{},"hit":{}}})",
                     numberText(read.value[0]), numberText(read.halfWidth[0]), read.samples[0],
                     read.trusted[0] != 0, hit);
}

} // namespace vv::control
