// emitted.cpp: light sampling of emitters and of the sky at non-specular surfaces: one light sample
// and one shadow ray per hit, combined with BSDF sampling by MIS. Part of TileRenderer.
#include <algorithm>
#include <cmath>

#include "render/path/paths.h"
#include "render/surface/scatter.h"
#include "render/surface/surfaces.h"
#include "shading/running.h"

namespace openrt {

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

// Computes the BSDF response of the hits to their light samples, with the MIS weight of light
// sampling (balance heuristic). Removes the samples with response 0 and returns how many are left.
uint32_t TileRenderer::weightLightSamples(const RtsBatch& batch, const RtsHits& hits,
                                          float* const selectionProbability[], Rays& rays,
                                          LightSample* lightSamples, uint32_t* hitOf, uint32_t n,
                                          float* response[3]) {
  for (int k = 0; k < 3; k++) response[k] = arena_.takeZero<float>(padded(n));
  ArenaScope scope(arena_);
  LobeValues lobeValues(arena_, n, &batch);
  for (uint32_t l = 0; l < batch.lobeCount; l++) {
    if (!selectionProbability[l]) continue;
    lobeValues.evaluate(batch.lobes[l], hits, n, hitOf, rays.dir);
    for (uint32_t r = 0; r < n; r++) {
      float w[3];
      const float followed = selectionProbability[l][hitOf[r]];
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
  return left;
}

void TileRenderer::sampleEmitters(const RtsBatch& batch, const Points& points,
                                  const uint32_t* order, const Paths& paths, const Random& random,
                                  float* const selectionProbability[], const Crossing* crossing,
                                  float* const radiance[3]) {
  ArenaScope scope(arena_);
  const RtsHits& hits = points.hits;
  const Emitters& emitters = scene_.emitters;
  Rays rays;
  rays.allocate(arena_, hits.count);
  auto* lightSamples = arena_.take<LightSample>(hits.count);
  auto* hitOf = arena_.take<uint32_t>(hits.count); // index of the hit in the batch, by light sample
  float *pick[2], *place[2];
  draw(random, Draw::emitter, 0, pick);
  draw(random, Draw::place, 0, place);
  uint32_t n = 0;
  for (uint32_t i = 0; i < hits.count; i++) {
    bool wanted = false;
    for (uint32_t l = 0; l < batch.lobeCount; l++)
      wanted |= selectionProbability[l] && selectionProbability[l][i] > 0;
    if (!wanted) continue;
    const LightSampleContext from = lightSampleContext(points, i, transmitsAt(batch, i));
    const LightSample lightSample = emitters.choose(
        from, double(pick[0][i]) + double(pick[1][i]) * 0x1p-24, place[0][i], place[1][i]);
    if (!(lightSample.pdf > 0)) continue;
    float origin[3];
    liftPoint(points, i, lightSample.direction, origin);
    for (int k = 0; k < 3; k++) {
      rays.org[k][n] = origin[k];
      rays.dir[k][n] = lightSample.direction[k];
    }
    rays.tnear[n] = 0;
    rays.tfar[n] = lightSample.distance * (1 + 0x1p-10f);
    hitOf[n] = i;
    lightSamples[n++] = lightSample;
  }
  float* response[3];
  n = weightLightSamples(batch, hits, selectionProbability, rays, lightSamples, hitOf, n, response);
  if (n == 0) return;
  rays.count = n;
  counters_.shadow += n;
  RayHits found;
  found.allocate(arena_, n);
  scene_.kernel->intersect(rays, maskAll, Coherence::incoherent, found);
  skipCulledBacks(scene_, arena_, counters_, rays, found);

  const auto add = [&](uint32_t ray, const float light[3]) {
    const uint32_t i = hitOf[ray];
    float left[3] = {light[0], light[1], light[2]};
    if (!scene_.shaders->media().empty()) { // absorption of the medium between hit and emitter
      float towards = 0;
      for (int k = 0; k < 3; k++) towards += hits.geometric[k][i] * rays.dir[k][ray];
      const MediaStack& media =
          towards < 0 && crossing ? crossing[i].behind : paths.state[order[i]].media;
      absorb(mediumOf(media, scene_.shaders->media()), std::min(found.t[ray], 1e30f),
             scene_.shaders->media(), left);
    }
    for (int k = 0; k < 3; k++)
      if (std::isfinite(left[k])) radiance[k][i] += response[k][ray] * left[k];
  };
  auto* lanes = arena_.take<uint32_t>(n);
  auto* sorted = arena_.take<uint32_t>(n);
  uint32_t skies = 0, lit = 0;
  for (uint32_t r = 0; r < n; r++)
    if (lightSamples[r].record == noHit && found.record[r] == noHit) lanes[skies++] = r;
  if (skies) {
    float *local[3], *rgba[4];
    evaluateSky(rays, lanes, skies, local, rgba);
    for (uint32_t i = 0; i < skies; i++) {
      const float light[3] = {rgba[0][i], rgba[1][i], rgba[2][i]};
      add(lanes[i], light);
    }
  }
  for (uint32_t r = 0; r < n; r++)
    if (found.record[r] != noHit &&
        emitters.isSampledHit(lightSamples[r], found.record[r], found.primitive[r], found.t[r]))
      lanes[lit++] = r;
  if (lit == 0) return;
  auto* travelled = arena_.takeZero<float>(padded(n));
  std::vector<uint32_t> counts;
  std::vector<BucketRange> ranges;
  sortByBucket(scene_, found, lanes, lit, sorted, counts, ranges);
  for (const BucketRange& range : ranges) {
    const RtsClass& shaderClass = *scene_.buckets[range.bucket].shaderClass;
    if (!shaderClass.surface) continue;
    const uint32_t m = range.end - range.begin;
    const Points seen = makePoints(scene_, rays, found, sorted + range.begin, m, travelled, arena_);
    RtsSurface surface{};
    for (auto& e : surface.emission) e = arena_.takeZero<float>(padded(m));
    RtsBatch inner = makeBatch();
    // A null tracer turns off random decisions of the shader, because the emission must be the one
    // that the sampling tables were built from.
    inner.tracer = nullptr;
    inner.points = &seen;
    {
      const RunningShader running(shaderClass);
      shaderClass.surface(&scene_.host, &inner, &seen.hits, &surface);
    }
    for (uint32_t i = 0; i < m; i++) {
      const float light[3] = {surface.emission[0][i], surface.emission[1][i],
                              surface.emission[2][i]};
      add(sorted[range.begin + i], light);
    }
  }
}

} // namespace openrt
