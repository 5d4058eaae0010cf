// doubts.h: tells which answers of Embree for a query are decided again, exactly, because single
// precision may have decided wrongly. Made for each query. [any thread]
#pragma once

#include <algorithm>
#include <cmath>

#include "backend/local/ray_triangle.h"
#include "render/rays.h"
#include "render/records.h"

namespace openrt {

struct Doubts {
  Vec3f low, high; // bounds of the scene in render space, with a margin
  float size = 0;  // the largest extent of the bounds
  float error = 0; // what Embree errs by along a ray within the scene
  float scale = 1; // from render space to that of Embree's scenes (Accel::scale)

  Doubts(const Intersector& scene, float toKernel) : scale(toKernel) {
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
  // A hit near the edge of its triangle may belong to the neighbour, or be none. Embree takes the
  // corners relative to the origin of the ray. So its weights err by what their distance is rounded
  // by, over the height of the triangle as the ray sees it.
  static bool isNearEdge(const Record& r, const Rays& rays, uint32_t i, const RayHits& hits) {
    const float inner = std::min({hits.u[i], hits.v[i], 1 - hits.u[i] - hits.v[i]});
    if (!(inner >= 0x1p-12f)) return true;
    const Vec3f o = load(rays.org, i);
    Vec3f corner[3];
    float reach = 0, longest = 0;
    for (int k = 0; k < 3; k++) {
      corner[k] = r.placeOf(r.corner(hits.primitive[i], k));
      // The ray is moved into the frame of an instance, which rounds the coordinates themselves.
      reach = std::max(reach, r.instanced ? largest(abs(corner[k])) + largest(abs(o))
                                          : largest(abs(corner[k] - o)));
    }
    for (int k = 0; k < 3; k++)
      longest = std::max(longest, largest(abs(corner[(k + 1) % 3] - corner[k])));
    const Vec3f direction = load(rays.dir, i), // area: twice that of the triangle's projection
        n = cross(corner[1] - corner[0], corner[2] - corner[0]);
    const float area = std::fabs(dot(n, direction)) / length(direction);
    return !(inner * area > 0x1p-20f * reach * longest);
  }
  // A hit at the start or end of a ray may lie beyond it.
  bool isNearEnd(const Rays& rays, uint32_t i, float t) const {
    const float size = largest(abs(load(rays.dir, i))),
                slack = error + 0x1p-22f * largest(abs(load(rays.org, i)));
    return !((t - rays.tnear[i]) * size > slack && (rays.tfar[i] - t) * size > slack);
  }
  // A hit at a grazing angle may lie elsewhere, or be none (ray_triangle.h).
  static bool isGrazing(const Record& r, const Vec3f& kernelNormal, const Vec3f& direction) {
    return grazes(r.instanced ? r.frames->kernelNormal * kernelNormal : kernelNormal, direction);
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
      const float u = us[i], v = vs[i], t = ts[i], along = dot(n, d), reach = t * scale;
      const float slack = error + 0x1p-22f * largest(abs(Vec3f{ox[i], oy[i], oz[i]})),
                  size = largest(abs(d)), inner = std::min(std::min(u, v), 1 - u - v);
      // The longest edge is at most 12 times the root of twice the area: what is longer is a sliver
      // (sliver_edges.cpp), and is not tested in single precision.
      const bool inside =
                     (inner >= 0x1p-12f) &
                     (inner * inner * (along * along) >
                      0x1p-33f * (reach * reach) * (dot(d, d) * dot(d, d)) * std::sqrt(dot(n, n))),
                 apart = ((t - near[i]) * size > slack) & ((far[i] - t) * size > slack),
                 steep = along * along > 0x1p-12f * dot(n, n) * dot(d, d), front = along < 0;
      suspects[i] = !(inside & apart & steep & front);
    }
  }
  // Only triangles have edges. Analytic surfaces are met in double precision, at any angle.
  bool hit(const Record& r, const Rays& rays, uint32_t i, const RayHits& hits) const {
    return isNearEnd(rays, i, hits.t[i]) ||
           (r.primitive == edit::Primitive::Triangles &&
            (isNearEdge(r, rays, i, hits) || isGrazing(r, load(hits.ng, i), load(rays.dir, i))));
  }
};

} // namespace openrt
