// emitted.cpp: light sampling of emitters and of the sky at non-specular surfaces: one light sample
// and one shadow ray per hit, combined with BSDF sampling by MIS. Part of TileRenderer.
#include <algorithm>
#include <cmath>

#include "render/lights/sampled_points.h"
#include "render/path/paths.h"
#include "render/surface/scatter.h"
#include "render/surface/surfaces.h"
#include "shading/running.h"

namespace openrt {

// Light samples at the hits of a batch, one for each hit at most.
struct TileRenderer::LightSamples {
  Rays rays;           // the shadow rays; count: number of samples
  LightSample* sample; // by ray
  uint32_t* hit;       // by ray: index of the hit in the batch
  float* response[3];  // by ray: BSDF times MIS weight over pdf
};

// Returns the reference point for light sampling at a hit. twoSided: emitters behind the surface
// count as well.
LightSampleContext TileRenderer::lightSampleContext(const Points& points, uint32_t i,
                                                    bool twoSided) const {
  LightSampleContext from;
  float p[3], n[3];
  for (int k = 0; k < 3; k++) {
    p[k] = points.hits.position[k][i];
    n[k] = points.hits.geometric[k][i];
  }
  for (int k = 0; k < 3 && !twoSided; k++) from.normal[k] = n[k];
  offsetPoint(p, n, points.error[i], from.position);
  return from;
}

// Samples an emitter for each hit with a non-specular lobe.
TileRenderer::LightSamples TileRenderer::chooseLightSamples(const RtsBatch& batch,
                                                            const Sampling& sampling) {
  const Points& points = *batch.points;
  const RtsHits& hits = points.hits;
  LightSamples out{};
  Rays& rays = out.rays;
  rays.allocate(arena_, hits.count);
  out.sample = arena_.take<LightSample>(hits.count);
  out.hit = arena_.take<uint32_t>(hits.count);
  const uint32_t size = padded(hits.count);
  auto* wanted = arena_.takeZero<uint8_t>(size);
  for (uint32_t l = 0; l < batch.lobeCount; l++)
    for (uint32_t i = 0; sampling.selectionProbability[l] && i < hits.count; i++)
      wanted[i] |= sampling.selectionProbability[l][i] > 0;
  rays.count = 0;
  if (std::none_of(wanted, wanted + hits.count, [](uint8_t w) { return w != 0; })) return out;
  float *pick[2], *place[2];
  sampling.random.draw(Decision::emitter, arena_, pick);
  sampling.random.draw(Decision::place, arena_, place);
  auto* twoSided = arena_.takeZero<uint32_t>(size);
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
  auto* all = arena_.take<LightSample>(hits.count);
  scene_.emitters.choose(lightPoints, pick[1], arena_, all);
  uint32_t n = 0;
  for (uint32_t i = 0; i < hits.count; i++) {
    const LightSample& lightSample = all[i];
    if (!(lightSample.pdf > 0)) continue;
    float origin[3];
    liftPoint(points, i, lightSample.direction, origin);
    for (int k = 0; k < 3; k++) {
      rays.org[k][n] = origin[k];
      rays.dir[k][n] = lightSample.direction[k];
    }
    rays.tnear[n] = 0;
    rays.tfar[n] = lightSample.end >= 0
                       ? lightSample.end
                       : shadowRayEnd(scene_, lightSample,
                                      lightSampleContext(points, i, false).position, origin);
    out.hit[n] = i;
    out.sample[n++] = lightSample;
  }
  rays.count = n;
  return out;
}

// Computes the BSDF response of the hits to their light samples, with the MIS weight of light
// sampling (balance heuristic). Removes the samples with response 0.
void TileRenderer::weightLightSamples(const RtsBatch& batch, const Sampling& sampling,
                                      LightSamples& samples) {
  Rays& rays = samples.rays;
  const uint32_t n = rays.count;
  LightSample* lightSamples = samples.sample;
  uint32_t* hitOf = samples.hit;
  float* response[3];
  for (int k = 0; k < 3; k++) response[k] = samples.response[k] = arena_.takeZero<float>(padded(n));
  ArenaScope scope(arena_);
  LobeValues lobeValues(arena_, n, &batch);
  for (uint32_t l = 0; l < batch.lobeCount; l++) {
    const float* selectionProbability = sampling.selectionProbability[l];
    if (!selectionProbability) continue;
    lobeValues.evaluate(batch.lobes[l], batch.points->hits, n, hitOf, rays.dir);
    for (uint32_t r = 0; r < n; r++) {
      float w[3];
      const float followed = selectionProbability[hitOf[r]];
      if (!(followed > 0) || !weightAt(batch.lobes[l], hitOf[r], w)) continue;
      const float scale = 1 / (lightSamples[r].pdf + followed * lobeValues.pdf[r]);
      for (int k = 0; k < 3; k++) response[k][r] += w[k] * lobeValues.value[k][r] * scale;
    }
  }
  uint32_t left = 0;
  for (uint32_t r = 0; r < n; r++) {
    if (!(response[0][r] > 0 || response[1][r] > 0 || response[2][r] > 0)) continue;
    for (int k = 0; k < 3; k++) {
      rays.org[k][left] = rays.org[k][r];
      rays.dir[k][left] = rays.dir[k][r];
      response[k][left] = response[k][r];
    }
    rays.tnear[left] = rays.tnear[r];
    rays.tfar[left] = rays.tfar[r];
    hitOf[left] = hitOf[r];
    lightSamples[left++] = lightSamples[r];
  }
  rays.count = left;
}

// Blocks the rays to shapes that may be hidden, or share their place with another surface, unless
// the sampled shape is the one that the kernel reports.
void TileRenderer::blockUncertain(const Rays& rays, const LightSample* lightSamples,
                                  uint8_t* blocked) {
  ArenaScope scope(arena_);
  auto* lanes = arena_.take<uint32_t>(rays.count);
  uint32_t n = 0;
  for (uint32_t r = 0; r < rays.count; r++) {
    const uint32_t shape = lightSamples[r].shape;
    if (!blocked[r] && shape != EmissiveShapes::none &&
        (*scene_.emitters.shapes())[shape].uncertain)
      lanes[n++] = r;
  }
  if (n == 0) return;
  const Rays again = copyRays(rays, lanes, n, arena_);
  for (uint32_t i = 0; i < n; i++) again.tfar[i] = lightSamples[lanes[i]].distance * (1 + 0x1p-10f);
  RayHits found;
  found.allocate(arena_, n);
  scene_.kernel->intersect(again, maskAll, Coherence::incoherent, found);
  skipCulledBacks(scene_, arena_, counters_, again, found);
  for (uint32_t i = 0; i < n; i++)
    blocked[lanes[i]] = found.record[i] == noHit ||
                        scene_.emitters.shapes()->find(found.record[i], found.primitive[i]) !=
                            lightSamples[lanes[i]].shape;
}

// Evaluates the emission at the sampled points of some rays by their shaders. Calls add(ray,
// light).
template <class Add>
void TileRenderer::shadeSampledPoints(const Rays& rays, const LightSample* lightSamples,
                                      const uint32_t* lanes, uint32_t n, const Add& add) {
  ArenaScope scope(arena_);
  RayHits seen;
  seen.allocate(arena_, rays.count);
  for (uint32_t i = 0; i < n; i++)
    writeSampledHit(scene_, lightSamples[lanes[i]], rays, lanes[i], seen);
  const auto* travelled = arena_.takeZero<float>(padded(rays.count));
  auto* sorted = arena_.take<uint32_t>(n);
  for (const BucketRange& range : sortByBucket(scene_, seen, lanes, n, sorted, arena_)) {
    const RtsClass& shaderClass = *scene_.buckets[range.bucket].shaderClass;
    const uint32_t m = range.end - range.begin;
    const Points points =
        makePoints(scene_, rays, seen, sorted + range.begin, m, travelled, arena_);
    RtsSurface surface{};
    for (auto& e : surface.emission) e = arena_.takeZero<float>(padded(m));
    RtsBatch inner = makeBatch();
    // A null tracer turns off random decisions of the shader, because the emission must be the one
    // that the sampling tables were built from.
    inner.tracer = nullptr;
    inner.points = &points;
    {
      const RunningShader running(shaderClass);
      shaderClass.surface(&scene_.host, &inner, &points.hits, &surface);
    }
    for (uint32_t i = 0; i < m; i++) {
      const float light[3] = {surface.emission[0][i], surface.emission[1][i],
                              surface.emission[2][i]};
      add(sorted[range.begin + i], light);
    }
  }
}

// Adds to `radiance` the light of one light sample at each hit. crossing: by hit; null if no
// boundary of a medium is hit.
void TileRenderer::sampleEmitters(const RtsBatch& batch, const Sampling& sampling,
                                  const Crossing* crossing, float* const radiance[3]) {
  ArenaScope scope(arena_);
  const RtsHits& hits = batch.points->hits;
  LightSamples samples = chooseLightSamples(batch, sampling);
  weightLightSamples(batch, sampling, samples);
  const Rays& rays = samples.rays;
  const LightSample* lightSamples = samples.sample;
  const uint32_t n = rays.count;
  if (n == 0) return;
  counters_.shadow += n;
  auto* blocked = arena_.take<uint8_t>(n);
  findBlocked(scene_, rays, blocked);
  blockUncertain(rays, samples.sample, blocked);

  const auto add = [&](uint32_t ray, const float light[3]) {
    const uint32_t i = samples.hit[ray];
    float left[3] = {light[0], light[1], light[2]};
    if (!scene_.shaders->media().empty()) { // absorption of the medium between hit and emitter
      float towards = 0;
      for (int k = 0; k < 3; k++) towards += hits.geometric[k][i] * rays.dir[k][ray];
      const MediaStack& media =
          towards < 0 && crossing ? crossing[i].behind : batch.states->media[batch.order[i]];
      absorb(mediumOf(media, scene_.shaders->media()), std::min(lightSamples[ray].distance, 1e30f),
             scene_.shaders->media(), left);
    }
    for (int k = 0; k < 3; k++)
      if (std::isfinite(left[k])) radiance[k][i] += samples.response[k][ray] * left[k];
  };
  auto *toSky = arena_.take<uint32_t>(n), *toShade = arena_.take<uint32_t>(n);
  uint32_t skies = 0, shaded = 0;
  for (uint32_t r = 0; r < n; r++) {
    if (blocked[r]) continue;
    if (lightSamples[r].shape == EmissiveShapes::none) {
      toSky[skies++] = r;
      continue;
    }
    const EmissiveShapes::Shape& shape = (*scene_.emitters.shapes())[lightSamples[r].shape];
    if (const float* light = uniformRadiance(shape, lightSamples[r].direction))
      add(r, light);
    else
      toShade[shaded++] = r;
  }
  if (skies) {
    float *local[3], *rgba[4];
    evaluateSky(rays, toSky, skies, local, rgba);
    for (uint32_t i = 0; i < skies; i++) {
      const float light[3] = {rgba[0][i], rgba[1][i], rgba[2][i]};
      add(toSky[i], light);
    }
  }
  if (shaded) shadeSampledPoints(rays, lightSamples, toShade, shaded, add);
}

} // namespace openrt
