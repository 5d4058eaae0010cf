#include "render/lights/emitted.h"

#include <algorithm>
#include <cmath>

#include "render/lights/environment.h"
#include "render/lights/sampled_points.h"
#include "render/surface/surface_shader.h"

namespace openrt {

LightSampleContext lightSampleContext(const Points& points, uint32_t i, bool twoSided) {
  const Vec3f p = load(points.hits.position, i), n = load(points.hits.geometric, i);
  return {offsetPoint(p, n, points.error[i]), twoSided ? Vec3f() : n};
}

namespace {

// Returns the MIS weight of the emission that a ray has found at hit i.
float emissionMisWeight(const RtsBatch& batch, uint32_t i) {
  const RenderScene& scene = *batch.scene;
  const Points& points = *batch.points;
  const PathStates& states = *batch.states;
  const uint32_t lane = batch.order[i], record = points.rayHits->record[lane],
                 primitive = points.rayHits->primitive[lane];
  const Vec3f direction = load(points.hits.direction, i);
  if (canOnlyReachSky(scene, states.flagsOf(lane)) &&
      scene.emitters.startsLightPaths(record, primitive, direction))
    return 0;
  const float pdf = states.pdf[lane];
  if (!(pdf > 0)) return 1;
  const float lightPdf = scene.emitters.pdf(states.previousOf(lane), record, primitive, direction,
                                            points.hits.segment[i]);
  return std::isfinite(lightPdf) ? pdf / (pdf + lightPdf) : 0.0f;
}

} // namespace

void weightEmission(const RtsBatch& batch, const Boundaries& boundaries, UnsampledLights& unsampled,
                    float* const emission[3]) {
  for (uint32_t i = 0; i < batch.points->hits.count; i++) {
    const float weight = boundaries.visibleAt(i) ? emissionMisWeight(batch, i) : 0;
    const Vec3f weighted = load(emission, i) * weight;
    store(weighted, emission, i);
    if (weight > 0) unsampled.meet(batch.states->flagsOf(batch.order[i]), weighted);
  }
}

LightSamples chooseLightSamples(const RtsBatch& batch, const LobeSampling& sampling) {
  const RenderScene& scene = *batch.scene;
  Arena& arena = *batch.arena;
  const Points& points = *batch.points;
  const RtsHits& hits = points.hits;
  LightSamples out{};
  Rays& rays = out.rays;
  rays.allocate(arena, hits.count);
  out.sample = arena.take<LightSample>(hits.count);
  out.hit = arena.take<uint32_t>(hits.count);
  const uint32_t size = padded(hits.count);
  auto* wanted = arena.takeZero<uint8_t>(size);
  for (uint32_t l = 0; l < batch.lobeCount; l++)
    for (uint32_t i = 0; sampling.selectionProbability[l] && i < hits.count; i++)
      wanted[i] |= sampling.selectionProbability[l][i] > 0;
  rays.count = 0;
  if (std::none_of(wanted, wanted + hits.count, [](uint8_t w) { return w != 0; })) return out;
  float *pick[2], *place[2];
  sampling.random.draw(Decision::emitter, arena, pick);
  sampling.random.draw(Decision::place, arena, place);
  auto* twoSided = arena.takeZero<uint32_t>(size);
  for (uint32_t i = 0; i < hits.count; i++) twoSided[i] = transmitsAt(batch, i);
  const LightPoints lightPoints{hits.count,
                                {hits.position[0], hits.position[1], hits.position[2]},
                                {hits.geometric[0], hits.geometric[1], hits.geometric[2]},
                                points.error,
                                twoSided,
                                pick[0],
                                place[0],
                                place[1],
                                wanted};
  auto* all = arena.take<LightSample>(hits.count);
  scene.emitters.choose(lightPoints, pick[1], arena, all);
  uint32_t n = 0;
  for (uint32_t i = 0; i < hits.count; i++) {
    const LightSample& lightSample = all[i];
    if (!(lightSample.pdf > 0)) continue;
    const Vec3f origin = liftPoint(points, i, lightSample.direction);
    store(origin, rays.org, n);
    store(lightSample.direction, rays.dir, n);
    rays.tnear[n] = 0;
    rays.tfar[n] = lightSample.end >= 0
                       ? lightSample.end
                       : shadowRayEnd(scene, lightSample,
                                      lightSampleContext(points, i, false).position, origin);
    out.hit[n] = i;
    out.sample[n++] = lightSample;
  }
  rays.count = n;
  return out;
}

void weightLightSamples(const RtsBatch& batch, const LobeSampling& sampling,
                        LightSamples& samples) {
  Arena& arena = *batch.arena;
  Rays& rays = samples.rays;
  const uint32_t n = rays.count;
  LightSample* lightSamples = samples.sample;
  uint32_t* hitOf = samples.hit;
  float* response[3];
  for (int k = 0; k < 3; k++) response[k] = samples.response[k] = arena.takeZero<float>(padded(n));
  ArenaScope scope(arena);
  LobeValues lobeValues(arena, n, &batch);
  for (uint32_t l = 0; l < batch.lobeCount; l++) {
    const float* selectionProbability = sampling.selectionProbability[l];
    if (!selectionProbability) continue;
    lobeValues.evaluate(batch.lobes[l], batch.points->hits, n, hitOf, rays.dir);
    for (uint32_t r = 0; r < n; r++) {
      Vec3f w;
      const float followed = selectionProbability[hitOf[r]];
      if (!(followed > 0) || !weightAt(batch.lobes[l], hitOf[r], w)) continue;
      const float scale = 1 / (lightSamples[r].pdf + followed * lobeValues.pdf[r]);
      store(load(response, r) + w * load(lobeValues.value, r) * scale, response, r);
    }
  }
  uint32_t left = 0;
  for (uint32_t r = 0; r < n; r++) {
    if (!(response[0][r] > 0 || response[1][r] > 0 || response[2][r] > 0)) continue;
    store(load(rays.org, r), rays.org, left);
    store(load(rays.dir, r), rays.dir, left);
    store(load(response, r), response, left);
    rays.tnear[left] = rays.tnear[r];
    rays.tfar[left] = rays.tfar[r];
    hitOf[left] = hitOf[r];
    lightSamples[left++] = lightSamples[r];
  }
  rays.count = left;
}

namespace {

// Blocks the rays to shapes that may be hidden, or share their place with another surface, unless
// the sampled shape is the one that the kernel reports.
void blockUncertain(const StageContext& context, const Rays& rays, const LightSample* lightSamples,
                    uint8_t* blocked) {
  const RenderScene& scene = context.scene;
  Arena& arena = context.arena;
  ArenaScope scope(arena);
  auto* lanes = arena.take<uint32_t>(rays.count);
  uint32_t n = 0;
  for (uint32_t r = 0; r < rays.count; r++) {
    const uint32_t shape = lightSamples[r].shape;
    if (!blocked[r] && shape != EmissiveShapes::none && (*scene.emitters.shapes())[shape].uncertain)
      lanes[n++] = r;
  }
  if (n == 0) return;
  const Rays again = copyRays(rays, lanes, n, arena);
  for (uint32_t i = 0; i < n; i++) again.tfar[i] = lightSamples[lanes[i]].distance * (1 + 0x1p-10f);
  const RayHits found = findNearest(context, again, Coherence::incoherent);
  for (uint32_t i = 0; i < n; i++)
    blocked[lanes[i]] = found.record[i] == noHit ||
                        scene.emitters.shapes()->find(found.record[i], found.primitive[i]) !=
                            lightSamples[lanes[i]].shape;
}

// Evaluates the emission at the sampled points of some rays by their shaders. Calls add(ray,
// light).
template <class Add> void shadeSampledPoints(const StageContext& context, const Rays& rays,
                                             const LightSample* lightSamples, const uint32_t* lanes,
                                             uint32_t n, const Add& add) {
  const RenderScene& scene = context.scene;
  Arena& arena = context.arena;
  ArenaScope scope(arena);
  RayHits seen;
  seen.allocate(arena, rays.count);
  for (uint32_t i = 0; i < n; i++)
    writeSampledHit(scene, lightSamples[lanes[i]], rays, lanes[i], seen);
  const auto* travelled = arena.takeZero<float>(padded(rays.count));
  auto* sorted = arena.take<uint32_t>(n);
  for (const BucketRange& range : sortByBucket(scene, seen, lanes, n, sorted, arena)) {
    const RtsClass& shaderClass = *scene.buckets[range.bucket].shaderClass;
    const uint32_t m = range.end - range.begin;
    const Points points = makePoints(scene, rays, seen, sorted + range.begin, m, travelled, arena);
    RtsBatch inner = makeBatch(context);
    // A null tracer turns off random decisions of the shader, because the emission must be the one
    // that the sampling tables were built from.
    inner.tracer = nullptr;
    inner.points = &points;
    const RtsSurface surface = runSurfaceShader(inner, shaderClass);
    for (uint32_t i = 0; i < m; i++) add(sorted[range.begin + i], load(surface.emission, i));
  }
}

} // namespace

void sampleEmitters(const RtsBatch& batch, const LobeSampling& sampling,
                    const Boundaries& boundaries, float* const radiance[3]) {
  const StageContext context = contextOf(batch);
  const RenderScene& scene = context.scene;
  Arena& arena = context.arena;
  ArenaScope scope(arena);
  LightSamples samples = chooseLightSamples(batch, sampling);
  weightLightSamples(batch, sampling, samples);
  const Rays& rays = samples.rays;
  const LightSample* lightSamples = samples.sample;
  const uint32_t n = rays.count;
  if (n == 0) return;
  context.counters.shadow += n;
  auto* blocked = arena.take<uint8_t>(n);
  findBlocked(scene, rays, blocked);
  blockUncertain(context, rays, lightSamples, blocked);

  const auto add = [&](uint32_t ray, const Vec3f& light) {
    const uint32_t i = samples.hit[ray];
    Vec3f left = light;
    if (!scene.shaders->media().empty()) { // absorption of the medium between hit and emitter
      const MediaStack& media = mediaTowards(*batch.points, i, load(rays.dir, ray), boundaries,
                                             batch.states->media[batch.order[i]]);
      absorb(mediumOf(media, scene.shaders->media()), std::min(lightSamples[ray].distance, 1e30f),
             scene.shaders->media(), left);
    }
    for (int k = 0; k < 3; k++)
      if (std::isfinite(left[k])) radiance[k][i] += samples.response[k][ray] * left[k];
  };
  auto *toSky = arena.take<uint32_t>(n), *toShade = arena.take<uint32_t>(n);
  uint32_t skies = 0, shaded = 0;
  for (uint32_t r = 0; r < n; r++) {
    if (blocked[r]) continue;
    if (lightSamples[r].shape == EmissiveShapes::none) {
      toSky[skies++] = r;
      continue;
    }
    const EmissiveShapes::Shape& shape = (*scene.emitters.shapes())[lightSamples[r].shape];
    if (const Vec3f* light = uniformRadiance(shape, lightSamples[r].direction))
      add(r, *light);
    else
      toShade[shaded++] = r;
  }
  if (skies) {
    const SkyAlongRays sky = evaluateSky(context, rays, toSky, skies);
    for (uint32_t i = 0; i < skies; i++) add(toSky[i], load(sky.rgba, i));
  }
  if (shaded) shadeSampledPoints(context, rays, lightSamples, toShade, shaded, add);
}

} // namespace openrt
