#include "render/path/light_tracer.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "render/lights/shadows.h"
#include "render/surface/bsdf_samples.h"
#include "render/surface/scatter.h"
#include "shading/running.h"

namespace openrt {
namespace {

constexpr uint32_t pathsInFlight = 4096, rouletteFrom = 4;
// Pairs of dimensions of the sampler: those for the light source, then those of the first surface.
enum Pair : uint32_t { which, place, aim, firstSurface };

// Returns the correction for shading normals in importance transport: flux scales with the cosines
// at the geometric normal, lobes with those at their own normal. E. Veach, 1997, 5.3.
float adjointCorrection(const RtsLobe& lobe, const RtsHits& hits, uint32_t i, const float out[3]) {
  const float n[3] = {lobe.normal[0][i], lobe.normal[1][i], lobe.normal[2][i]};
  const float g[3] = {hits.geometric[0][i], hits.geometric[1][i], hits.geometric[2][i]};
  const float d[3] = {hits.direction[0][i], hits.direction[1][i], hits.direction[2][i]};
  const float t = dot3(n, d) * dot3(g, out) / (dot3(g, d) * dot3(n, out));
  return std::isfinite(t) ? std::fabs(t) : 0.0f;
}

} // namespace

LightTracer::LightTracer(const RenderScene& scene, const LightSources& sources)
    : scene_(scene), sources_(sources), width_(scene.frame.width), height_(scene.frame.height) {
  const double determinant = determinantOf(scene.camera.toLocal);
  cameraArea_ = std::cbrt(determinant * determinant);
}

bool LightTracer::trace(uint32_t paths, uint32_t seed, const std::atomic<bool>& stop) {
  picture_.assign(size_t(width_) * height_ * 3, 0.0f);
  seed_ = seed;
  scale_ = 1.0 / paths;
  for (uint32_t first = 0, n; first < paths; first += n) {
    if (stop) return false;
    n = std::min(pathsInFlight, paths - first);
    begin(first, n);
  }
  return true;
}

void LightTracer::begin(uint32_t firstPath, uint32_t n) {
  ArenaScope scope(arena_);
  level_ = 0;
  rays_.allocate(arena_, n);
  lightRays_.clear();
  departures_.assign(n, {});
  queue_.clear();
  samples_.allocate(arena_, n);
  for (uint32_t i = 0; i < n; i++) samples_.set(i, ~0u, seed_, firstPath + i);
  const RandomNumbers random = randomNumbersAtStart(samples_, n, arena_);
  float *pick[2], *where[2], *towards[2];
  random.drawPair(Pair::which, arena_, pick);
  random.drawPair(Pair::place, arena_, where);
  random.drawPair(Pair::aim, arena_, towards);
  for (uint32_t i = 0; i < n; i++) {
    const float place[2] = {where[0][i], where[1][i]}, aim[2] = {towards[0][i], towards[1][i]};
    lightRays_.push_back(sources_.sampleRay(scene_, pick[0][i] + pick[1][i] * 0x1p-24, place, aim));
    const LightSources::LightRay& start = lightRays_.back();
    if (!(start.weight > 0) || !std::isfinite(start.weight)) continue;
    queue_.push(start.origin, start.direction, RayState{.path = i});
  }
  // The surface that the camera sees counts as one more level.
  while (!queue_.empty() && level_ < scene_.frame.depth) {
    next_.clear();
    load();
    counters_.secondary += queue_.size();
    traceWave(uint32_t(queue_.size()));
    std::swap(queue_, next_);
    level_++;
  }
}

// Makes the rays of the queue those of the current wave.
void LightTracer::load() {
  rays_.count = uint32_t(queue_.size());
  for (int k = 0; k < 3; k++) {
    rays_.org[k] = queue_.origin()[k];
    rays_.dir[k] = queue_.direction()[k];
  }
  std::fill_n(rays_.tnear, rays_.count, 0.0f);
  std::fill_n(rays_.tfar, rays_.count, std::numeric_limits<float>::infinity());
  states_ = queue_.states();
}

void LightTracer::traceWave(uint32_t n) {
  ArenaScope scope(arena_);
  RayHits hits;
  hits.allocate(arena_, n);
  scene_.kernel->intersect(rays_, maskAll, Coherence::incoherent, hits);
  skipCulledBacks(scene_, arena_, counters_, rays_, hits);
  absorbAlongRays(scene_, rays_, hits, states_);
  auto *met = arena_.take<uint32_t>(n), *order = arena_.take<uint32_t>(n);
  auto* travelled = arena_.takeZero<float>(padded(n));
  uint32_t hitCount = 0;
  for (uint32_t i = 0; i < n; i++) {
    if (hits.record[i] == noHit) continue;
    const uint32_t traits = (*scene_.shaders)[scene_.records[hits.record[i]].shader].traits;
    if (states_.flagsOf(i).pathClass() == PathClass::undeflected &&
        !(traits & (RTS_SPECULAR | RTS_TRANSPARENT)))
      continue;
    departures_[states_.path[i]].pathLength += double(hits.t[i]);
    met[hitCount++] = i;
  }
  for (const BucketRange& range : sortByBucket(scene_, hits, met, hitCount, order, arena_)) {
    ArenaScope inner(arena_);
    const uint32_t* lanes = order + range.begin;
    const Points points =
        makePoints(scene_, rays_, hits, lanes, range.end - range.begin, travelled, arena_);
    const RtsClass& shaderClass = *scene_.buckets[range.bucket].shaderClass;
    if (shaderClass.surface)
      scatter(points, lanes, shaderClass);
    else if (shaderClass.transmit)
      transmitRays(points, lanes, shaderClass);
  }
}

RtsBatch LightTracer::makeBatch(const Points& points) {
  RtsBatch batch;
  batch.scene = &scene_;
  batch.arena = &arena_;
  batch.counters = &counters_;
  batch.points = &points;
  return batch;
}

// Continues paths through a surface that has `transmit` but no lobes: it attenuates light and does
// not scatter it.
void LightTracer::transmitRays(const Points& points, const uint32_t* order,
                               const RtsClass& shaderClass) {
  const uint32_t n = points.hits.count;
  RtsBatch batch = makeBatch(points);
  float* through[3];
  for (auto& a : through) a = arena_.takeZero<float>(padded(n));
  {
    const RunningShader running(shaderClass);
    shaderClass.transmit(&scene_.host, &batch, &points.hits, through);
  }
  for (uint32_t i = 0; i < n; i++) {
    RayState state = states_[order[i]];
    const float d[3] = {points.hits.direction[0][i], points.hits.direction[1][i],
                        points.hits.direction[2][i]};
    for (int k = 0; k < 3; k++)
      state.throughput[k] *= through[k][i] > 0 ? std::min(through[k][i], 1.0f) : 0.0f;
    if (largest(state.throughput) > 0) push(points, i, state, d);
  }
}

// Computes the flux that a light without extent sends to a point, ignoring occlusion.
void LightTracer::lampFlux(const Points& points, const LightSources::LightRay& start,
                           const float at[3], float flux[3]) {
  const LightSlot& light = scene_.lights[start.light];
  ArenaScope scope(arena_);
  float* local[3];
  RtsIllumination out{};
  for (int k = 0; k < 3; k++) {
    local[k] = arena_.take<float>(lanes);
    const float* m = light.toLocal.r[k];
    std::fill_n(local[k], lanes, m[0] * at[0] + m[1] * at[1] + m[2] * at[2] + m[3]);
    out.toLight[k] = arena_.takeZero<float>(lanes);
    out.color[k] = arena_.takeZero<float>(lanes);
    out.ambient[k] = arena_.takeZero<float>(lanes);
  }
  RtsBatch batch = makeBatch(points);
  batch.points = nullptr; // the light gets one place, not the hits
  batch.lanes = 1;
  const float* places[3] = {local[0], local[1], local[2]};
  const RunningShader running(*light.shader.shaderClass);
  light.shader.shaderClass->illuminate(&scene_.host, &batch, light.shader.params, 1, places, &out);
  double squaredDistance = 0;
  for (int k = 0; k < 3; k++) squaredDistance += std::pow(double(at[k]) - start.origin[k], 2);
  // The factor pi turns a light's colour into irradiance, because the colour is the radiance of a
  // white Lambert surface.
  const double scale = M_PI * start.weight * (start.parallel ? 1 : squaredDistance);
  for (int k = 0; k < 3; k++) {
    flux[k] = float(out.color[k][0] * scale);
    if (!(flux[k] > 0) || !std::isfinite(flux[k])) flux[k] = 0;
  }
}

// Multiplies the throughput by the emitted flux when a path has reached its first surface. Returns
// whether any throughput is left.
bool LightTracer::applyEmission(const Points& points, uint32_t i, RayState& state) {
  const LightSources::LightRay& start = lightRays_[state.path];
  Departure& departure = departures_[state.path];
  float flux[3] = {0, 0, 0};
  if (start.shape != LightSources::none) {
    scene_.emitters.shapes()->radiance(scene_, start.shape, start.place, start.direction, arena_,
                                       flux);
    for (float& x : flux) x = float(x * start.weight);
  } else {
    const float at[3] = {points.hits.position[0][i], points.hits.position[1][i],
                         points.hits.position[2][i]};
    lampFlux(points, start, at, flux);
    std::copy_n(flux, 3, departure.flux);
    departure.attenuationKnown = start.parallel;
  }
  for (int k = 0; k < 3; k++)
    state.throughput[k] *= flux[k] > 0 && std::isfinite(flux[k]) ? flux[k] : 0.0f;
  return largest(state.throughput) > 0;
}

// Evaluates the light at the end of the unfolded path, in the direction in which the path has left
// it, and stores the attenuation relative to the first surface. A light with inverse-square falloff
// has the same flux everywhere; a difference below 1e-3 is then taken as rounding.
void LightTracer::attenuate(const Points& points, uint32_t path) {
  const LightSources::LightRay& start = lightRays_[path];
  Departure& departure = departures_[path];
  float at[3], flux[3];
  for (int k = 0; k < 3; k++)
    at[k] = float(start.origin[k] + departure.pathLength * start.direction[k]);
  lampFlux(points, start, at, flux);
  for (int k = 0; k < 3; k++) {
    const float change = departure.flux[k] > 0 ? flux[k] / departure.flux[k] : 0.0f;
    const bool rounding = departure.flux[k] > 0 && start.endless && std::fabs(change - 1) < 1e-3f;
    departure.attenuation[k] = rounding || !std::isfinite(change) ? 1.0f : change;
  }
}

void LightTracer::scatter(const Points& points, const uint32_t* order,
                          const RtsClass& shaderClass) {
  const RtsHits& hits = points.hits;
  const uint32_t n = hits.count;
  RtsSurface surface{};
  for (auto& e : surface.emission) e = arena_.takeZero<float>(padded(n));
  RtsBatch batch = makeBatch(points);
  batch.states = &states_;
  batch.order = order;
  {
    const RunningShader running(shaderClass);
    shaderClass.surface(&scene_.host, &batch, &hits, &surface);
  }
  Boundaries boundaries{nullptr, nullptr};
  if (shaderClass.medium) crossBoundaries(batch, states_, boundaries);
  bool scatters = false;
  for (uint32_t l = 0; l < batch.lobeCount; l++)
    scatters |= nonSpecularFunctions(batch.lobes[l]) != nullptr;
  const uint32_t* all = arena_.takeNumbers(n);
  auto* connected = arena_.take<uint32_t>(n);
  uint32_t count = 0;
  for (uint32_t i = 0; i < n; i++)
    if (const uint32_t lane = order[i];
        states_.flagsOf(lane).pathClass() != PathClass::undeflected) {
      const uint32_t path = states_.path[lane];
      connected[count++] = i;
      if (scatters && !departures_[path].attenuationKnown) attenuate(points, path);
    }
  const RandomNumbers random =
      randomNumbersAt(samples_, states_, order, n, pairAtLevel(Pair::firstSurface, level_), arena_);
  if (count && scatters) connect(batch, random, connected, count);
  float* choices[2];
  random.draw(Decision::choice, arena_, choices);
  const LobeSamples* samples[RTS_MAX_LOBES] = {};
  for (uint32_t l = 0; count && l < batch.lobeCount; l++) {
    if (!nonSpecularFunctions(batch.lobes[l])) continue;
    float* square[2];
    random.draw(Decision::direction, arena_, square, pairOfLobe(l));
    auto* made = new (arena_.take<LobeSamples>(1)) LobeSamples(arena_, n, &batch);
    made->sample(batch.lobes[l], hits, n, all, square);
    samples[l] = made;
  }
  for (uint32_t i = 0; i < n; i++) {
    // This boundary has no effect on light.
    if (boundaries.crossing && !boundaries.crossing[i].visible) {
      RayState passed = states_[order[i]];
      passed.media = boundaries.crossing[i].behind;
      const float d[3] = {hits.direction[0][i], hits.direction[1][i], hits.direction[2][i]};
      push(points, i, passed, d);
      continue;
    }
    spawnRay(batch, i, samples, choices, boundaries);
  }
}

// Spawns one ray, selected in proportion to the weight it would carry. At the first surface only
// specular reflection and refraction count.
void LightTracer::spawnRay(const RtsBatch& batch, uint32_t i, const LobeSamples* const samples[],
                           const float* const choices[2], const Boundaries& boundaries) {
  const Points& points = *batch.points;
  RayState state = (*batch.states)[batch.order[i]];
  const bool first = state.flags.pathClass() == PathClass::undeflected;
  BsdfSamples bsdfSamples(points.hits, i, boundaries.eta ? boundaries.eta[i] : nullptr,
                          state.flags.channel(), true);
  for (uint32_t l = 0; l < batch.lobeCount; l++)
    if (!first || !nonSpecularFunctions(batch.lobes[l]))
      bsdfSamples.add(l, batch.lobes[l], first ? nullptr : samples[l]);
  float carried[BsdfSamples::maximum], sum = 0;
  for (uint32_t w = 0; w < bsdfSamples.count; w++)
    sum += carried[w] = largest(bsdfSamples.list[w].expectedWeight);
  if (!(sum > 0)) return;
  const uint32_t chosen = sampleDiscrete(carried, bsdfSamples.count, choices[0][i] * sum);
  const BsdfSample& sample = bsdfSamples.list[chosen];
  if (!(carried[chosen] > 0) || sample.rejected) return;
  double kept = carried[chosen] / sum;
  if (level_ >= rouletteFrom) {
    const float stay = std::min(1.0f, sum);
    if (choices[1][i] >= stay) return;
    kept *= stay;
  }
  if (Departure& departure = departures_[state.path];
      nonSpecularFunctions(batch.lobes[sample.lobe]) && !departure.attenuationKnown) {
    for (int k = 0; k < 3; k++) state.throughput[k] *= departure.attenuation[k];
    departure = {};
  }
  const float correction = sample.deflected ? adjointCorrection(batch.lobes[sample.lobe],
                                                                points.hits, i, sample.direction)
                                            : 1.0f;
  for (int k = 0; k < 3; k++) state.throughput[k] *= float(sample.weight[k] * correction / kept);
  state.flags.setChannel(sample.channel);
  float towards = 0;
  for (int k = 0; k < 3; k++) towards += points.hits.geometric[k][i] * sample.direction[k];
  if (towards < 0 && boundaries.crossing) state.media = boundaries.crossing[i].behind;
  if (first && sample.deflected) {
    if (!applyEmission(points, i, state)) return;
    state.flags.setClass(PathClass::specularFirst);
  }
  push(points, i, state, sample.direction);
}

void LightTracer::push(const Points& points, uint32_t i, const RayState& state,
                       const float dir[3]) {
  if (!(largest(state.throughput) > 0) || !std::isfinite(largest(state.throughput))) return;
  float origin[3];
  liftPoint(points, i, dir, origin);
  next_.push(origin, dir, state);
}

// Connects the hits with the camera and adds their light to the picture.
void LightTracer::connect(const RtsBatch& batch, const RandomNumbers& random,
                          const uint32_t* hitNumbers, uint32_t n) {
  const ShaderSlot& camera = scene_.camera.shader;
  ArenaScope scope(arena_);
  const Points& points = *batch.points;
  const RtsHits& hits = points.hits;
  const uint32_t size = padded(n);
  float *local[3], *uv[2], *towards[3];
  RtsProjection seen{};
  for (int k = 0; k < 3; k++) {
    local[k] = arena_.take<float>(size);
    towards[k] = arena_.take<float>(size);
    seen.toEye[k] = arena_.takeZero<float>(size);
    const float* m = scene_.camera.toLocal.r[k];
    for (uint32_t i = 0; i < size; i++) {
      const uint32_t h = hitNumbers[std::min(i, n - 1)];
      local[k][i] = m[0] * hits.position[0][h] + m[1] * hits.position[1][h] +
                    m[2] * hits.position[2][h] + m[3];
    }
  }
  for (int k = 0; k < 2; k++) {
    uv[k] = arena_.take<float>(size);
    seen.xy[k] = arena_.takeZero<float>(size);
  }
  float* lens[2];
  random.draw(Decision::lens, arena_, lens);
  for (uint32_t i = 0; i < size; i++) {
    const uint32_t h = hitNumbers[std::min(i, n - 1)];
    for (int k = 0; k < 2; k++) uv[k][i] = lens[k][h];
  }
  seen.weight = arena_.takeZero<float>(size);
  const float *place[3] = {local[0], local[1], local[2]}, *square[2] = {uv[0], uv[1]};
  const float extent[2] = {float(width_), float(height_)};
  RtsBatch projectBatch = batch;
  projectBatch.points = nullptr; // the camera gets n places, not the hits
  projectBatch.lanes = n;
  {
    const RunningShader running(*camera.shaderClass);
    camera.shaderClass->project(&scene_.host, &projectBatch, camera.params, n, place, square,
                                extent, &seen);
  }
  float* distance = arena_.take<float>(size);
  const auto& m = scene_.camera.fromLocal.r;
  for (uint32_t i = 0; i < n; i++) {
    float v[3];
    for (int k = 0; k < 3; k++)
      v[k] = m[k][0] * seen.toEye[0][i] + m[k][1] * seen.toEye[1][i] + m[k][2] * seen.toEye[2][i];
    distance[i] = std::sqrt(dot3(v, v));
    for (int k = 0; k < 3; k++) towards[k][i] = v[k] / distance[i];
  }
  float* sent[3];
  for (auto& a : sent) a = arena_.takeZero<float>(size);
  LobeValues lobeValues(arena_, n, &batch);
  for (uint32_t l = 0; l < batch.lobeCount; l++) {
    const RtsLobe& lobe = batch.lobes[l];
    if (!nonSpecularFunctions(lobe)) continue;
    lobeValues.evaluate(lobe, hits, n, hitNumbers, towards);
    for (uint32_t i = 0; i < n; i++) {
      const uint32_t h = hitNumbers[i];
      const float out[3] = {towards[0][i], towards[1][i], towards[2][i]};
      const float g[3] = {hits.geometric[0][h], hits.geometric[1][h], hits.geometric[2][h]};
      float w[3];
      if (!weightAt(lobe, h, w) || (!nonSpecularFunctions(lobe)->transmits && !(dot3(g, out) > 0)))
        continue;
      const float factor = adjointCorrection(lobe, hits, h, out) * seen.weight[i];
      for (int k = 0; k < 3; k++) sent[k][i] += w[k] * lobeValues.value[k][i] * factor;
    }
  }
  // Rough boundaries scale radiance by eta squared. Flux is not scaled, because the camera is
  // outside of all media.
  ShadowRays rays;
  rays.rays.allocate(arena_, n);
  rays.lane = arena_.take<uint32_t>(n);
  uint32_t count = 0;
  for (uint32_t i = 0; i < n; i++) {
    const uint32_t h = hitNumbers[i];
    if (!(seen.weight[i] > 0) || !(sent[0][i] > 0 || sent[1][i] > 0 || sent[2][i] > 0)) continue;
    const float dir[3] = {towards[0][i], towards[1][i], towards[2][i]};
    float origin[3];
    liftPoint(points, h, dir, origin);
    for (int k = 0; k < 3; k++) {
      rays.rays.org[k][count] = origin[k];
      rays.rays.dir[k][count] = towards[k][i];
    }
    rays.rays.tnear[count] = 0;
    rays.rays.tfar[count] = seen.parallel ? std::numeric_limits<float>::infinity() : distance[i];
    rays.lane[count++] = i;
  }
  rays.rays.count = count;
  traceTransmittance(batch, rays, sent);
  for (uint32_t i = 0; i < n; i++) {
    const float x = seen.xy[0][i], y = seen.xy[1][i];
    if (!(seen.weight[i] > 0) || !(x >= 0 && y >= 0 && x < extent[0] && y < extent[1])) continue;
    const RayState state = states_[batch.order[hitNumbers[i]]];
    const float* attenuation = departures_[state.path].attenuation;
    float* pixel = &picture_[3 * (size_t(y) * width_ + size_t(x))];
    for (int k = 0; k < 3; k++) {
      const double light =
          double(state.throughput[k]) * attenuation[k] * sent[k][i] * cameraArea_ * scale_;
      if (std::isfinite(light)) pixel[k] += float(light);
    }
  }
}

} // namespace openrt
