// huge_spheres.cpp: an Embree user geometry for spheres and ellipsoids that are too large for
// single precision (render/huge_spheres.h), for example the ground as a sphere with the eye at a
// millionth of the radius above it. They are intersected in double precision in their own frame.
// Called by render threads.
#include <algorithm>
#include <cmath>

#include "backend/local/accel/embree_parts.h"
#include "backend/local/ray_triangle.h"
#include "backend/local/user_geometry.h"

namespace openrt {
namespace {

struct HugeSphere {
  Matrix4d toUnit;
  explicit HugeSphere(const Matrix4d& unit) : toUnit(inverse(unit)) {}
  bool intersectRay(const Lane& lane, double t[2]) const {
    return intersectUnitSphere(toUnit.point(lane.origin), toUnit.direction(lane.direction), t);
  }
  // Returns the outward normal: the transpose of the inverse matrix transforms normals.
  Vec3d normalAt(const Lane& lane, double t) const {
    return toUnit.transposed(toUnit.point(lane.origin + lane.direction * t));
  }
};

const Matrix4d& unitOf(const void* part, uint32_t primitive) {
  return static_cast<const Part*>(part)->spheres[primitive];
}

void boundsOf(const RTCBoundsFunctionArguments* a) {
  const Matrix4d& m = unitOf(a->geometryUserPtr, a->primID);
  const Vec3d center = m.translation(), slack = 1e-6 * abs(center),
              half = Vec3d{length(m.row(0)), length(m.row(1)), length(m.row(2))} * (1 + 1e-6);
  storeBounds(Vec3f(center - half - slack), Vec3f(center + half + slack), *a->bounds_o);
}

void intersect(const RTCIntersectFunctionNArguments* a) {
  const HugeSphere sphere(unitOf(a->geometryUserPtr, a->primID));
  RTCRayN* rays = RTCRayHitN_RayN(a->rayhit, a->N);
  for (unsigned i = 0; i < a->N; i++) {
    double t[2];
    if (a->valid[i] != -1) continue;
    const Lane lane(rays, a->N, i);
    if (!sphere.intersectRay(lane, t)) continue;
    for (const double at : t)
      if (lane.reaches(at) && storeHit(a, i, at, 0, 0, sphere.normalAt(lane, at))) break;
  }
}

void occluded(const RTCOccludedFunctionNArguments* a) {
  const HugeSphere sphere(unitOf(a->geometryUserPtr, a->primID));
  for (unsigned i = 0; i < a->N; i++) {
    double t[2];
    if (a->valid[i] != -1) continue;
    const Lane lane(a->ray, a->N, i);
    if (!sphere.intersectRay(lane, t)) continue;
    for (const double at : t)
      if (lane.reaches(at) && storeOcclusion(a, i, at, sphere.normalAt(lane, at))) break;
  }
}

} // namespace

RTCGeometry newHugeSpheres(const EmbreeDevice& device, Part& part) {
  return newUserGeometry(device, &part, part.spheres.size(), boundsOf, intersect, occluded);
}

} // namespace openrt
