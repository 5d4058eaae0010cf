#include "render/wave/nearest_hits.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace openrt {

Rays copyRays(const Rays& rays, const uint32_t* rayLanes, uint32_t n, Arena& arena) {
  Rays out;
  out.allocate(arena, n);
  for (uint32_t i = 0; i < n; i++) {
    const uint32_t lane = rayLanes[i];
    store(load(rays.org, lane), out.org, i);
    store(load(rays.dir, lane), out.dir, i);
    out.tnear[i] = rays.tnear[lane];
    out.tfar[i] = rays.tfar[lane];
  }
  return out;
}

void skipCulledBacks(const RenderScene& scene, Arena& arena, RayCounters& counters,
                     const Rays& rays, RayHits& hits, uint8_t* skipped) {
  ArenaScope scope(arena);
  auto* lanes = arena.take<uint32_t>(rays.count);
  uint32_t n = 0;
  for (uint32_t i = 0; i < rays.count; i++)
    if (hits.record[i] != noHit && isCulledHit(scene, rays, hits, i)) lanes[n++] = i;
  if (n == 0) return;
  for (uint32_t i = 0; skipped && i < n; i++) skipped[lanes[i]] = 1;
  const Rays again = copyRays(rays, lanes, n, arena);
  RayHits found;
  found.allocate(arena, n);
  counters.secondary += n;
  scene.kernel->intersectFronts(again, maskAll, found);
  for (uint32_t i = 0; i < n; i++) {
    const uint32_t lane = lanes[i];
    hits.t[lane] = found.t[i];
    hits.u[lane] = found.u[i];
    hits.v[lane] = found.v[i];
    store(load(found.ng, i), hits.ng, lane);
    hits.record[lane] = found.record[i];
    hits.primitive[lane] = found.primitive[i];
  }
}

RayHits findNearest(const StageContext& context, const Rays& rays, Coherence coherence,
                    const uint8_t* aimed, uint8_t* skipped) {
  RayHits hits;
  hits.allocate(context.arena, rays.count);
  context.scene.kernel->intersect(rays, maskAll, coherence, hits);
  if (aimed) context.scene.kernel->findLost(rays, aimed, hits);
  skipCulledBacks(context.scene, context.arena, context.counters, rays, hits, skipped);
  return hits;
}

// The directions are those of a Fibonacci lattice on the sphere (Gonzalez, "Measurement of areas on
// a sphere using Fibonacci and latitude-longitude lattices", 2010).
bool isEnclosed(const RenderScene& scene) {
  constexpr uint32_t count = 128, most = count / 32;
  constexpr double golden = 2.39996322972865332; // angle in radians
  Arena arena;
  Rays rays;
  rays.allocate(arena, count);
  for (uint32_t i = 0; i < count; i++) {
    const double z = 1 - (2 * i + 1.0) / count, r = std::sqrt(1 - z * z), turn = golden * i;
    store(scene.eye, rays.org, i);
    store(Vec3f(Vec3d{r * std::cos(turn), r * std::sin(turn), z}), rays.dir, i);
    rays.tnear[i] = 0;
    rays.tfar[i] = std::numeric_limits<float>::infinity();
  }
  RayHits hits;
  hits.allocate(arena, count);
  scene.kernel->intersect(rays, maskAll, Coherence::incoherent, hits);
  return std::count(hits.record, hits.record + count, noHit) <= most;
}

void findBlocked(const RenderScene& scene, const Rays& rays, uint8_t* blocked) {
  if (scene.kernel->cullsBacks())
    scene.kernel->occludedByFronts(rays, maskAll, blocked);
  else
    scene.kernel->occluded(rays, maskAll, Coherence::incoherent, blocked);
}

} // namespace openrt
