#include "render/wave/pixel_samples.h"

#include <algorithm>

namespace openrt {

void PixelSamples::allocate(Arena& arena, uint32_t n) {
  const uint32_t size = padded(n);
  for (auto& colour : radiance) colour = arena.takeZero<float>(size);
  alpha = arena.takeZero<float>(size);
  first = arena.takeZero<uint8_t>(size);
}

void PixelSamples::allocateChannels(Arena& arena, uint32_t n, uint32_t channels) {
  const uint32_t size = padded(n);
  for (const ChannelInfo& row : channelTable) {
    if (row.source == ChannelSource::film || !(channels & row.bit)) continue;
    float** const values =
        (row.source == ChannelSource::mean ? meanValues : firstValues) + row.place;
    for (uint32_t k = 0; k < row.components; k++) {
      values[k] = arena.take<float>(size);
      std::fill_n(values[k], size, row.nothing);
    }
  }
  if (channels & RT_COVERAGE) names = arena.takeZero<uint32_t>(size);
  std::fill_n(first, size, uint8_t(1));
}

} // namespace openrt
