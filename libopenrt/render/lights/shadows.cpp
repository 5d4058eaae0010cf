// shadows.cpp: shadow rays of a batch, compacted. They are tested against all opaque surfaces
// first. If the scene has transparent surfaces, the unoccluded rays then pass these one after the
// other.
#include "render/lights/shadows.h"
#include "shading/running.h"

#include <limits>

namespace openrt {
namespace {

// Makes a shadow ray for every wanted lane that the light can reach.
ShadowRays makeRays(RtsBatch& batch, const uint8_t* wanted, const RtsIllumination& light) {
  const RtsHits& hits = batch.points->hits;
  ShadowRays s;
  s.rays.allocate(*batch.arena, hits.count);
  s.lane = batch.arena->take<uint32_t>(hits.count);
  uint32_t n = 0;
  for (uint32_t i = 0; i < hits.count; i++) {
    if (!wanted[i] || !(batch.directional || batch.reach[i] > 0)) continue;
    if (load(light.color, i) == Vec3f()) continue;
    const Vec3f toLight = load(light.toLight, i);
    Vec3f g = load(hits.geometric, i), p = load(hits.position, i);
    // If the facet faces away from the light but the smooth surface does not, the ray starts on the
    // smooth surface, or behind the facet if the surface is flat. Light that is transmitted through
    // the surface (2) arrives from behind.
    const bool away = dot(g, toLight) < 0;
    if (away && (wanted[i] == 2 || !liftToSmooth(*batch.scene, *batch.points, i, p))) g = -g;
    store(offsetPoint(p, g, batch.points->error[i]), s.rays.org, n);
    store(toLight, s.rays.dir, n);
    s.rays.tnear[n] = 0;
    s.rays.tfar[n] = batch.directional ? std::numeric_limits<float>::infinity()
                                       : batch.reach[i] * (1 - 0x1p-20f);
    s.lane[n++] = i;
  }
  s.rays.count = n;
  return s;
}

void scaleColor(float* const color[3], uint32_t lane, const Vec3f& by) {
  store(load(color, lane) * by, color, lane);
}

// Removes the rays whose flag is set.
void compact(ShadowRays& s, const uint8_t* drop) {
  uint32_t n = 0;
  for (uint32_t i = 0; i < s.rays.count; i++) {
    if (drop[i]) continue;
    store(load(s.rays.org, i), s.rays.org, n);
    store(load(s.rays.dir, i), s.rays.dir, n);
    s.rays.tnear[n] = s.rays.tnear[i];
    s.rays.tfar[n] = s.rays.tfar[i];
    s.lane[n++] = s.lane[i];
  }
  s.rays.count = n;
}

// Advances every ray by one transparent surface; rays that hit none are done.
void crossTransparentSurface(const RtsBatch& batch, ShadowRays& s, RayHits& found, uint8_t* done,
                             float* const color[3]) {
  const RenderScene& scene = *batch.scene;
  Arena& arena = *batch.arena;
  ArenaScope scope(arena);
  scene.kernel->intersect(s.rays, maskTransparent, Coherence::incoherent, found);
  uint32_t n = 0;
  auto* met = arena.take<uint32_t>(s.rays.count + 1);
  for (uint32_t i = 0; i < s.rays.count; i++) {
    done[i] = found.record[i] == noHit;
    if (!done[i]) met[n++] = i;
  }
  if (n == 0) return;
  auto* order = arena.take<uint32_t>(n);
  auto* travelled = arena.takeZero<float>(s.rays.count);
  for (const BucketRange& range : sortByBucket(scene, found, met, n, order, arena)) {
    const uint32_t m = range.end - range.begin;
    const Points points =
        makePoints(scene, s.rays, found, order + range.begin, m, travelled, arena);
    float* through[3];
    for (auto& a : through) a = arena.takeZero<float>(padded(m));
    const RtsClass& shaderClass = *scene.buckets[range.bucket].shaderClass;
    RtsBatch inner = batch;
    inner.tracer = nullptr;
    inner.points = &points;
    // With light tracing, glass is opaque to shadow rays: light tracing follows the refracted
    // light.
    if (shaderClass.transmit &&
        !(scene.lightSources && shaderClass.surface && shaderClass.medium)) {
      const RunningShader running(shaderClass);
      shaderClass.transmit(&scene.host, &inner, &points.hits, through);
    }
    for (uint32_t i = 0; i < m; i++) {
      const uint32_t ray = order[range.begin + i];
      const Vec3f t = min(max(Vec3f(), load(through, i)), {1, 1, 1}); // NaN: opaque
      scaleColor(color, s.lane[ray], t);
      if (t.x + t.y + t.z < 1e-6f) {
        done[ray] = 1;
        continue;
      }
      const Vec3f p = load(points.hits.position, i), behind = -load(points.hits.geometric, i);
      store(offsetPoint(p, behind, points.error[i]), s.rays.org, ray);
      s.rays.tfar[ray] -= found.t[ray];
      if (!(s.rays.tfar[ray] > 0)) done[ray] = 1;
    }
  }
}

} // namespace

void traceTransmittance(const RtsBatch& batch, ShadowRays& s, float* const color[3]) {
  if (s.rays.count == 0) return;
  ArenaScope scope(*batch.arena);
  const RenderScene& scene = *batch.scene;
  batch.counters->shadow += s.rays.count;
  auto* blocked = batch.arena->take<uint8_t>(s.rays.count);
  scene.kernel->occluded(s.rays, maskOpaque, Coherence::coherent, blocked);
  for (uint32_t i = 0; i < s.rays.count; i++)
    if (blocked[i]) scaleColor(color, s.lane[i], {});
  if (!scene.transparentShadows) return;
  compact(s, blocked);
  RayHits found;
  found.allocate(*batch.arena, s.rays.count);
  for (uint32_t pass = 0; s.rays.count && pass < scene.frame.depth; pass++) {
    crossTransparentSurface(batch, s, found, blocked, color);
    compact(s, blocked);
  }
  for (uint32_t i = 0; i < s.rays.count; i++)
    // rays that cross too many transparent surfaces are dark, as documented
    scaleColor(color, s.lane[i], {});
}

void castShadows(RtsBatch& batch, const uint8_t* wanted, RtsIllumination& light) {
  ArenaScope scope(*batch.arena);
  ShadowRays s = makeRays(batch, wanted, light);
  traceTransmittance(batch, s, light.color);
}

} // namespace openrt
