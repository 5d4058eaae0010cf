// trace.cpp: services that shaders and transport shaders request from the renderer: random points,
// radiance along rays, hits, occlusion. Part of TileRenderer; called by the host's functions
// (host.cpp). [render]
#include <algorithm>
#include <cmath>
#include <limits>

#include "render/lights/shadows.h"
#include "render/path/tile.h"
#include "render/surface/sanitize_output.h"
#include "render/wave/nearest_hits.h"
#include "shading/running.h"

namespace openrt {
namespace {

constexpr uint32_t maxNesting = 64;
// Keeps the sampler's pairs for shaders apart from those for the transports.
constexpr uint32_t shaderPairs = 0x73686164;
constexpr float infinite = std::numeric_limits<float>::infinity();

uint32_t pointsOf(const RtsBatch& batch) { return batch.points ? batch.hitCount() : batch.rays; }

// Makes the rays of a request whose point belongs to the batch and is wanted. Writes the index in
// the request of each ray to `to`.
template <class Wanted>
Rays raysOf(const RtsBatch& batch, const RtsRequest& request, uint32_t* to, const Wanted& wanted) {
  Rays rays;
  rays.allocate(*batch.arena, request.count);
  uint32_t n = 0;
  for (uint32_t i = 0; i < request.count; i++) {
    const uint32_t hit = request.hit[i];
    if (hit >= pointsOf(batch) || (!request.origin[0] && !batch.points) || !wanted(hit)) continue;
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

void TileRenderer::randomPoints(const RtsBatch& batch, uint32_t pair, float* const square[2]) {
  ArenaScope scope(arena_);
  const uint32_t n = pointsOf(batch);
  auto *key = arena_.take<uint32_t>(n), *index = arena_.take<uint32_t>(n),
       *pairs = arena_.take<uint32_t>(n);
  for (uint32_t i = 0; i < n; i++) {
    const uint32_t lane = batch.order ? batch.order[i] : i;
    const uint32_t path = batch.order ? batch.states->path[lane] : i;
    const uint32_t place = batch.order ? firstPair() + batch.states->branch[lane] : 0;
    key[i] = samples_.key[path];
    index[i] = samples_.index[path];
    pairs[i] = hash(shaderPairs + pair, place);
    if (!centred_ || batch.order) samples_.markRandom(path);
  }
  samplePairs(n, key, pairs, 0, index, square[0], square[1]);
}

// Traces the rays like the camera rays of a small wave, nested in the one that is being shaded.
void TileRenderer::trace(RtsBatch& batch, const RtsRequest& request, float* const rgba[4]) {
  for (int k = 0; k < 4; k++)
    if (rgba[k]) std::fill_n(rgba[k], request.count, 0.0f);
  const uint32_t depth = scene_.frame.depth;
  if (request.count == 0 || nesting_ == maxNesting || level_ >= depth + mostPassages) return;
  // The counts are allocated outside of the arena scope, because they live as long as the batch.
  if (!batch.requests) batch.requests = arena_.takeZero<uint32_t>(pointsOf(batch));
  ArenaScope scope(arena_);
  auto* to = arena_.take<uint32_t>(request.count);
  Wave wave;
  wave.rays = raysOf(batch, request, to, [&](uint32_t hit) {
    return level_ < depth || (batch.order && isWithinDepth(batch.states->flagsOf(batch.order[hit]),
                                                           level_ + 1, depth));
  });
  const uint32_t n = wave.rays.count;
  if (n == 0) return;
  wave.states.allocate(arena_, n);
  PixelSamples found;
  found.allocate(arena_, n);
  auto* parentPath = arena_.take<uint32_t>(n);
  PathSamples samples;
  samples.allocate(arena_, n);
  samples.random = arena_.takeZero<uint8_t>(n);
  for (uint32_t i = 0; i < n; i++) {
    const uint32_t hit = request.hit[to[i]];
    const RayState parent = batch.order ? (*batch.states)[batch.order[hit]] : RayState{.path = hit};
    parentPath[i] = parent.path;
    samples.key[i] = samples_.key[parent.path];
    samples.index[i] = samples_.index[parent.path];
    RayState state{.path = i};
    state.branch = hash(parent.branch + ++batch.requests[hit], level_ + 1);
    state.media = parent.media;
    state.flags.setChannel(parent.flags.channel());
    state.flags.setPassages(parent.flags.passages());
    if (batch.points) state.travelled = batch.points->hits.distance[batch.pointOf(hit)];
    wave.states.set(i, state);
  }
  const PathSamples outerSamples = samples_;
  const uint32_t outerLevel = level_;
  RayQueue outerQueue, outerNext;
  GuidedRays outerGuided(context_);
  std::swap(outerQueue, queue_);
  std::swap(outerNext, next_);
  outerGuided.swap(guided_);
  samples_ = samples;
  nesting_++;
  level_ += batch.points ? 1 : 0;
  (batch.points ? counters_.secondary : counters_.camera) += n;
  follow(wave, found);
  nesting_--;
  samples_ = outerSamples;
  level_ = outerLevel;
  std::swap(outerQueue, queue_);
  std::swap(outerNext, next_);
  outerGuided.swap(guided_);
  for (uint32_t i = 0; i < n; i++) {
    if (samples.random[i]) samples_.markRandom(parentPath[i]);
    for (int k = 0; k < 3; k++)
      if (rgba[k]) rgba[k][to[i]] = found.radiance[k][i];
    if (rgba[3]) rgba[3][to[i]] = found.alpha[i];
  }
}

void TileRenderer::findHit(const RtsBatch& batch, const RtsRequest& request, RtsFound& out) {
  if (out.distance) std::fill_n(out.distance, request.count, infinite);
  if (request.count == 0) return;
  ArenaScope scope(arena_);
  auto* to = arena_.take<uint32_t>(request.count);
  Wave wave;
  wave.rays = raysOf(batch, request, to);
  counters_.secondary += wave.rays.count;
  wave.hits = findNearest(context_, wave.rays, Coherence::incoherent);
  splitByHit(arena_, wave);
  const uint32_t n = uint32_t(wave.met.size());
  if (n == 0) return;
  const auto* travelled = arena_.takeZero<float>(padded(wave.rays.count));
  const Points points =
      makePoints(scene_, wave.rays, wave.hits, wave.met.data(), n, travelled, arena_);
  for (uint32_t i = 0; i < n; i++) {
    const uint32_t r = to[wave.met[i]];
    if (out.distance) out.distance[r] = points.hits.segment[i];
    if (out.name) out.name[r] = scene_.records[points.record[i]].name;
    for (int k = 0; k < 3; k++) {
      if (out.position[k]) out.position[k][r] = points.hits.position[k][i];
      if (out.geometric[k]) out.geometric[k][r] = points.hits.geometric[k][i];
      if (out.normal[k]) out.normal[k][r] = points.hits.normal[k][i];
    }
  }
}

void TileRenderer::occluded(const RtsBatch& batch, const RtsRequest& request,
                            float* const transmission[3]) {
  for (int k = 0; k < 3; k++) std::fill_n(transmission[k], request.count, 1.0f);
  if (request.count == 0) return;
  ArenaScope scope(arena_);
  ShadowRays rays = allocateShadowRays(scene_, request.count, arena_);
  rays.rays = raysOf(batch, request, rays.lane);
  rays.hit = request.hit;
  if (rays.media && batch.order)
    for (uint32_t r = 0; r < rays.rays.count; r++)
      rays.media[r] = batch.states->media[batch.order[request.hit[rays.lane[r]]]];
  traceTransmittance(batch, rays, transmission);
}

// Lets a transport shader compute the radiance of the camera rays.
void TileRenderer::runTransportShader(const Rays& rays, PixelSamples& found) {
  ArenaScope scope(arena_);
  const uint32_t n = rays.count;
  float* rgba[4];
  for (auto& a : rgba) a = arena_.takeZero<float>(padded(n));
  RtsRequest request{};
  request.count = n;
  request.hit = arena_.takeNumbers(n);
  for (int k = 0; k < 3; k++) {
    request.origin[k] = rays.org[k];
    request.direction[k] = rays.dir[k];
  }
  RtsBatch batch = makeBatch(context_);
  batch.rays = n;
  {
    const RunningShader running(*scene_.transport.shaderClass);
    scene_.transport.shaderClass->radiance(&scene_.host, &batch, scene_.transport.params, &request,
                                           rgba);
  }
  sanitizeOutput(*scene_.transport.shaderClass, batch, n, {rgba[0], rgba[1], rgba[2], rgba[3]});
  for (uint32_t i = 0; i < n; i++) {
    for (int k = 0; k < 3; k++)
      if (std::isfinite(rgba[k][i])) found.radiance[k][i] = rgba[k][i];
    if (std::isfinite(rgba[3][i])) found.alpha[i] = rgba[3][i];
  }
}

} // namespace openrt
