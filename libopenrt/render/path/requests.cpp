#include "render/path/requests.h"

#include <algorithm>
#include <limits>

#include "render/lights/shadows.h"
#include "render/path/path_tracer.h"
#include "render/wave/nearest_hits.h"

namespace openrt {
namespace {

constexpr uint32_t maxNesting = 64;
constexpr float infinite = std::numeric_limits<float>::infinity();

// Makes the rays of a request whose point belongs to the batch and is wanted. Writes the index in
// the request of each ray to `to`.
template <class Wanted>
Rays raysOf(const RtsBatch& batch, const RtsRequest& request, uint32_t* to, const Wanted& wanted) {
  Rays rays;
  rays.allocate(batch.arena, request.count);
  uint32_t n = 0;
  for (uint32_t i = 0; i < request.count; i++) {
    const uint32_t hit = request.hit[i];
    if (hit >= batch.pointCount() || (!request.origin[0] && !batch.points) || !wanted(hit))
      continue;
    const Vec3f direction = load(request.direction, i);
    store(request.origin[0] ? load(request.origin, i)
                            : liftPoint(*batch.points, batch.pointOf(hit), direction),
          rays.org, n);
    store(direction, rays.dir, n);
    rays.tnear[n] = 0;
    rays.tfar[n] = request.length ? request.length[i] : infinite;
    to[n++] = i;
  }
  rays.count = n;
  return rays;
}

Rays raysOf(const RtsBatch& batch, const RtsRequest& request, uint32_t* to) {
  return raysOf(batch, request, to, [](uint32_t) { return true; });
}

} // namespace

void traceRequest(RtsBatch& batch, const RtsRequest& request, float* const rgba[4]) {
  for (int k = 0; k < 4; k++)
    if (rgba[k]) std::fill_n(rgba[k], request.count, 0.0f);
  const PathTracer& outer = *batch.tracer;
  const uint32_t depth = batch.scene.frame.depth, level = outer.level();
  if (request.count == 0 || outer.nesting() == maxNesting || level >= depth + mostPassages) return;
  Arena& arena = batch.arena;
  // The counts are allocated outside of the arena scope, because they live as long as the batch.
  if (!batch.requests) batch.requests = arena.takeZero<uint32_t>(batch.pointCount());
  ArenaScope scope(arena);
  auto* to = arena.take<uint32_t>(request.count);
  Wave wave;
  wave.rays = raysOf(batch, request, to, [&](uint32_t hit) {
    return level < depth || (batch.order && isWithinDepth(batch.states->flagsOf(batch.order[hit]),
                                                          level + 1, depth));
  });
  const uint32_t n = wave.rays.count;
  if (n == 0) return;
  wave.states.allocate(arena, n);
  PixelSamples found;
  found.allocate(arena, n);
  auto* parentPath = arena.take<uint32_t>(n);
  PathSamples samples;
  samples.allocate(arena, n);
  samples.random = arena.takeZero<uint8_t>(n);
  for (uint32_t i = 0; i < n; i++) {
    const uint32_t hit = request.hit[to[i]];
    const RayState parent = batch.order ? (*batch.states)[batch.order[hit]] : RayState{.path = hit};
    parentPath[i] = parent.path;
    samples.key[i] = outer.samples().key[parent.path];
    samples.index[i] = outer.samples().index[parent.path];
    RayState state{.path = i};
    state.branch = hash(parent.branch + ++batch.requests[hit], level + 1);
    state.media = parent.media;
    state.flags.setChannel(parent.flags.channel());
    state.flags.setPassages(parent.flags.passages());
    if (batch.points) state.travelled = batch.points->hits.distance[batch.pointOf(hit)];
    wave.states.set(i, state);
  }
  (batch.points ? batch.counters.secondary : batch.counters.camera) += n;
  PathTracer tracer(outer, samples, level + (batch.points ? 1 : 0));
  tracer.trace(wave, found);
  for (uint32_t i = 0; i < n; i++) {
    if (samples.random[i]) outer.samples().markRandom(parentPath[i]);
    for (int k = 0; k < 3; k++)
      if (rgba[k]) rgba[k][to[i]] = found.radiance[k][i];
    if (rgba[3]) rgba[3][to[i]] = found.alpha[i];
  }
}

void findRequest(const RtsBatch& batch, const RtsRequest& request, RtsFound& out) {
  if (out.distance) std::fill_n(out.distance, request.count, infinite);
  if (request.count == 0) return;
  const RenderScene& scene = batch.scene;
  Arena& arena = batch.arena;
  ArenaScope scope(arena);
  auto* to = arena.take<uint32_t>(request.count);
  Wave wave;
  wave.rays = raysOf(batch, request, to);
  batch.counters.secondary += wave.rays.count;
  wave.hits = findNearest(batch, wave.rays, Coherence::incoherent);
  splitByHit(arena, wave);
  const uint32_t n = uint32_t(wave.met.size());
  if (n == 0) return;
  const auto* travelled = arena.takeZero<float>(padded(wave.rays.count));
  const Points points =
      makePoints(scene, wave.rays, wave.hits, wave.met.data(), n, travelled, arena);
  for (uint32_t i = 0; i < n; i++) {
    const uint32_t r = to[wave.met[i]];
    if (out.distance) out.distance[r] = points.hits.segment[i];
    if (out.name) out.name[r] = scene.records[points.record[i]].name;
    for (int k = 0; k < 3; k++) {
      if (out.position[k]) out.position[k][r] = points.hits.position[k][i];
      if (out.geometric[k]) out.geometric[k][r] = points.hits.geometric[k][i];
      if (out.normal[k]) out.normal[k][r] = points.hits.normal[k][i];
    }
  }
}

void occludeRequest(const RtsBatch& batch, const RtsRequest& request,
                    float* const transmission[3]) {
  for (int k = 0; k < 3; k++) std::fill_n(transmission[k], request.count, 1.0f);
  if (request.count == 0) return;
  ArenaScope scope(batch.arena);
  ShadowRays rays = allocateShadowRays(batch.scene, request.count, batch.arena);
  rays.rays = raysOf(batch, request, rays.lane);
  rays.hit = request.hit;
  if (rays.media && batch.order)
    for (uint32_t r = 0; r < rays.rays.count; r++)
      rays.media[r] = batch.states->media[batch.order[request.hit[rays.lane[r]]]];
  traceTransmittance(batch, rays, transmission);
}

} // namespace openrt
