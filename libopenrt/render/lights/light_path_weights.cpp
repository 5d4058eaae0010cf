#include "render/lights/light_path_weights.h"

#include <algorithm>

#include "render/lights/emitted.h"
#include "render/lights/light_sources.h"
#include "render/surface/projected_pdfs.h"
#include "render/wave/nearest_hits.h"

namespace openrt {

bool isAimedAt(const RtsBatch& batch, uint32_t i) {
  const RenderScene& scene = batch.scene;
  return LightSources::isTarget(scene, scene.records[batch.points->record[i]],
                                LightSources::Kind::glossy);
}

float connectionsAt(const RenderScene& scene, PathFlags path, const Vec3f& throughput) {
  if (!scene.connectsGlossy || path.pathClass() != PathClass::specularFirst || path.scattered())
    return 0;
  // The number with the least variance at equal cost is proportional to what the path carries.
  return std::min(1.0f, largest(throughput));
}

float backOfCameraPath(const RtsBatch& batch, const RtsLobe& lobe, uint32_t i, float back) {
  const uint32_t lane = batch.order[i];
  if (!batch.states->flagsOf(lane).connectable()) return back;
  return spreadTo(batch.states->previousOf(lane).position, load(batch.points->hits.position, i),
                  load(lobe.normal, i));
}

float lightPathRatio(const RenderScene& scene, uint32_t shape, const Vec3f& place, float surfaces,
                     float glossyPdf, float lightPdf) {
  if (!(surfaces > 0) || !(glossyPdf > 0) || !std::isfinite(lightPdf)) return 0;
  return float(scene.glossySources->startPdf(scene, shape, place) * double(surfaces) /
               camerasPerGlossyPath) *
         (glossyPdf / (glossyPdf + lightPdf));
}

float mirrorPathRatio(const RenderScene& scene, uint32_t shape, const Vec3f& place,
                      float surfaces) {
  if (!(surfaces > 0)) return 0;
  return float(scene.lightSources->startPdf(scene, shape, place) * double(surfaces) *
               scene.lightPathsOfCameraPath);
}

namespace {

// Returns which of n rays meet a face; null in scenes where none of these is a culled back.
const uint8_t* findOneWay(const RtsBatch& batch, const Rays& rays, const uint32_t* ray,
                          uint32_t n) {
  const Intersector& kernel = *batch.scene.kernel;
  if (!kernel.cullsBacks()) return nullptr;
  auto* blocked = batch.arena.take<uint8_t>(padded(n));
  batch.counters.shadow += n;
  kernel.occluded(copyRays(rays, ray, n, batch.arena), maskAll, Coherence::incoherent, blocked);
  return blocked;
}

} // namespace

const float* cameraPathShares(const RtsBatch& batch, const RtsLobe& lobe, const float* pdf,
                              const LightSamples& samples) {
  if (!batch.scene.glossySources || !isGlossy(lobe)) return nullptr;
  Arena& arena = batch.arena;
  const Rays& rays = samples.rays;
  const uint32_t size = padded(rays.count);
  auto* share = arena.take<float>(size);
  std::fill_n(share, size, 1.0f);
  ArenaScope scope(arena);
  auto *ray = arena.take<uint32_t>(size), *hit = arena.take<uint32_t>(size);
  auto* ahead = arena.take<float>(size);
  float* const direction[3] = {arena.take<float>(size), arena.take<float>(size),
                               arena.take<float>(size)};
  uint32_t n = 0;
  for (uint32_t r = 0; r < rays.count; r++) {
    const uint32_t i = samples.hit[r], lane = batch.order[i];
    const PathFlags flags = batch.states->flagsOf(lane);
    if (samples.shape[r] == EmissiveShapes::none || !(batch.states->lightPathRatio[lane] > 0) ||
        !flags.scattered() || !sharesGlossy(batch.scene, flags) || !isAimedAt(batch, i))
      continue;
    ray[n] = r;
    hit[n] = i;
    ahead[n] = pdf[r];
    store(load(rays.dir, r), direction, n++);
  }
  if (n == 0) return nullptr;
  const uint8_t* oneWay = findOneWay(batch, rays, ray, n);
  const ProjectedPdfs pdfs = projectedPdfs(batch, lobe, n, hit, direction, ahead);
  for (uint32_t j = 0; j < n; j++) {
    const uint32_t r = ray[j], i = hit[j];
    const float back = backOfCameraPath(batch, lobe, i, pdfs.back[j]);
    const Vec3f towards = load(rays.dir, r);
    const float cosine = std::fabs(dot(load(lobe.normal, i), towards));
    if (!(pdfs.ahead[j] > 0) || (oneWay && oneWay[j])) continue;
    share[r] = cameraPathShare(lightPathRatio(
        batch.scene, samples.shape[r],
        lightSampleContext(*batch.points, i, false).position + samples.distance[r] * towards,
        batch.states->lightPathRatio[batch.order[i]] * back / pdfs.ahead[j], pdfs.ahead[j] * cosine,
        samples.pdf[r]));
  }
  return share;
}

} // namespace openrt
