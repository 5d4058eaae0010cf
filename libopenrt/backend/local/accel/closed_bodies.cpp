// closed_bodies.cpp: finds the closed meshes of a scene (closed_bodies.h).
#include "backend/local/accel/closed_bodies.h"

#include "backend/local/accel/bake.h"

namespace openrt {

// The vector areas of the triangles of a closed mesh add up to 0, and the volumes of the cones from
// any point to them to its volume, which is positive if the corners run counter-clockwise as seen
// from outside (both by the divergence theorem). An open mesh that passes this test only costs
// time, as its hits are then decided exactly.
ClosedBodies::Shape ClosedBodies::shapeOf(const Record& r) {
  Shape shape;
  Box bounds;
  for (uint32_t t = 0; t < r.primitives; t++)
    for (int k = 0; k < 3; k++) bounds.add(Vec3d(r.corner(t, k)));
  if (bounds.empty()) return shape;
  shape.low = bounds.low;
  shape.high = bounds.high;
  const Vec3d center = (bounds.low + bounds.high) * 0.5;
  Vec3d area;
  double total = 0, volume = 0;
  for (uint32_t t = 0; t < r.primitives; t++) {
    const Vec3d a = Vec3d(r.corner(t, 0)) - center, b = Vec3d(r.corner(t, 1)) - center,
                c = Vec3d(r.corner(t, 2)) - center, normal = cross(b - a, c - a);
    area += normal;
    total += length(normal);
    volume += dot(a, normal);
  }
  // Comparisons with NaN are false.
  if (largest(abs(area)) <= 1e-9 * total) shape.outward = volume > 0 ? 1 : volume < 0 ? -1 : 0;
  return shape;
}

ClosedBodies::ClosedBodies(const Accel& accel, const ClosedBodies* former)
    : accel_(accel), owners_(accel.owners()), bodies_(accel.records.size()) {
  for (const Accel::Surface& from : accel.surfaces()) {
    const Record& r = accel.records[from.record];
    if (r.primitive != edit::Primitive::Triangles) continue;
    const Key key{r.vertices, r.indices, r.primitives};
    auto found = shapes_.find(key);
    if (found == shapes_.end()) {
      const bool known = former && former->shapes_.contains(key);
      found = shapes_.emplace(key, known ? former->shapes_.at(key) : shapeOf(r)).first;
    }
    const Shape& shape = found->second;
    if (shape.outward == 0) continue;
    Box box;
    for (int corner = 0; corner < 8; corner++)
      box.add(r.placeOf(Vec3d{corner & 1 ? shape.high.x : shape.low.x,
                              corner & 2 ? shape.high.y : shape.low.y,
                              corner & 4 ? shape.high.z : shape.low.z}));
    const Vec3f low(box.low), high(box.high);
    // Rays that start on the surface are not outside.
    const float margin = 0x1p-20f * (largest(high - low) + largest(max(abs(low), abs(high))));
    bodies_[from.record] = {shape.outward, low - Vec3f{margin, margin, margin},
                            high + Vec3f{margin, margin, margin}};
  }
}

bool ClosedBodies::denies(const Rays& rays, uint32_t i, const RayHits& hits) const {
  const Body& body = bodies_[hits.record[i]];
  if (body.outward == 0) return false;
  const Record& r = accel_.records[hits.record[i]];
  const Vec3f kernel = load(hits.ng, i),
              normal = r.instanced ? r.frames->kernelNormal * kernel : kernel;
  if (!(dot(normal, load(rays.dir, i)) * float(body.outward) > 0)) return false;
  const Vec3f o = load(rays.org, i);
  return o.x < body.low.x || o.y < body.low.y || o.z < body.low.z || o.x > body.high.x ||
         o.y > body.high.y || o.z > body.high.z;
}

} // namespace openrt
