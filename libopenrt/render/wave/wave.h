// wave.h: a wave of rays, and the stages that find what its rays hit: load, intersect, look through
// culled backs, absorb, sort into buckets, make shading points. Path tracing and light tracing run
// the same ones. [render]
#pragma once

#include <span>

#include "render/wave/batch.h"
#include "render/wave/path_states.h"

namespace openrt {

// Rays that are traced together. All arrays are indexed by the ray's lane.
struct Wave {
  Rays rays;
  PathStates states{};
  RayHits hits{};
  std::span<uint32_t> missed, met; // lanes of the rays that hit nothing, and of the others
};

// Makes `n` rays of a queue, from ray `begin` on, those of the wave. Needs wave.rays.tnear and
// tfar of at least n elements.
void loadWave(const RayQueue& queue, size_t begin, uint32_t n, Wave& wave);

// Where the rays of a wave come from, which tells which of them may be aimed exactly at vertices of
// a mesh, where single precision loses hits.
//   camera    all: they follow the pixels' pattern
//   surfaces  those that mirrors, glass and openings send on, those within media, and, in scenes
//             that rays seldom leave (RenderScene::enclosed), all, because there it costs nothing
//   lamps     those within media, because the others have random directions
enum class WaveSource : uint8_t { camera, surfaces, lamps };

// Finds the nearest hit of each ray and looks through culled backs. The hits lie in the arena.
void findHits(const StageContext& context, WaveSource source, Wave& wave);
// Attenuates the throughputs by the media along the rays to their hits, and lists the rays that
// missed and met.
void goToHits(const StageContext& context, Wave& wave);
// Does both.
void intersectWave(const StageContext& context, WaveSource source, Wave& wave);

// Lists the rays of a wave that hit nothing, and the others, in the order of the lanes.
void splitByHit(Arena& arena, Wave& wave);

// Calls f(points, bucket) with the shading points of each bucket that rays of the wave have met.
template <class F> void forEachBucket(const StageContext& context, const Wave& wave, const F& f) {
  const uint32_t n = uint32_t(wave.met.size());
  auto* order = context.arena.take<uint32_t>(n);
  for (const BucketRange& range :
       sortByBucket(context.scene, wave.hits, wave.met.data(), n, order, context.arena)) {
    ArenaScope scope(context.arena);
    const Points points = makePoints(context.scene, wave.rays, wave.hits, order + range.begin,
                                     range.end - range.begin, wave.states.travelled, context.arena);
    f(points, context.scene.buckets[range.bucket]);
  }
}

// Queues a ray that starts at hit i, on the side of the surface that its direction leads to.
void queueRay(const Points& points, uint32_t i, const Vec3f& direction, const RayState& state,
              RayQueue& queue);

} // namespace openrt
