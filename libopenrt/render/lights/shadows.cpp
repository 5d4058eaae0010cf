// shadows.cpp: shadow rays of a batch, compacted. They are tested against all opaque surfaces
// first. If the scene has transparent surfaces, the unoccluded rays then pass these one after the
// other.
#include "render/lights/shadows.h"

#include <algorithm>
#include <limits>

#include "render/film/ledger.h"
#include "render/surface/lobes.h"
#include "render/surface/surface_shader.h"
#include "render/wave/boundaries.h"
#include "scene/transports.h"
#include "shading/running.h"

namespace openrt {
namespace {

// Makes a shadow ray for every wanted lane that the light can reach.
ShadowRays makeRays(RtsBatch& batch, const uint8_t* wanted, const RtsIllumination& light) {
  const RtsHits& hits = batch.points->hits;
  ShadowRays s = allocateShadowRays(batch.scene, hits.count, batch.arena);
  uint32_t n = 0;
  for (uint32_t i = 0; i < hits.count; i++) {
    if (!wanted[i] || !(batch.lights.directional || batch.lights.reach[i] > 0)) continue;
    if (load(light.color, i) == Vec3f()) continue;
    const Vec3f toLight = load(light.toLight, i);
    Vec3f g = load(hits.geometric, i), p = load(hits.position, i);
    // If the facet faces away from the light but the smooth surface does not, the ray starts on the
    // smooth surface, or behind the facet if the surface is flat. Light that is transmitted through
    // the surface (2) arrives from behind.
    const bool away = dot(g, toLight) < 0;
    if (away && (wanted[i] == 2 || !liftToSmooth(batch.scene, *batch.points, i, p))) g = -g;
    store(offsetPoint(p, g, batch.points->error[i]), s.rays.org, n);
    store(toLight, s.rays.dir, n);
    s.rays.tnear[n] = 0;
    s.rays.tfar[n] = batch.lights.directional ? std::numeric_limits<float>::infinity()
                                              : batch.lights.reach[i] * (1 - 0x1p-20f);
    if (s.media && batch.order)
      s.media[n] = mediaTowards(*batch.points, i, toLight, batch.crossing,
                                batch.states->media[batch.order[i]]);
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
    if (s.media) s.media[n] = s.media[i];
    s.lane[n++] = s.lane[i];
  }
  s.rays.count = n;
}

// Attenuates the colours by the media along the rays, up to their hits or ends. A ray that leaves
// the scene is not inside a closed body.
void attenuate(const RenderScene& scene, const ShadowRays& s, const RayHits& found,
               float* const color[3]) {
  const std::span<const RtsMedium> media = scene.shaders->media();
  for (uint32_t i = 0; i < s.rays.count; i++) {
    const uint16_t medium = mediumOf(s.media[i], media);
    const float length = found.record[i] == noHit ? s.rays.tfar[i] : found.t[i];
    if (!medium || !std::isfinite(length)) continue;
    Vec3f left = load(color, s.lane[i]);
    absorb(medium, std::min(length, 1e30f), media, left);
    store(left, color, s.lane[i]);
  }
}

// Crosses the boundaries of media at hits of shadow rays.
Boundaries crossWithMedia(const RtsBatch& batch, const ShadowRays& s, const Points& points,
                          const RtsClass& shaderClass, float* const color[3]) {
  PathStates states{};
  states.media = s.media;
  states.flags = batch.arena.takeZero<uint32_t>(s.rays.count);
  for (auto& colour : states.throughput) {
    colour = batch.arena.take<float>(s.rays.count);
    std::fill_n(colour, s.rays.count, 1.0f);
  }
  RtsBatch inner = batch;
  inner.tracer = nullptr;
  inner.points = &points;
  inner.states = &states;
  inner.order = points.order;
  inner.lobes.clear();
  const Boundaries boundaries = crossBoundaries(inner, shaderClass);
  for (uint32_t i = 0; i < points.hits.count; i++) // bodies that were left but never entered
    scaleColor(color, s.lane[points.order[i]], load(states.throughput, points.order[i]));
  return boundaries;
}

// Finds the nearest transparent surface along each ray.
void intersectTransparent(const RenderScene& scene, const ShadowRays& s, RayHits& found) {
  if (s.toEmitters && scene.kernel->cullsBacks())
    scene.kernel->intersectFronts(s.rays, maskTransparent, found);
  else
    scene.kernel->intersect(s.rays, maskTransparent, Coherence::incoherent, found);
}

// Computes the transmittance of the hits of shadow rays. A class may have a straight approximation
// of glass (`transmit`) although its lobes bend light, so light samples ask for its lobes.
void transmitAt(const RtsBatch& batch, const ShadowRays& s, const RtsClass& shaderClass,
                const Points& points, float* const through[3]) {
  const RenderScene& scene = batch.scene;
  const uint32_t n = points.hits.count;
  if (s.toEmitters) {
    if (shaderClass.medium) return;
    const bool specular = std::any_of(points.record, points.record + n, [&](uint32_t record) {
      return ((*scene.shaders)[scene.records[record].shader].traits & RTS_SPECULAR) != 0;
    });
    if (shaderClass.surface && specular) {
      RtsBatch surfaces{static_cast<const StageContext&>(batch)};
      surfaces.tracer = nullptr;
      surfaces.points = &points;
      runSurfaceShader(surfaces, shaderClass);
      for (const RtsLobe& lobe : surfaces.lobes)
        for (uint32_t i = 0; i < n && lobe.kind == RTS_LOBE_TRANSPARENT; i++)
          if (Vec3f weight; weightAt(lobe, i, weight)) store(load(through, i) + weight, through, i);
      return;
    }
  } else if ((scene.lightSources || s.toCamera) && shaderClass.surface && shaderClass.medium) {
    return; // light tracing follows the refracted light
  }
  if (!shaderClass.transmit) return;
  RtsBatch inner = batch;
  inner.tracer = nullptr;
  inner.points = &points;
  const RunningShader running(shaderClass);
  shaderClass.transmit(&scene.host, &inner, &points.hits, through);
}

// Advances every ray by one transparent surface; rays that hit none are done.
void crossTransparentSurface(const RtsBatch& batch, ShadowRays& s, RayHits& found, uint8_t* done,
                             float* const color[3]) {
  const RenderScene& scene = batch.scene;
  Arena& arena = batch.arena;
  ArenaScope scope(arena);
  intersectTransparent(scene, s, found);
  if (s.media) attenuate(scene, s, found, color);
  uint32_t n = 0;
  auto* met = arena.take<uint32_t>(s.rays.count + 1);
  for (uint32_t i = 0; i < s.rays.count; i++) {
    done[i] = found.record[i] == noHit;
    if (!done[i])
      met[n++] = i;
    else if (s.lastOrigin)
      store(load(s.rays.org, i), s.lastOrigin, s.lane[i]);
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
    const Boundaries boundaries =
        s.media ? crossWithMedia(batch, s, points, shaderClass, color) : Boundaries();
    transmitAt(batch, s, shaderClass, points, through);
    for (uint32_t i = 0; i < m; i++) {
      const uint32_t ray = order[range.begin + i];
      const Vec3f t = boundaries.visibleAt(i)
                          ? min(max(Vec3f(), load(through, i)), {1, 1, 1}) // NaN: opaque
                          : Vec3f{1, 1, 1};
      scaleColor(color, s.lane[ray], t);
      if (t.x + t.y + t.z < 1e-6f) {
        done[ray] = 1;
        continue;
      }
      const Vec3f p = load(points.hits.position, i), behind = -load(points.hits.geometric, i);
      store(offsetPoint(p, behind, points.error[i]), s.rays.org, ray);
      s.rays.tfar[ray] -= found.t[ray];
      if (boundaries.crossing) s.media[ray] = boundaries.crossing[i].behind;
      if (!(s.rays.tfar[ray] > 0)) done[ray] = 1;
    }
  }
}

} // namespace

ShadowRays allocateShadowRays(const RenderScene& scene, uint32_t capacity, Arena& arena,
                              bool toEmitters) {
  ShadowRays s{};
  s.toEmitters = toEmitters;
  s.rays.allocate(arena, capacity);
  s.lane = arena.take<uint32_t>(capacity);
  if (scene.absorbingShadows || (toEmitters && !scene.shaders->media().empty())) {
    s.media = arena.take<MediaStack>(capacity);
    std::fill_n(s.media, capacity, MediaStack{});
  }
  return s;
}

bool passesStraight(const ShaderSlot& shader) {
  return (shader.traits & RTS_TRANSPARENT) && !shader.shaderClass->medium;
}

bool samplesPass(const RenderScene& scene) {
  if (!scene.mediumLights.empty()) return true;
  if (!tracesPaths(scene.frame.transport) || !scene.transparentShadows) return false;
  return std::any_of(scene.records.begin(), scene.records.end(), [&](const Record& record) {
    return passesStraight((*scene.shaders)[record.shader]);
  });
}

namespace {

// Makes rays dark that have passed as many surfaces as are allowed, and counts what is cut: the
// part of the light that had come so far, times the throughput of the path.
void cutRest(const RtsBatch& batch, const ShadowRays& s, const float* const before[3],
             float* const color[3]) {
  for (uint32_t i = 0; i < s.rays.count; i++) {
    const uint32_t lane = s.lane[i], hit = s.hit ? s.hit[lane] : lane;
    const Vec3f carried =
        batch.order ? load(batch.states->throughput, batch.order[hit]) : Vec3f{1, 1, 1};
    for (int k = 0; k < 3 && batch.ledger; k++)
      if (before[k][lane] > 0)
        batch.ledger->cutByDepth +=
            double(carried[k]) * double(color[k][lane]) / double(before[k][lane]);
    scaleColor(color, lane, {});
  }
}

} // namespace

void traceTransmittance(const RtsBatch& batch, ShadowRays& s, float* const color[3]) {
  if (s.rays.count == 0) return;
  ArenaScope scope(batch.arena);
  const RenderScene& scene = batch.scene;
  batch.counters.shadow += s.rays.count;
  auto* blocked = batch.arena.take<uint8_t>(s.rays.count);
  if (s.toEmitters && scene.kernel->cullsBacks())
    scene.kernel->occludedByFronts(s.rays, maskOpaque, blocked);
  else
    scene.kernel->occluded(s.rays, maskOpaque, Coherence::coherent, blocked);
  for (uint32_t i = 0; i < s.rays.count; i++)
    if (blocked[i]) scaleColor(color, s.lane[i], {});
  if (!scene.transparentShadows && !s.media) return;
  compact(s, blocked);
  if (s.rays.count == 0) return;
  RayHits found;
  found.allocate(batch.arena, s.rays.count);
  float* before[3]; // by lane
  for (int k = 0; k < 3; k++) {
    before[k] = batch.arena.take<float>(s.lane[s.rays.count - 1] + 1);
    for (uint32_t i = 0; i < s.rays.count; i++) before[k][s.lane[i]] = color[k][s.lane[i]];
  }
  // The last pass finds that a ray meets no further surface.
  for (uint32_t pass = 0; s.rays.count && pass <= mostPassages; pass++) {
    crossTransparentSurface(batch, s, found, blocked, color);
    compact(s, blocked);
  }
  cutRest(batch, s, before, color);
}

void castShadows(RtsBatch& batch, const uint8_t* wanted, RtsIllumination& light) {
  ArenaScope scope(batch.arena);
  ShadowRays s = makeRays(batch, wanted, light);
  traceTransmittance(batch, s, light.color);
}

} // namespace openrt
