#include "render/wave/wave.h"

#include <algorithm>
#include <limits>

#include "render/wave/boundaries.h"
#include "render/wave/nearest_hits.h"

namespace openrt {

void loadWave(const RayQueue& queue, size_t begin, uint32_t n, Wave& wave) {
  wave.rays.count = n;
  for (int k = 0; k < 3; k++) {
    wave.rays.org[k] = queue.origin()[k] + begin;
    wave.rays.dir[k] = queue.direction()[k] + begin;
  }
  std::fill_n(wave.rays.tnear, n, 0.0f);
  std::fill_n(wave.rays.tfar, n, std::numeric_limits<float>::infinity());
  wave.states = queue.statesFrom(begin);
}

// Returns for each ray whether it may be aimed at a vertex (WaveSource). A miss within a medium
// would be a leak in any case, unless the body is open.
static const uint8_t* findAimed(const StageContext& context, WaveSource source, const Wave& wave) {
  const uint32_t n = wave.rays.count;
  auto* aimed = context.arena.take<uint8_t>(n);
  const bool fromSurfaces = source == WaveSource::surfaces;
  if (fromSurfaces && context.scene.enclosed) {
    std::fill_n(aimed, n, uint8_t(1));
    return aimed;
  }
  for (uint32_t i = 0; i < n; i++)
    aimed[i] = wave.states.media[i][0] != 0 || (fromSurfaces && wave.states.pdf[i] == 0);
  return aimed;
}

void findHits(const StageContext& context, WaveSource source, Wave& wave) {
  const uint32_t n = wave.rays.count;
  // A culled back face that a ray skips is a front face for the ray the other way.
  uint8_t* oneWay = context.scene.countsLightPaths() && context.scene.kernel->cullsBacks()
                        ? context.arena.takeZero<uint8_t>(n)
                        : nullptr;
  if (source == WaveSource::camera)
    wave.hits = findNearest(context, wave.rays, Coherence::coherent, nullptr, oneWay);
  else
    wave.hits = findNearest(context, wave.rays, Coherence::incoherent,
                            findAimed(context, source, wave), oneWay);
  for (uint32_t i = 0; oneWay && i < n; i++)
    if (oneWay[i]) wave.states.lightPathRatio[i] = 0;
}

void goToHits(const StageContext& context, Wave& wave) {
  absorbAlongRays(context.scene, wave.rays, wave.hits, wave.states);
  splitByHit(context.arena, wave);
}

void intersectWave(const StageContext& context, WaveSource source, Wave& wave) {
  findHits(context, source, wave);
  goToHits(context, wave);
}

void splitByHit(Arena& arena, Wave& wave) {
  const uint32_t n = wave.rays.count;
  auto *missed = arena.take<uint32_t>(n), *met = arena.take<uint32_t>(n);
  uint32_t misses = 0, hits = 0;
  for (uint32_t i = 0; i < n; i++)
    (wave.hits.record[i] == noHit ? missed[misses++] : met[hits++]) = i;
  wave.missed = {missed, misses};
  wave.met = {met, hits};
}

void queueRay(const Points& points, uint32_t i, const Vec3f& direction, const RayState& state,
              RayQueue& queue) {
  queue.push(liftPoint(points, i, direction), direction, state);
}

} // namespace openrt
