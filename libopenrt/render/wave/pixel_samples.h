// pixel_samples.h: what the paths of a wave have found so far. Each path is a sample of a pixel.
// [render]
#pragma once

#include <cstdint>

#include "render/arena.h"
#include "render/wave/path_states.h"
#include "scene/channels.h"

namespace openrt {

class FirstHits;

struct PixelSamples { // all arrays are indexed by path
  float *radiance[3], *alpha;
  uint8_t* first; // 1 until the first surface of the path has been shaded
  // The values for the channels from ChannelSource::firstSample and from ChannelSource::mean, by
  // ChannelInfo::place. Null if the frame lacks the channel.
  float* firstValues[placesOf(ChannelSource::firstSample)] = {};
  float* meanValues[placesOf(ChannelSource::mean)] = {};
  uint32_t* names = nullptr; // the first surfaces have them; null if the frame lacks RT_COVERAGE
  // Pixels without light: 1 where the path has all of its light, because it leaves the scene at
  // once. Null: all paths have theirs.
  uint8_t* complete = nullptr;
  FirstHits* firstHits = nullptr; // RT_FOLLOW_IMAGES; null: first surfaces are recorded as they are

  // Allocates radiance and alpha, 0, of n paths. No channel is recorded, nor are first surfaces.
  void allocate(Arena& arena, uint32_t n);
  // Allocates the arrays for the channels of a frame; first surfaces are recorded.
  void allocateChannels(Arena& arena, uint32_t n, uint32_t channels);
  // Returns the arrays of a channel, one for each of its floats. They are null if the frame lacks
  // it.
  float* const* of(uint32_t channel) const {
    const ChannelInfo& row = channelInfo(channel);
    return (row.source == ChannelSource::mean ? meanValues : firstValues) + row.place;
  }
  // Adds light that a ray of a path has found.
  void add(uint32_t path, PathFlags flags, const Vec3f& light) {
    store(load(radiance, path) + light, radiance, path);
    float* const* const reflection = of(RT_REFLECTION);
    if (reflection[0] && flags.reflected()) store(load(reflection, path) + light, reflection, path);
  }
};

} // namespace openrt
