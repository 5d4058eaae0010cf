// doubts.h: tells which answers of Embree for a query are decided again, exactly, because single
// precision may have decided wrongly. Made for each query. [any thread]
#pragma once

#include <algorithm>
#include <cmath>

#include "backend/local/exact.h"
#include "render/rays.h"
#include "render/records.h"

namespace openrt {

struct Doubts {
  Vec3f low, high; // bounds of the scene in render space, with a margin
  float size = 0;  // the largest extent of the bounds
  float error = 0; // what Embree errs by along a ray within the scene

  explicit Doubts(const Intersector& scene) {
    float lowest[3], highest[3];
    scene.bounds(lowest, highest);
    low = vectorOf(lowest);
    high = vectorOf(highest);
    size = largest(high - low);
    error = 0x1p-20f * size;
    const float margin = error + 0x1p-22f * std::max(largest(abs(low)), largest(abs(high)));
    low = low - Vec3f{margin, margin, margin};
    high = high + Vec3f{margin, margin, margin};
  }

  // A ray that hits nothing may have passed through a vertex or an edge, or its end may lie on a
  // surface. It cannot, if it starts outside of everything and has no end.
  bool miss(const Rays& rays, uint32_t i) const {
    const Vec3f o = load(rays.org, i);
    return !std::isinf(rays.tfar[i]) || (o.x >= low.x && o.y >= low.y && o.z >= low.z &&
                                         o.x <= high.x && o.y <= high.y && o.z <= high.z);
  }
  // A hit within 2^-12 of the edge of its triangle may belong to the neighbour, or be none.
  static bool isNearEdge(float u, float v) { return std::min({u, v, 1 - u - v}) < 0x1p-12f; }
  // A hit at the start or end of a ray may lie beyond it.
  bool isNearEnd(const Rays& rays, uint32_t i, float t) const {
    const float size = largest(abs(load(rays.dir, i))),
                slack = error + 0x1p-22f * largest(abs(load(rays.org, i)));
    return !((t - rays.tnear[i]) * size > slack && (rays.tfar[i] - t) * size > slack);
  }
  // A hit at a grazing angle may lie elsewhere, or be none (exact.h).
  static bool isGrazing(const Record& r, const Vec3f& kernelNormal, const Vec3f& direction) {
    return grazes(r.instanced ? r.kernelNormal * kernelNormal : kernelNormal, direction);
  }
  // Returns whether suspect() does not know the front of a record's triangles.
  static bool hidesFront(const Record& r) { return r.instanced | r.flip; }
  // Writes for each ray whether hit() or miss() may hold, or the hit is on a back, so that
  // ClosedBodies may deny it. It knows no records: see hidesFront(). A loop without branches, which
  // the compiler vectorizes.
  void suspect(const Rays& rays, const RayHits& hits, uint8_t* __restrict suspects) const {
    const float *ox = rays.org[0], *oy = rays.org[1], *oz = rays.org[2], *dx = rays.dir[0],
                *dy = rays.dir[1], *dz = rays.dir[2], *nx = hits.ng[0], *ny = hits.ng[1],
                *nz = hits.ng[2], *us = hits.u, *vs = hits.v, *ts = hits.t, *near = rays.tnear,
                *far = rays.tfar;
    for (uint32_t i = 0; i < rays.count; i++) {
      const Vec3f d{dx[i], dy[i], dz[i]}, n{nx[i], ny[i], nz[i]};
      const float u = us[i], v = vs[i], t = ts[i], along = dot(n, d);
      const float slack = error + 0x1p-22f * largest(abs(Vec3f{ox[i], oy[i], oz[i]})),
                  size = largest(abs(d));
      const bool inside = std::min(std::min(u, v), 1 - u - v) >= 0x1p-12f,
                 apart = ((t - near[i]) * size > slack) & ((far[i] - t) * size > slack),
                 steep = along * along > 0x1p-12f * dot(n, n) * dot(d, d), front = along < 0;
      suspects[i] = !(inside & apart & steep & front);
    }
  }
  // Only triangles have edges. Analytic surfaces are met in double precision, at any angle.
  bool hit(const Record& r, const Rays& rays, uint32_t i, const RayHits& hits) const {
    return isNearEnd(rays, i, hits.t[i]) || (r.primitive == edit::Primitive::Triangles &&
                                             (isNearEdge(hits.u[i], hits.v[i]) ||
                                              isGrazing(r, load(hits.ng, i), load(rays.dir, i))));
  }
};

} // namespace openrt
