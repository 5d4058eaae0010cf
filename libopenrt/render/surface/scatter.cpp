// scatter.cpp: shading of surfaces that are described by lobes: direct light, then the rays that
// continue the path. Part of TileRenderer.
//
// Transports:
// * Direct: adds the light of light shaders, and follows only straight transmission.
// * Whitted: follows every specular reflection and refraction deterministically until a branch
//   carries less than the frame's energy cut.
// * Path: also samples a direction from each non-specular lobe. Once a path has split, one sample
//   is selected with a probability proportional to what it carries. From the fourth surface on
//   Russian roulette terminates paths.
#include "render/surface/scatter.h"

#include <algorithm>

#include "render/lights/shadows.h"
#include "render/path/paths.h"
#include "render/path/sampler.h"
#include "render/surface/bsdf_samples.h"
#include "render/surface/continue_paths.h"
#include "render/surface/surfaces.h"
#include "scene/transports.h"
#include "shading/running.h"

namespace openrt {
namespace {

constexpr uint32_t rouletteFrom = 3;

// Returns whether the lobe has one sample at each hit, whose expected weight is the lobe's weight.
bool hasOneSample(const RtsLobe& lobe) {
  return lobe.kind == RTS_LOBE_DIFFUSE || lobe.kind == RTS_LOBE_CUSTOM;
}

} // namespace

// Adds the light of the light shaders. A light's colour is the radiance of a white Lambert surface
// that faces it (openrts.h), so the irradiance is pi times the colour.
void TileRenderer::addLights(RtsBatch& batch, const RtsHits& hits, float* const radiance[3]) {
  uint32_t scattering = 0;
  for (uint32_t l = 0; l < batch.lobeCount; l++)
    scattering += nonSpecularFunctions(batch.lobes[l]) != nullptr;
  const uint32_t lights = scattering ? scene_.host.lights(&batch) : 0, n = hits.count;
  if (lights == 0) return;
  allocateLightArrays(batch, n);
  ArenaScope scope(arena_);
  const uint32_t* all = arena_.takeNumbers(n);
  auto* wanted = arena_.take<uint8_t>(padded(n));
  LobeValues lobeValues(arena_, n, &batch);
  float* response[3];
  for (auto& a : response) a = arena_.take<float>(n);
  for (uint32_t light = 0; light < lights; light++) {
    ArenaScope inner(arena_);
    RtsIllumination from{};
    scene_.host.illuminate(&batch, light, &hits, &from);
    for (auto* a : response) std::fill_n(a, n, 0.0f);
    std::fill_n(wanted, n, uint8_t(0));
    for (uint32_t l = 0; l < batch.lobeCount; l++) {
      const RtsLobe& lobe = batch.lobes[l];
      if (!nonSpecularFunctions(lobe)) continue;
      lobeValues.evaluate(lobe, hits, n, all, from.toLight);
      for (uint32_t i = 0; i < n; i++) {
        float w[3];
        if (!weightAt(lobe, i, w)) continue;
        float side = 0, sum = 0;
        for (int k = 0; k < 3; k++) {
          response[k][i] += w[k] *= lobeValues.value[k][i];
          sum += w[k];
          side += lobe.normal[k][i] * from.toLight[k][i];
        }
        if (sum > 0) wanted[i] = side > 0 ? 1 : 2;
      }
    }
    scene_.host.shadow(&batch, light, &hits, wanted, &from);
    for (int k = 0; k < 3; k++)
      for (uint32_t i = 0; i < n; i++)
        if (wanted[i]) radiance[k][i] += response[k][i] * float(M_PI) * from.color[k][i];
  }
}

void TileRenderer::scatterRange(Paths& paths, const Points& points, const Bucket& bucket,
                                const uint32_t* order) {
  const RtsHits& hits = points.hits;
  const uint32_t size = padded(hits.count);
  RtsSurface surface;
  float* radiance[3];
  for (int k = 0; k < 3; k++) {
    radiance[k] = surface.emission[k] = arena_.takeZero<float>(size);
    surface.albedo[k] = has(RT_ALBEDO) ? arena_.takeZero<float>(size) : nullptr;
  }
  RtsBatch batch = makeBatch(paths, points, order);
  batch.lightSet = bucket.lightSet;
  {
    const RunningShader running(*bucket.shaderClass);
    bucket.shaderClass->surface(&scene_.host, &batch, &hits, &surface);
  }
  sanitizeOutput(*bucket.shaderClass, batch, surface);
  Boundaries boundaries{nullptr, nullptr};
  if (bucket.shaderClass->medium) crossBoundaries(batch, paths.states, boundaries);
  for (uint32_t i = 0; i < hits.count; i++) {
    const float share = boundaries.crossing && !boundaries.crossing[i].visible
                            ? 0
                            : emissionMisWeight(paths.states, order[i], points, i);
    for (int k = 0; k < 3; k++) radiance[k][i] *= share;
    if (const PathFlags flags = paths.states.flagsOf(order[i]);
        share > 0 && flags.specularSinceDiffuse()) {
      const float light[3] = {radiance[0][i], radiance[1][i], radiance[2][i]};
      unsampledLightOf(flags).meet(light, brightestFor(flags));
    }
  }
  addLights(batch, hits, radiance);
  const bool path = tracesPaths(scene_.frame.transport);
  const bool emitters = path && scene_.emitters.any() && level_ < scene_.frame.depth;
  const Sampling sampling = path ? sampleLobes(batch, paths, emitters) : Sampling{};
  if (path && !boundaries.crossing && batch.lobeCount == 1 && hasOneSample(batch.lobes[0])) {
    continueAtOneLobe(batch, sampling, paths);
  } else {
    for (uint32_t i = 0; i < hits.count; i++) {
      if (boundaries.crossing && !boundaries.crossing[i].visible)
        passThroughBoundary(points, i, order[i], boundaries.crossing[i], paths);
      else
        spawnRays(batch, i, sampling, boundaries, paths);
    }
  }
  if (emitters) sampleEmitters(batch, sampling, boundaries.crossing, radiance);
  float* fog[4];
  attenuate(points, paths, order, fog);
  for (uint32_t i = 0; i < hits.count; i++) {
    const uint32_t lane = order[i], path = paths.states.path[lane];
    // clear: weight of straight transmission. seen: weight of all specular lobes, which also show
    // mirror images and refractions.
    float clear[3] = {0, 0, 0}, seen[3] = {0, 0, 0}, covered = 0;
    const bool unseen = boundaries.crossing && !boundaries.crossing[i].visible;
    for (uint32_t l = 0; l < batch.lobeCount; l++) {
      float w[3];
      if (nonSpecularFunctions(batch.lobes[l]) || !weightAt(batch.lobes[l], i, w)) continue;
      for (int k = 0; k < 3; k++) {
        seen[k] += w[k];
        clear[k] += batch.lobes[l].kind == RTS_LOBE_TRANSPARENT ? w[k] : 0.0f;
      }
    }
    for (int k = 0; k < 3; k++) {
      if (unseen) seen[k] = clear[k] = 1;
      float light = std::isfinite(radiance[k][i]) ? radiance[k][i] : 0.0f;
      // Fog uses the whole path length. What is seen beyond the surface already contains the
      // airlight of the path up to here, so that part is left out.
      if (fog[3])
        light = fog[3][i] * light + (1 - fog[3][i]) * fog[k][i] * (1 - std::min(seen[k], 1.0f));
      const float throughput = paths.states.throughput[k][lane];
      paths.radiance[k][path] += throughput * light;
      covered += throughput * (1 - std::min(clear[k], 1.0f));
    }
    if (!paths.states.flagsOf(lane).deflected()) paths.alpha[path] += covered / 3;
    if (paths.first[path] && !unseen) storeFirstHit(points, i, path, surface.albedo, paths);
  }
}

// Returns the MIS weight of emission found by BSDF sampling; light sampling or light tracing
// contributes the rest.
float TileRenderer::emissionMisWeight(const PathStates& states, uint32_t lane, const Points& points,
                                      uint32_t i) const {
  const uint32_t record = points.rayHits->record[lane], primitive = points.rayHits->primitive[lane];
  const RtsHits& h = points.hits;
  const float direction[3] = {h.direction[0][i], h.direction[1][i], h.direction[2][i]};
  if (canOnlyReachSky(states.flagsOf(lane)) &&
      scene_.emitters.startsLightPaths(record, primitive, direction))
    return 0;
  const float pdf = states.pdf[lane];
  if (!(pdf > 0)) return 1;
  const float lightPdf =
      scene_.emitters.pdf(states.previousOf(lane), record, primitive, direction, h.segment[i]);
  return std::isfinite(lightPdf) ? pdf / (pdf + lightPdf) : 0.0f;
}

// Samples a direction for every hit from a non-specular lobe.
const LobeSamples* TileRenderer::sampleLobe(const RtsBatch& batch, uint32_t l,
                                            const RandomNumbers& random) {
  const RtsHits& hits = batch.points->hits;
  auto* samples = new (arena_.take<LobeSamples>(1)) LobeSamples(arena_, hits.count, &batch);
  ArenaScope scope(arena_);
  const uint32_t* all = arena_.takeNumbers(hits.count);
  float* square[2];
  random.draw(Decision::direction, arena_, square, pairOfLobe(l));
  samples->sample(batch.lobes[l], hits, hits.count, all, square);
  return samples;
}

// Takes the random decisions at the hits of a batch. emitters: they are sampled at these hits.
TileRenderer::Sampling TileRenderer::sampleLobes(const RtsBatch& batch, const Paths& paths,
                                                 bool emitters) {
  const uint32_t n = batch.points->hits.count;
  Sampling sampling{};
  sampling.random = randomNumbersAt(samples_, paths.states, batch.order, n, firstPair(), arena_);
  sampling.random.draw(Decision::choice, arena_, sampling.choices);
  for (uint32_t l = 0; l < batch.lobeCount; l++) {
    if (!nonSpecularFunctions(batch.lobes[l])) continue;
    sampling.samples[l] = sampleLobe(batch, l, sampling.random);
    if (emitters) sampling.selectionProbability[l] = arena_.takeZero<float>(padded(n));
  }
  return sampling;
}

// Spawns the rays that continue paths at surfaces with one non-specular lobe.
void TileRenderer::continueAtOneLobe(const RtsBatch& batch, const Sampling& sampling,
                                     Paths& paths) {
  ArenaScope scope(arena_);
  const uint32_t n = batch.points->hits.count;
  for (uint32_t i = 0; i < n; i++) samples_.markRandom(paths.states.path[batch.order[i]]);
  const Continuation from{.points = batch.points,
                          .states = &paths.states,
                          .order = batch.order,
                          .lobe = &batch.lobes[0],
                          .transmits = nonSpecularFunctions(batch.lobes[0])->transmits != 0,
                          .samples = sampling.samples[0],
                          .survival = level_ >= rouletteFrom ? sampling.choices[1] : nullptr,
                          .selectionProbability = sampling.selectionProbability[0]};
  continuePaths(from, arena_.take<uint32_t>(padded(n) + lanes), next_);
}

// Spawns a ray straight through a boundary that has no effect on light.
void TileRenderer::passThroughBoundary(const Points& points, uint32_t i, uint32_t lane,
                                       const Crossing& crossing, Paths& paths) {
  const RayState ray = paths.states[lane];
  NextRay nextRay{.weight = {1, 1, 1},
                  .pdf = 0,
                  .deflected = false,
                  .split = false,
                  .twoSided = false,
                  .channel = ray.flags.channel(),
                  .branch = ray.branch};
  for (int k = 0; k < 3; k++) nextRay.direction[k] = points.hits.direction[k][i];
  nextRay.media = crossing.behind;
  push(points, i, lane, nextRay, paths);
}

// Spawns the rays that continue the path from hit i: all samples, or one selected sample.
// Writes the selection probability of each lobe's sample. The probability must not depend on the
// sampled directions, because the MIS weights of light sampling use it.
void TileRenderer::spawnRays(const RtsBatch& batch, uint32_t i, const Sampling& sampling,
                             const Boundaries& boundaries, Paths& paths) {
  const Points& points = *batch.points;
  const uint32_t lane = batch.order[i];
  const RayState ray = paths.states[lane];
  const bool path = tracesPaths(scene_.frame.transport),
             images = followsImages(scene_.frame.transport);
  BsdfSamples bsdfSamples(points.hits, i, boundaries.eta ? boundaries.eta[i] : nullptr,
                          ray.flags.channel());
  for (uint32_t l = 0; l < batch.lobeCount; l++) {
    if (!images && batch.lobes[l].kind != RTS_LOBE_TRANSPARENT) continue;
    bsdfSamples.add(l, batch.lobes[l], sampling.samples[l]);
    if (sampling.samples[l]) samples_.markRandom(ray.path);
  }
  float carried[BsdfSamples::maximum], sum = 0;
  for (uint32_t w = 0; w < bsdfSamples.count; w++) {
    const BsdfSample& sample = bsdfSamples.list[w];
    const float left[3] = {sample.expectedWeight[0] * ray.throughput[0],
                           sample.expectedWeight[1] * ray.throughput[1],
                           sample.expectedWeight[2] * ray.throughput[2]};
    sum += carried[w] = largest(left);
  }
  if (!(sum > 0)) return;
  const bool all = !path || bsdfSamples.count == 1 || ray.flags.splits() == 0;
  for (uint32_t w = 0; w < bsdfSamples.count; w++)
    if (float* probability = sampling.selectionProbability[bsdfSamples.list[w].lobe])
      probability[i] = all ? 1 : carried[w] / sum;
  const float choice = path ? sampling.choices[0][i] : 0,
              survival = path ? sampling.choices[1][i] : 0;
  const auto send = [&](uint32_t w, float probability) {
    const BsdfSample& sample = bsdfSamples.list[w];
    if (sample.rejected) return;
    float kept = probability;
    if (path && level_ >= rouletteFrom) {
      const float stay = std::min(1.0f, carried[w] / probability);
      if (stay < 1) samples_.markRandom(ray.path);
      if (survival >= stay) return;
      kept *= stay;
    } else if (!path && carried[w] < scene_.frame.energyCut) {
      for (int k = 0; k < 3; k++)
        ledger_.cutByEnergy += double(sample.expectedWeight[k]) * double(ray.throughput[k]);
      return;
    }
    NextRay nextRay{.pdf = sample.pdf * probability,
                    .deflected = sample.deflected,
                    .split = bsdfSamples.count > 1,
                    .twoSided = sample.pdf > 0 && transmitsAt(batch, i),
                    .channel = sample.channel,
                    .branch = w == 0 ? ray.branch : hash(ray.branch + w, level_ + 1)};
    float towards = 0;
    for (int k = 0; k < 3; k++) {
      nextRay.direction[k] = sample.direction[k];
      nextRay.weight[k] = sample.weight[k] / kept;
      towards += points.hits.geometric[k][i] * sample.direction[k];
    }
    nextRay.media = towards < 0 && boundaries.crossing ? boundaries.crossing[i].behind : ray.media;
    push(points, i, lane, nextRay, paths);
  };
  if (all) {
    for (uint32_t w = 0; w < bsdfSamples.count; w++) send(w, 1);
    return;
  }
  samples_.markRandom(ray.path);
  const uint32_t chosen = sampleDiscrete(carried, bsdfSamples.count, choice * sum);
  if (carried[chosen] > 0) send(chosen, carried[chosen] / sum);
}

} // namespace openrt
