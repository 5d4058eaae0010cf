#include "render/path/spawn_rays.h"

#include <algorithm>
#include <utility>

#include "render/lights/emitters.h"
#include "render/lights/shadows.h"
#include "render/path/guided_rays.h"
#include "render/path/light_path_ratios.h"
#include "render/surface/continue_paths.h"
#include "render/wave/wave.h"
#include "scene/transports.h"

namespace openrt {
namespace {

// Marks the paths that have taken a random decision. Sampling a lobe is one, too.
void markRandom(const CameraPaths& paths, const BsdfSampleArrays& samples,
                const Boundaries& boundaries, const uint32_t* random) {
  const RtsBatch& batch = paths.batch;
  bool scatters = false;
  for (const SampleArrays& sample : samples) scatters |= sample.pdf != nullptr;
  for (uint32_t i = 0; i < batch.points->hits.count; i++)
    if (random[i] || (scatters && boundaries.visibleAt(i)))
      paths.samples.markRandom(batch.states->path[batch.order[i]]);
}

// Counts what the samples would carry that the energy cut ends.
void countCut(const CameraPaths& paths, const BsdfSampleArrays& samples) {
  const RtsBatch& batch = paths.batch;
  for (uint32_t i = 0; i < batch.points->hits.count; i++)
    for (const SampleArrays& sample : samples) {
      Vec3f weight;
      if (sample.kept[i] > 0 || sample.number[i] == SampleArrays::lacking) continue;
      if (!weightAt(*sample.lobe, i, weight)) continue;
      const float share = sample.share ? sample.share[i] : 1;
      const Vec3f throughput = load(batch.states->throughput, batch.order[i]);
      for (uint32_t k = 0; k < 3; k++)
        if (!sample.colour || sample.colour == k + 1)
          paths.ledger.cutByEnergy += double(weight[k] * share) * double(throughput[k]);
    }
}

// Counts the rays of the queue, from ray `begin` on, that only BSDF sampling connects to emitters.
void countUnsampled(const CameraPaths& paths, size_t begin) {
  const PathStates& states = paths.next.states();
  for (size_t r = begin; r < paths.next.size(); r++)
    paths.unsampled.send(states.flagsOf(r), load(states.throughput, r), states.unguidedWeight[r]);
}

// Returns by hit 1 where light samples do not pass what the surface transmits straight on; null if
// they pass everywhere.
const uint32_t* findUnsampled(const RtsBatch& batch) {
  const uint32_t n = batch.points->hits.count;
  auto* unsampled = batch.arena.take<uint32_t>(padded(n));
  bool any = false;
  for (uint32_t i = 0; i < n; i++) any |= (unsampled[i] = !passesStraight(shaderAt(batch, i))) != 0;
  return any ? unsampled : nullptr;
}

// Spawns the rays of the BSDF samples: those of one sample of all hits, then those of the next.
void followSamples(const CameraPaths& paths, const LobeSampling& sampling,
                   const Boundaries& boundaries, BsdfSampleArrays& samples) {
  const RtsBatch& batch = paths.batch;
  Arena& arena = batch.arena;
  const uint32_t n = batch.points->hits.count;
  const bool path = tracesPaths(batch.scene.frame.transport),
             straight = std::any_of(samples.begin(), samples.end(),
                                    [](const SampleArrays&sample) { return !sample.deflected; });
  const Continuation from{
      .points = batch.points,
      .states = batch.states,
      .level = paths.level,
      .choice = sampling.choices[0],
      .survival = sampling.choices[1],
      .energyCut = batch.scene.frame.energyCut,
      .crossing = boundaries.crossing,
      .throughFog = batch.throughFog,
      .twoSided = path ? transmitsByHit(batch) : nullptr,
      .unsampled = straight && path && batch.scene.emitters->any() ? findUnsampled(batch) : nullptr,
      .count = arena.take<uint32_t>(padded(n)),
      .random = arena.take<uint32_t>(padded(n))};
  chooseSamples(from, samples);
  if (batch.scene.countsLightPaths()) countCameraPaths(batch, samples);
  if (path)
    markRandom(paths, samples, boundaries, from.random);
  else
    countCut(paths, samples);
  auto* hitOf = arena.take<uint32_t>(padded(n) + lanes);
  for (const SampleArrays& sample : std::as_const(samples)) {
    const size_t begin = paths.next.size();
    continuePaths(from, sample, hitOf, paths.next);
    if (!sample.pdf && (sample.deflected || from.unsampled)) countUnsampled(paths, begin);
  }
}

// Spawns a ray through a boundary that has no effect.
void passBoundary(const CameraPaths& paths, uint32_t i, const MediaStack& behind) {
  const RenderScene& scene = paths.batch.scene;
  const bool sampled = !scene.emitters->any() ||
                       (scene.samplesPass && (shaderAt(paths.batch, i).traits & RTS_TRANSPARENT));
  spawnStraightRay(paths, i, {1, 1, 1}, behind, {.guided = true, .sampled = sampled});
}

} // namespace

const ShaderSlot& shaderAt(const RtsBatch& batch, uint32_t i) {
  return (*batch.scene.shaders)[batch.scene.records[batch.points->record[i]].shader];
}

void spawnStraightRay(const CameraPaths& paths, uint32_t i, const Vec3f& weight,
                      const MediaStack& media, const Passage& passage) {
  const Points& points = *paths.batch.points;
  RayState ray = (*paths.batch.states)[paths.batch.order[i]];
  ray.throughput *= weight;
  ray.travelled = points.hits.distance[i];
  ray.flags.addPassage();
  if (!passage.sampled && ray.pdf > 0) {
    ray.pdf = 0;
    ray.flags.set(PathFlags::passedUnsampledBit, true);
    paths.unsampled.send(ray.flags, ray.throughput);
  }
  if (!passage.guided) ray.unguidedWeight = 1;
  ray.media = media;
  queueRay(points, i, load(points.hits.direction, i), ray, paths.next);
}

void spawnRays(const CameraPaths& paths, const LobeSampling& sampling,
               const Boundaries& boundaries) {
  const RtsBatch& batch = paths.batch;
  ArenaScope scope(batch.arena);
  weightUnguided(batch, boundaries);
  BsdfSampleArrays samples(batch, sampling, boundaries, TransportMode::radiance,
                           !followsImages(batch.scene.frame.transport));
  if (!samples.empty()) followSamples(paths, sampling, boundaries, samples);
  if (!boundaries.crossing) return;
  for (uint32_t i = 0; i < batch.points->hits.count; i++)
    if (!boundaries.visibleAt(i)) passBoundary(paths, i, boundaries.crossing[i].behind);
}

} // namespace openrt
