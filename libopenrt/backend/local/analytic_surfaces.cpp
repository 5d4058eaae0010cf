// analytic_surfaces.cpp: an Embree user geometry for quadrics and aspheres (scene/analytic.h). Rays
// are intersected in double precision in the frame of the surface. Called by render threads.
#include <algorithm>
#include <cmath>

#include "backend/local/accel/embree_parts.h"
#include "backend/local/user_geometry.h"

namespace openrt {
namespace {

const PlacedSurface& surfaceOf(const void* part, uint32_t primitive) {
  return static_cast<const Part*>(part)->surfaces[primitive];
}

void boundsOf(const RTCBoundsFunctionArguments* a) {
  const PlacedSurface& placed = surfaceOf(a->geometryUserPtr, a->primID);
  const Vec3d low = placed.surface->low(), high = placed.surface->high();
  const Vec3d center = placed.toKernel.point((low + high) * 0.5), half = (high - low) * 0.5;
  Vec3d reach;
  for (int k = 0; k < 3; k++) reach[size_t(k)] = dot(abs(placed.toKernel.row(k)), half);
  // The widened limits of the surface (scene/analytic.h) and rounding to float are inside this.
  const double slack = 1e-6 * (largest(reach) + largest(abs(center)));
  reach += Vec3d{slack, slack, slack};
  storeBounds(Vec3f(center - reach), Vec3f(center + reach), *a->bounds_o);
}

// Calls store(t, normal) for the crossings of a ray within its interval, nearest first, until one
// is stored. Crossings that are one float apart or less get different floats, so that a ray that
// goes on behind one of them meets the next.
template <class Store>
void forCrossings(const PlacedSurface& placed, const Lane& lane, const Store& store) {
  const Vec3d origin = placed.fromKernel.point(lane.origin),
              direction = placed.fromKernel.direction(lane.direction);
  const AnalyticSurface::Crossings found = placed.surface->intersect(origin, direction);
  float before = -HUGE_VALF;
  for (int i = 0; i < found.count; i++) {
    const double exact = found.t[size_t(i)];
    const float t = std::max(float(exact), std::nextafter(before, HUGE_VALF));
    before = t;
    if (!lane.reaches(double(t))) continue;
    Vec3d normal;
    placed.surface->valueAt(origin + direction * exact, normal);
    if (store(double(t), normalize(placed.fromKernel.transposed(normalize(normal))))) return;
  }
}

void intersect(const RTCIntersectFunctionNArguments* a) {
  const PlacedSurface& placed = surfaceOf(a->geometryUserPtr, a->primID);
  RTCRayN* rays = RTCRayHitN_RayN(a->rayhit, a->N);
  for (unsigned i = 0; i < a->N; i++) {
    if (a->valid[i] != -1) continue;
    forCrossings(placed, Lane(rays, a->N, i),
                 [&](double t, const Vec3d& normal) { return storeHit(a, i, t, 0, 0, normal); });
  }
}

void occluded(const RTCOccludedFunctionNArguments* a) {
  const PlacedSurface& placed = surfaceOf(a->geometryUserPtr, a->primID);
  for (unsigned i = 0; i < a->N; i++) {
    if (a->valid[i] != -1) continue;
    forCrossings(placed, Lane(a->ray, a->N, i),
                 [&](double t, const Vec3d& normal) { return storeOcclusion(a, i, t, normal); });
  }
}

} // namespace

RTCGeometry newAnalytic(const EmbreeDevice& device, Part& part) {
  return newUserGeometry(device, &part, part.surfaces.size(), boundsOf, intersect, occluded);
}

} // namespace openrt
