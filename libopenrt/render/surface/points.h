// points.h: hits become shading points, sorted into buckets of one shader class and one set of
// lights. [render]
#pragma once

#include <bit>
#include <vector>

#include "render/render_scene.h"

namespace openrt {

struct BucketRange {
  uint32_t bucket, begin, end; // in the sorted order
};

// Shading points of one bucket, with what the host keeps beside.
struct Points {
  RtsHits hits;
  float* error;           // bound of the position's rounding error along the geometric normal
  const uint32_t* record; // Record of each
  const RayHits* rayHits; // where they come from, and
  const uint32_t* order;  // their lanes there
};

// Stable counting sort of n ray lanes by the bucket of the record each has hit: order gets the
// lanes, the result the ranges. counts is working storage kept between calls.
void sortByBucket(const RenderScene& scene, const RayHits& hits, const uint32_t* rayLanes,
                  uint32_t n, uint32_t* order, std::vector<uint32_t>& counts,
                  std::vector<BucketRange>& ranges);

// travelled: path length up to the ray's origin, by ray lane.
Points makePoints(const RenderScene& scene, const Rays& rays, const RayHits& hits,
                  const uint32_t* order, uint32_t n, const float* travelled, Arena& arena);

// Whether the ray has met a surface from its back.
inline bool metFromBehind(const RenderScene& scene, const Rays& rays, const RayHits& hits,
                          uint32_t lane) {
  const Record& r = scene.records[hits.record[lane]];
  float n[3] = {hits.ng[0][lane], hits.ng[1][lane], hits.ng[2][lane]};
  if (r.instanced) {
    const float k[3] = {n[0], n[1], n[2]};
    for (int i = 0; i < 3; i++)
      n[i] =
          r.kernelNormal[i][0] * k[0] + r.kernelNormal[i][1] * k[1] + r.kernelNormal[i][2] * k[2];
  }
  const float d = n[0] * rays.dir[0][lane] + n[1] * rays.dir[1][lane] + n[2] * rays.dir[2][lane];
  return r.flip ? d < 0 : d > 0;
}
// Whether that back is not there.
inline bool culled(const RenderScene& scene, const Rays& rays, const RayHits& hits, uint32_t lane) {
  return scene.records[hits.record[lane]].cull && metFromBehind(scene, rays, hits, lane);
}

// The point of hit i lifted from its flat triangle to the smooth surface that the vertex normals
// describe, on the side that the shading normal is on: J. Hanika, "Hacking the Shadow Terminator",
// Ray Tracing Gems II, ch. 4. False, and nothing written, where the surface is flat.
bool liftToSmooth(const RenderScene& scene, const Points& points, uint32_t i, float out[3]);

// p moved along n (unit) out of the error bound, then one float further on every axis: M. Pharr, W.
// Jakob, G. Humphreys, "Physically Based Rendering", 3rd ed., 3.9.5.
inline void offsetPoint(const float p[3], const float n[3], float error, float out[3]) {
  for (int k = 0; k < 3; k++) {
    const float step = n[k] * error, moved = p[k] + step;
    const int32_t bits = std::bit_cast<int32_t>(moved);
    const int32_t outward =
        (step > 0) == (moved > 0) ? bits + 1 : bits - 1; // away from or towards zero
    const float next = moved != 0 ? std::bit_cast<float>(outward) : step;
    out[k] = step != 0 ? next : moved;
  }
}

// The point of hit i moved off its surface, to the side that a direction leads to.
inline void liftPoint(const Points& points, uint32_t i, const float direction[3], float out[3]) {
  float p[3], n[3], towards = 0;
  for (int k = 0; k < 3; k++) {
    p[k] = points.hits.position[k][i];
    n[k] = points.hits.geometric[k][i];
    towards += n[k] * direction[k];
  }
  const float side = towards > 0 ? 1.0f : -1.0f;
  for (float& x : n) x *= side;
  offsetPoint(p, n, points.error[i], out);
}

} // namespace openrt
