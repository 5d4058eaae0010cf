// tile_media.cpp: the part of TileRenderer for media that scatter: collisions are shaded like
// surfaces that have the phase function as their only lobe.
#include <algorithm>

#include "render/medium/containing_media.h"
#include "render/medium/flights.h"
#include "render/medium/phase_function.h"
#include "render/path/tile.h"

namespace openrt {

void TileRenderer::startInMedia(const Wave& wave) {
  ArenaScope scope(arena_);
  findContainingMedia(context_, wave.rays, wave.states.media);
}

// The channels of first surfaces show what is behind the medium, whether the light of the sample
// comes from there or from the medium.
void TileRenderer::describeBehindMedia(const Wave& wave, PixelSamples& found) {
  const bool describes = found.normal[0] || found.albedo[0] || found.position[0] ||
                         found.motion[0] || found.depth || has(RT_NAME);
  const uint32_t n = wave.rays.count;
  if (describes) {
    Wave seen;
    seen.rays = wave.rays;
    seen.states.allocate(arena_, n);
    for (uint32_t i = 0; i < n; i++) seen.states.set(i, wave.states[i]);
    guides_.describe(context_, seen, found);
  }
  std::fill_n(found.first, n, uint8_t(0));
}

// Scatters the collisions of each medium together, in the order of the media and then of the rays.
void TileRenderer::scatterInMedia(Wave& wave, PixelSamples& found) {
  ArenaScope scope(arena_);
  const Collisions all = sampleFlights(context_, samples_, firstPair(), wave);
  const std::span<const RtsMedium> media = scene_.shaders->media();
  const size_t n = all.lanes.size();
  auto* key = arena_.take<uint64_t>(n + 1); // the medium, then the place in `all`
  for (size_t i = 0; i < n; i++)
    key[i] = uint64_t(mediumOf(wave.states.media[all.lanes[i]], media)) << 32 | i;
  std::sort(key, key + n);
  auto* lane = arena_.take<uint32_t>(n + 1);
  auto* distance = arena_.take<float>(n + 1);
  for (size_t begin = 0, end; begin < n; begin = end) {
    const uint64_t medium = key[begin] >> 32;
    for (end = begin; end < n && key[end] >> 32 == medium; end++) {
      lane[end] = all.lanes[uint32_t(key[end])];
      distance[end] = all.distance[uint32_t(key[end])];
    }
    scatterInMedium(uint16_t(medium), wave, {{lane + begin, end - begin}, distance + begin}, found);
  }
}

void TileRenderer::scatterInMedium(uint16_t medium, const Wave& wave, const Collisions& collisions,
                                   PixelSamples& found) {
  ArenaScope scope(arena_);
  const Points points = collisionPoints(context_, wave, collisions);
  const uint32_t n = points.hits.count;
  RtsBatch batch = makeBatch(context_, points, wave.states);
  batch.lightSet = scene_.scatteringLightSets[medium - 1];
  const RtsLobe& lobe = *scene_.host.customLobe(&batch, &phaseLobe, 1);
  std::fill_n(lobe.data[0], padded(n), scene_.shaders->media()[medium - 1].anisotropy);
  float* radiance[3];
  for (int k = 0; k < 3; k++) {
    std::fill_n(lobe.weight[k], padded(n), 1.0f);
    radiance[k] = arena_.takeZero<float>(padded(n));
  }
  gatherLight(batch, {}, radiance);
  for (uint32_t i = 0; i < n; i++) {
    const uint32_t at = collisions.lanes[i], path = wave.states.path[at];
    const Vec3f throughput = load(wave.states.throughput, at);
    store(load(found.radiance, path) + throughput * load(radiance, i), found.radiance, path);
    if (!wave.states.flagsOf(at).deflected())
      found.alpha[path] += (throughput.x + throughput.y + throughput.z) / 3;
  }
}

} // namespace openrt
