#include "render/path/spawn_rays.h"

#include <algorithm>

#include "render/lights/emitted.h"
#include "render/path/wave.h"
#include "render/surface/bsdf_choice.h"
#include "render/surface/continue_paths.h"
#include "scene/transports.h"

namespace openrt {
namespace {

// Returns whether the lobe has one sample at each hit, whose expected weight is the lobe's weight.
bool hasOneSample(const RtsLobe& lobe) {
  return lobe.kind == RTS_LOBE_DIFFUSE || lobe.kind == RTS_LOBE_CUSTOM;
}

struct NextRay { // a ray to be spawned at a hit
  Vec3f direction, weight;
  float pdf;
  // twoSided: the lobes of the hit respond to light from both sides.
  bool deflected, split, twoSided;
  uint8_t channel;
  uint32_t branch;
  MediaStack media;
};

// Queues another ray of the path at hit i.
void spawnRay(const CameraPaths& paths, uint32_t i, const NextRay& nextRay) {
  const Points& points = *paths.batch.points;
  RayState ray = (*paths.batch.states)[paths.batch.order[i]];
  ray.throughput *= nextRay.weight;
  ray.travelled = points.hits.distance[i];
  ray.pdf = nextRay.pdf;
  const bool specular = !(nextRay.pdf > 0);
  if (!specular) ray.previous = lightSampleContext(points, i, nextRay.twoSided);
  if (nextRay.deflected) {
    const PathClass before = ray.flags.pathClass();
    if (before == PathClass::undeflected)
      ray.flags.setClass(specular ? PathClass::specularFirst : PathClass::diffuse);
    else if (before != PathClass::specularFirst)
      ray.flags.setClass(specular ? PathClass::caustic : PathClass::diffuse);
    if (!specular) ray.flags.set(PathFlags::scatteredBit, true);
    ray.flags.set(PathFlags::specularSinceDiffuseBit, ray.flags.scattered() && specular);
    paths.unsampled.send(ray.flags, ray.throughput);
    ray.flags.set(PathFlags::deflectedBit, true);
  }
  ray.branch = nextRay.branch;
  ray.flags.setChannel(nextRay.channel);
  ray.media = nextRay.media;
  if (nextRay.split) ray.flags.addSplit();
  queueRay(points, i, nextRay.direction, ray, paths.next);
}

// Spawns the rays at surfaces with one non-specular lobe, with vector lanes.
void continueAtOneLobe(const CameraPaths& paths, const LobeSampling& sampling) {
  const RtsBatch& batch = paths.batch;
  ArenaScope scope(*batch.arena);
  const uint32_t n = batch.points->hits.count;
  for (uint32_t i = 0; i < n; i++) paths.samples.markRandom(batch.states->path[batch.order[i]]);
  const Continuation from{.points = batch.points,
                          .states = batch.states,
                          .order = batch.order,
                          .lobe = &batch.lobes[0],
                          .transmits = nonSpecularFunctions(batch.lobes[0])->transmits != 0,
                          .samples = sampling.samples[0],
                          .survival = sampling.choices[1],
                          .selectionProbability = sampling.selectionProbability[0]};
  continuePaths(from, batch.arena->take<uint32_t>(padded(n) + lanes), paths.next);
}

// Spawns the rays at hit i: all samples, or one selected sample. Writes the selection probability
// of each lobe's sample. The probability must not depend on the sampled directions, because the MIS
// weights of light sampling use it.
void spawnRaysAt(const CameraPaths& paths, uint32_t i, const LobeSampling& sampling,
                 const Boundaries& boundaries) {
  const RtsBatch& batch = paths.batch;
  const Points& points = *batch.points;
  const RayState ray = (*batch.states)[batch.order[i]];
  const edit::FrameSettingsT& frame = batch.scene->frame;
  const bool path = tracesPaths(frame.transport), images = followsImages(frame.transport);
  BsdfSamples bsdfSamples(points.hits, i, boundaries.etaAt(i), ray.flags.channel());
  for (uint32_t l = 0; l < batch.lobeCount; l++) {
    if (!images && batch.lobes[l].kind != RTS_LOBE_TRANSPARENT) continue;
    bsdfSamples.add(l, batch.lobes[l], sampling.samples[l]);
    if (sampling.samples[l]) paths.samples.markRandom(ray.path);
  }
  const BsdfChoice choice(bsdfSamples, ray.throughput);
  if (!(choice.sum > 0)) return;
  const bool all = !path || bsdfSamples.count == 1 || ray.flags.splits() < mostSplits;
  for (uint32_t w = 0; w < bsdfSamples.count; w++)
    if (float* probability = sampling.selectionProbability[bsdfSamples.list[w].lobe])
      probability[i] = all ? 1 : choice.probability(w);
  const auto send = [&](uint32_t w, float probability) {
    const BsdfSample& sample = bsdfSamples.list[w];
    if (sample.rejected) return;
    float kept = probability;
    if (path) {
      const float survival =
          survivalProbability(choice.carried[w] / (probability * certainThroughput));
      if (survival < 1) paths.samples.markRandom(ray.path);
      if (sampling.choices[1][i] >= survival) return;
      kept *= survival;
    } else if (choice.carried[w] < frame.energyCut) {
      for (int k = 0; k < 3; k++)
        paths.ledger.cutByEnergy += double(sample.expectedWeight[k]) * double(ray.throughput[k]);
      return;
    }
    spawnRay(paths, i,
             {.direction = sample.direction,
              .weight = sample.weight / kept,
              .pdf = sample.pdf * probability,
              .deflected = sample.deflected,
              .split = bsdfSamples.count > 1,
              .twoSided = sample.pdf > 0 && transmitsAt(batch, i),
              .channel = sample.channel,
              .branch = w == 0 ? ray.branch : hash(ray.branch + w, paths.level + 1),
              .media = mediaTowards(points, i, sample.direction, boundaries, ray.media)});
  };
  if (all) {
    for (uint32_t w = 0; w < bsdfSamples.count; w++) send(w, 1);
    return;
  }
  paths.samples.markRandom(ray.path);
  const uint32_t chosen = choice.select(sampling.choices[0][i]);
  if (choice.carried[chosen] > 0) send(chosen, choice.probability(chosen));
}

} // namespace

void spawnStraightRay(const CameraPaths& paths, uint32_t i, const Vec3f& weight,
                      const MediaStack& media) {
  const PathStates& states = *paths.batch.states;
  const uint32_t lane = paths.batch.order[i];
  spawnRay(paths, i,
           {.direction = load(paths.batch.points->hits.direction, i),
            .weight = weight,
            .pdf = 0,
            .deflected = false,
            .split = false,
            .twoSided = false,
            .channel = states.flagsOf(lane).channel(),
            .branch = states.branch[lane],
            .media = media});
}

void spawnRays(const CameraPaths& paths, const LobeSampling& sampling,
               const Boundaries& boundaries) {
  const RtsBatch& batch = paths.batch;
  if (tracesPaths(batch.scene->frame.transport) && !boundaries.crossing && batch.lobeCount == 1 &&
      hasOneSample(batch.lobes[0]))
    return continueAtOneLobe(paths, sampling);
  constexpr Vec3f clear{1, 1, 1};
  for (uint32_t i = 0; i < batch.points->hits.count; i++) {
    if (boundaries.visibleAt(i))
      spawnRaysAt(paths, i, sampling, boundaries);
    else
      spawnStraightRay(paths, i, clear, boundaries.crossing[i].behind);
  }
}

} // namespace openrt
