#include "render/path/light_path_ratios.h"

#include <algorithm>
#include <cmath>

#include "render/lights/emitted.h"
#include "render/lights/light_path_weights.h"
#include "render/path/camera_connections.h"

namespace openrt {
namespace {

// Pairs of a hit and a direction.
struct Pairs {
  uint32_t count = 0;
  uint32_t* hit;
  float *direction[3], *pdf;

  Pairs(Arena& arena, uint32_t capacity) {
    hit = arena.take<uint32_t>(padded(capacity));
    pdf = arena.take<float>(padded(capacity));
    for (auto& a : direction) a = arena.take<float>(padded(capacity));
  }
  void add(const SampleArrays& sample, uint32_t i) {
    hit[count] = i;
    pdf[count] = sample.pdf[i];
    store(load(sample.direction, i), direction, count++);
  }
  ProjectedPdfs projected(const RtsBatch& batch, const RtsLobe& lobe) const {
    return projectedPdfs(batch, lobe, count, hit, direction, pdf);
  }
};

// Returns by hit the ratios of the camera paths that have arrived; 0 where light paths do not make
// them. At the first surface the factor for the direction to the camera is in it, or the number of
// connections.
const float* ratiosOfArrived(const RtsBatch& batch) {
  Arena& arena = batch.arena;
  const PathStates& states = *batch.states;
  const uint32_t n = batch.points->hits.count;
  auto* ratio = arena.takeZero<float>(padded(n));
  ArenaScope scope(arena);
  auto* first = arena.take<uint32_t>(padded(n));
  uint32_t count = 0;
  for (uint32_t i = 0; i < n; i++) {
    const uint32_t lane = batch.order[i];
    const PathFlags flags = states.flagsOf(lane);
    ratio[i] =
        flags.scattered()
            ? states.lightPathRatio[lane]
            : connectionRatio(connectionsAt(batch.scene, flags, load(states.throughput, lane)));
    if (flags.pathClass() == PathClass::undeflected && states.lightPathRatio[lane] > 0)
      first[count++] = i;
  }
  if (count == 0) return ratio;
  const float* pixels = coveredPixels(batch, first, count);
  for (uint32_t j = 0; j < count; j++)
    if (pixels[j] > 0) ratio[first[j]] = states.lightPathRatio[batch.order[first[j]]] / pixels[j];
  return ratio;
}

} // namespace

float firstRatio(const RenderScene& scene) {
  if (!scene.showsGlossy && !scene.sharesMirrors) return 0;
  return float(scene.frame.width) * float(scene.frame.height);
}

void countCameraPaths(const RtsBatch& batch, BsdfSampleArrays& samples) {
  Arena& arena = batch.arena;
  const uint32_t n = batch.points->hits.count;
  const float* arrived = ratiosOfArrived(batch);
  for (SampleArrays& sample : samples) {
    if (!sample.pdf) continue;
    auto *ratio = arena.takeZero<float>(padded(n)), *glossy = arena.takeZero<float>(padded(n));
    sample.lightPathRatio = ratio;
    sample.glossyPdf = glossy;
    ArenaScope scope(arena);
    Pairs pairs(arena, n);
    for (uint32_t i = 0; i < n; i++)
      if (arrived[i] > 0 && sample.kept[i] > 0 && sample.pdf[i] > 0) pairs.add(sample, i);
    if (pairs.count == 0) continue;
    const ProjectedPdfs pdfs = pairs.projected(batch, *sample.lobe);
    for (uint32_t j = 0; j < pairs.count; j++) {
      const uint32_t i = pairs.hit[j];
      const PathFlags flags = batch.states->flagsOf(batch.order[i]);
      if (!(pdfs.ahead[j] > 0)) continue;
      const float cosine = std::fabs(dot(load(sample.lobe->normal, i), load(pairs.direction, j)));
      const float back =
          flags.scattered() ? backOfCameraPath(batch, *sample.lobe, i, pdfs.back[j]) : 1.0f;
      ratio[i] = arrived[i] * back / pdfs.ahead[j];
      // A geometry term has this cosine, and backOfCameraPath() the rest.
      if (!flags.scattered() && flags.pathClass() == PathClass::specularFirst) ratio[i] /= cosine;
      if (flags.scattered() && sharesGlossy(batch.scene, flags) && isGlossy(*sample.lobe) &&
          isAimedAt(batch, i))
        glossy[i] = pdfs.ahead[j] * cosine;
    }
  }
}

const float* lightPathFactors(const RtsBatch& batch, const RtsLobe& lobe,
                              const HitDirections& pairs, const ProjectedPdfs& pdfs,
                              const float* to, const LightStarts& starts) {
  const LightSources::LightRay* const* start = starts.ray;
  Arena& arena = batch.arena;
  const RtsHits& hits = batch.points->hits;
  auto* factor = arena.take<float>(padded(pairs.count));
  ArenaScope scope(arena);
  for (uint32_t j = 0; j < pairs.count; j++)
    factor[j] = pdfs.back[j] > 0 ? to[j] / pdfs.back[j] : 0.0f;
  if (starts.sources.kind() != LightSources::Kind::glossy) {
    for (uint32_t j = 0; j < pairs.count; j++)
      if (const LightSources::LightRay* ray = start[pairs.hit[j]];
          ray && ray->shape != LightSources::none)
        factor[j] = mirrorPathRatio(batch.scene, ray->shape, ray->place.position, factor[j]);
    return factor;
  }
  FoundShapes found;
  found.allocate(arena, pairs.count);
  auto* pair = arena.take<uint32_t>(pairs.count);
  for (uint32_t j = 0; j < pairs.count; j++) {
    const uint32_t i = pairs.hit[j];
    if (!start[i]) continue;
    const LightSampleContext from = lightSampleContext(*batch.points, i, transmitsAt(batch, i));
    pair[found.count] = j;
    store(from.position, found.position, found.count);
    store(from.normal, found.normal, found.count);
    store(-load(hits.direction, i), found.direction, found.count);
    found.shape[found.count++] = start[i]->shape;
  }
  if (found.count == 0) return factor;
  auto* lightPdf = arena.take<float>(padded(found.count));
  batch.scene.emitters->pdf(found, lightPdf);
  for (uint32_t f = 0; f < found.count; f++) {
    const uint32_t j = pair[f], i = pairs.hit[j];
    const float cosine = std::fabs(dot(load(lobe.normal, i), load(hits.direction, i)));
    factor[j] = lightPathRatio(batch.scene, start[i]->shape, start[i]->place.position, factor[j],
                               pdfs.back[j] * cosine, lightPdf[f]);
  }
  return factor;
}

const float* countLightPaths(const RtsBatch& batch, const SampleArrays& sample,
                             const uint32_t* number, uint32_t selected, const LightStarts& starts) {
  Arena& arena = batch.arena;
  const uint32_t n = batch.points->hits.count;
  auto* byHit = arena.takeZero<float>(padded(n));
  ArenaScope scope(arena);
  Pairs pairs(arena, n);
  for (uint32_t i = 0; i < n; i++)
    if (number[i] == selected && sample.pdf[i] > 0) pairs.add(sample, i);
  if (pairs.count == 0) return byHit;
  const ProjectedPdfs pdfs = pairs.projected(batch, *sample.lobe);
  const float* factor = lightPathFactors(
      batch, *sample.lobe, {pairs.count, pairs.hit, pairs.direction}, pdfs, pdfs.ahead, starts);
  for (uint32_t j = 0; j < pairs.count; j++) byHit[pairs.hit[j]] = factor[j];
  return byHit;
}

void firstSurfaceShares(const RtsBatch& batch, const RtsLobe& lobe, uint32_t n, const uint32_t* hit,
                        const float* const direction[3], const float* pdf, const float* ratio,
                        float* share) {
  ArenaScope scope(batch.arena);
  const ProjectedPdfs pdfs = projectedPdfs(batch, lobe, n, hit, direction, pdf);
  for (uint32_t i = 0; i < n; i++)
    if (std::isinf(ratio[i]))
      share[i] = 1;
    else
      share[i] = pdfs.back[i] > 0 ? lightPathShare(ratio[i] / pdfs.back[i]) : 0.0f;
}

} // namespace openrt
