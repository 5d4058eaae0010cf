#include "render/wave/boundaries.h"

#include <algorithm>

namespace openrt {
namespace {

uint16_t mediumAt(const RenderScene& scene, uint32_t record) {
  return (*scene.shaders)[scene.records[record].shader].medium;
}

// Crosses shared faces. Where two media share a face, a ray hits only one of the two surfaces and
// continues beyond the other, so both are crossed at once. A short ray searches for the other face
// within the error bounds.
void crossSharedFaces(const RtsBatch& batch, Crossing* crossings) {
  const RenderScene& scene = batch.scene;
  const Points& points = *batch.points;
  const RtsHits& hits = points.hits;
  Arena& arena = batch.arena;
  ArenaScope scope(arena);
  Rays rays;
  rays.allocate(arena, hits.count);
  auto *hit = arena.take<uint32_t>(hits.count), *own = arena.take<uint32_t>(hits.count);
  uint32_t n = 0;
  for (uint32_t i = 0; i < hits.count; i++) {
    if (!mediumAt(scene, points.record[i])) continue;
    const Vec3f direction = load(hits.direction, i);
    const float cosine = -dot(load(hits.geometric, i), direction);
    const float reach =
        2 * points.error[i] / std::max(cosine, 1e-3f); // two error bounds along the normal
    store(load(hits.position, i) - reach * direction, rays.org, n);
    store(direction, rays.dir, n);
    rays.tnear[n] = 0;
    rays.tfar[n] = 2 * reach;
    own[n] = points.record[i];
    hit[n++] = i;
  }
  if (n == 0) return;
  rays.count = n;
  RayHits found;
  found.allocate(arena, n);
  scene.kernel->intersectOthers(rays, own, found);
  for (uint32_t r = 0; r < n; r++) {
    const uint16_t medium =
        found.record[r] == noHit ? uint16_t(0) : mediumAt(scene, found.record[r]);
    if (!medium) continue;
    const uint32_t i = hit[r];
    Crossing& c = crossings[i];
    const Crossing other =
        cross(c.behind, medium, isBackFaceHit(scene, rays, found, r), scene.shaders->media());
    c.behind = other.behind;
    c.to = mediumOf(c.behind, scene.shaders->media());
    c.visible = c.from != c.to;
    points.error[i] *= 4; // offsets the next ray beyond both faces
  }
}

// Attenuates the throughput of a ray by the absorption along `length` in a medium.
void absorbAt(uint16_t medium, float length, std::span<const RtsMedium> media,
              const PathStates& states, uint32_t lane) {
  if (!medium) return;
  Vec3f throughput = load(states.throughput, lane);
  absorb(medium, length, media, throughput);
  store(throughput, states.throughput, lane);
}

} // namespace

Boundaries crossBoundaries(RtsBatch& batch, const RtsClass& shaderClass) {
  Boundaries out;
  if (!shaderClass.medium) return out;
  const RenderScene& scene = batch.scene;
  const PathStates& states = *batch.states;
  const Points& points = *batch.points;
  const RtsHits& hits = points.hits;
  const std::span<const RtsMedium> media = scene.shaders->media();
  out.crossing = batch.arena.take<Crossing>(hits.count);
  out.eta = batch.arena.take<float[3]>(hits.count);
  for (uint32_t i = 0; i < hits.count; i++) {
    const uint16_t medium = mediumAt(scene, points.record[i]);
    const MediaStack& stack = states.media[batch.order[i]];
    Crossing& c = out.crossing[i] = {stack, 0, 0, true, false};
    if (medium) c = cross(stack, medium, hits.flags[i] & RTS_HIT_BACK, media);
  }
  if (scene.shaders->severalBodies()) crossSharedFaces(batch, out.crossing);
  auto* disperses = batch.arena.take<uint32_t>(padded(hits.count));
  bool any = false;
  uint64_t left = 0; // bodies that were never entered
  for (uint32_t i = 0; i < hits.count; i++) {
    const uint32_t lane = batch.order[i];
    const uint8_t channel = states.flagsOf(lane).channel();
    const Crossing& c = out.crossing[i];
    // Where the media at the start of paths are known, a body that was never entered is one that
    // the full stack has ignored.
    if (c.unknown && scene.mediumLights.empty()) {
      absorbAt(c.from, hits.segment[i], media, states, lane);
      const MediaStack& around = scene.aroundEye;
      left += std::find(around.begin(), around.end(), c.from) == around.end();
    }
    float* eta = out.eta[i];
    for (int k = 0; k < 3; k++) eta[k] = indexOf(c.from, k, media) / indexOf(c.to, k, media);
    disperses[i] = channel == 0 && (eta[0] != eta[1] || eta[0] != eta[2]);
    if (eta[0] == 1 && eta[1] == 1 && eta[2] == 1 &&
        ((*scene.shaders)[scene.records[points.record[i]].shader].traits & RTS_MEDIUM_ONLY))
      out.crossing[i].visible = false;
    any |= disperses[i] != 0;
    for (uint32_t l = 0; l < batch.lobes.size(); l++) {
      if (!c.visible)
        for (auto* weight : batch.lobes[l].weight) weight[i] = 0;
      // A rough boundary does not disperse light: it has the index of green.
      if (batch.lobes[l].kind == RTS_LOBE_ROUGH_DIELECTRIC)
        batch.lobes[l].parameter[0][i] = eta[channel ? channel - 1 : 1];
      if (batch.lobes[l].kind == RTS_LOBE_DIELECTRIC)
        batch.lobes[l].parameter[0][i] = eta[channel ? channel - 1 : 0];
    }
  }
  if (any) out.disperses = disperses;
  // Only camera paths tell here: paths from lamps may start in a body (light_tracer.cpp).
  if (left && batch.tracer) batch.counters.faults.add(shaderClass, Fault::neverEntered, left);
  return out;
}

void absorbAlongRays(const RenderScene& scene, const Rays& rays, const RayHits& hits,
                     const PathStates& states) {
  const std::span<const RtsMedium> media = scene.shaders->media();
  if (media.empty()) return;
  const bool collide = !scene.mediumLights.empty();
  // Light from infinity is fully absorbed in an absorbing medium.
  for (uint32_t i = 0; i < rays.count; i++) {
    const uint16_t medium = mediumOf(states.media[i], media);
    if (collide && medium && scatters(media[medium - 1])) continue; // sampleFlights() attenuates
    absorbAt(medium, std::min(hits.t[i], 1e30f), media, states, i);
  }
}

} // namespace openrt
