#include "render/surface/projected_pdfs.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "render/surface/lobes.h"

namespace openrt {
namespace {

constexpr float ofLambert = std::numbers::inv_pi_v<float>;

// Returns the pdfs per solid angle of the directions to the origins of the rays, for paths that
// arrive from the directions.
const float* reversePdfs(const RtsBatch& batch, const RtsLobe& lobe, uint32_t n,
                         const uint32_t* hit, const float* const direction[3]) {
  Arena& arena = batch.arena;
  const RtsHits& hits = batch.points->hits;
  float *arrival[3], *origin[3];
  for (int k = 0; k < 3; k++) {
    arrival[k] = arena.takeZero<float>(padded(hits.count));
    origin[k] = arena.takeZero<float>(padded(n));
  }
  for (uint32_t i = 0; i < n; i++) {
    store(-load(direction, i), arrival, hit[i]);
    store(-load(hits.direction, hit[i]), origin, i);
  }
  RtsHits reversed = hits;
  std::copy_n(arrival, 3, reversed.direction);
  LobeValues values(arena, n, &batch);
  values.evaluate(lobe, reversed, n, hit, origin);
  return values.pdf;
}

} // namespace

ProjectedPdfs projectedPdfs(const RtsBatch& batch, const RtsLobe& lobe, uint32_t n,
                            const uint32_t* hit, const float* const direction[3],
                            const float* pdf) {
  Arena& arena = batch.arena;
  const ProjectedPdfs out{arena.take<float>(padded(n)), arena.take<float>(padded(n))};
  if (lobe.kind == RTS_LOBE_DIFFUSE) {
    std::fill_n(out.ahead, n, ofLambert);
    std::fill_n(out.back, n, ofLambert);
    return out;
  }
  ArenaScope scope(arena);
  const float* reverse = reversePdfs(batch, lobe, n, hit, direction);
  for (uint32_t i = 0; i < n; i++) {
    const Vec3f normal = load(lobe.normal, hit[i]);
    const float cosine = dot(normal, load(direction, i)),
                arriving = std::fabs(dot(normal, load(batch.points->hits.direction, hit[i])));
    out.ahead[i] = cosine > 0 ? pdf[i] / cosine : ofLambert;
    out.back[i] = !(cosine > 0) ? ofLambert : arriving > 0 ? reverse[i] / arriving : 0.0f;
  }
  return out;
}

} // namespace openrt
