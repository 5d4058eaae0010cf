// slivers.cpp: an Embree user geometry for slivers, triangles that single precision cannot
// intersect (sliver_edges.h). Embree traverses their bounding boxes; the triangles are intersected
// here in double precision (exact.h). Called by render threads.
#include <limits>

#include "backend/local/accel/embree_parts.h"
#include "backend/local/exact.h"
#include "backend/local/user_geometry.h"

namespace openrt {
namespace {

// Returns the largest absolute value of the components of three vectors.
double reachOf(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  return largest(max(max(abs(a), abs(b)), abs(c)));
}

Vec3d cornerOf(const Part& part, uint32_t triangle, int k) {
  const uint32_t index = part.indices[3 * size_t(triangle) + size_t(k)];
  return Vec3d(vectorOf(part.vertices.data() + 3 * size_t(index)));
}

// Returns whether a ray passes an open edge so closely that it counts as a hit. The neighbour
// beyond the edge is intersected in single precision, whose rounding might also miss. The tolerance
// is four units in the last place of the edge's distance from the ray's origin.
bool closesGap(const RelativeTriangle& s, unsigned open, const Vec3d& d, double near,
               TriangleHit& at) {
  const double distance = closestPointToLine(s, d, open, at),
               slack = 0x1p-21 * reachOf(s.a, s.b, s.c);
  return distance <= slack && intersectPlane(s, d) >= near;
}

// A triangle with precomputed values for isClearlyMissed(), which rejects most rays.
struct Sliver {
  Vec3d a, b, c;
  // The edges c - a, a - b, b - c, and their cross products with the sums of their end points.
  Vec3d edge[3], moment[3];
  // The largest coordinate, and the factor of the float rounding error that does not depend on the
  // ray.
  double extent, doubt;
  Sliver(const Part& part, uint32_t triangle)
      : a(cornerOf(part, triangle, 0)), b(cornerOf(part, triangle, 1)),
        c(cornerOf(part, triangle, 2)), edge{c - a, a - b, b - c}, moment{cross(edge[0], c + a),
                                                                          cross(edge[1], a + b),
                                                                          cross(edge[2], b + c)},
        extent(reachOf(a, b, c)), doubt(0x1p-18 * reachOf(edge[0], edge[1], edge[2])) {}

  // Returns whether the ray's line passes the triangle at such a distance that neither float
  // rounding nor closesGap() could make it a hit.
  bool isClearlyMissed(const Lane& ray) const {
    const Vec3d m = cross(ray.direction, ray.origin) * 2;
    const double slack = doubt * (extent + largest(abs(ray.origin))) * largest(abs(ray.direction));
    const auto side = [&](int k) { return dot(moment[k], ray.direction) + dot(edge[k], m); };
    const auto apart = [slack](double p, double q) {
      return (p > slack && q < -slack) || (p < -slack && q > slack);
    };
    const double p = side(0), q = side(1);
    if (apart(p, q)) return true;
    const double r = side(2);
    return apart(p, r) || apart(q, r);
  }
};

bool intersectsLane(const Part& part, uint32_t triangle, const Sliver& s, const Lane& lane,
                    TriangleHit& at) {
  if (s.isClearlyMissed(lane)) return false;
  const RelativeTriangle seen{s.a - lane.origin, s.b - lane.origin, s.c - lane.origin};
  bool met = intersectTriangle(seen, lane.direction, at);
  if (!met && part.openEdges[triangle])
    met = closesGap(seen, part.openEdges[triangle], lane.direction, lane.near, at);
  if (met) return lane.reaches(at.t);
  if (isHitInSinglePrecision(seen, lane.direction, lane.near, lane.far))
    part.wrongHits->fetch_add(1, std::memory_order_relaxed);
  return false;
}

void boundsOf(const RTCBoundsFunctionArguments* a) {
  const Part& part = *static_cast<const Part*>(a->geometryUserPtr);
  const Vec3d p = cornerOf(part, a->primID, 0), q = cornerOf(part, a->primID, 1),
              r = cornerOf(part, a->primID, 2);
  // The bounds are padded by the tolerance of closesGap().
  const Vec3d slack = 0x1p-21 * max(max(abs(p), abs(q)), abs(r));
  storeBounds(Vec3f(min(min(p, q), r) - slack), Vec3f(max(max(p, q), r) + slack), *a->bounds_o);
}

void intersect(const RTCIntersectFunctionNArguments* a) {
  const Part& part = *static_cast<const Part*>(a->geometryUserPtr);
  const Sliver sliver(part, a->primID);
  RTCRayN* rays = RTCRayHitN_RayN(a->rayhit, a->N);
  for (unsigned i = 0; i < a->N; i++) {
    TriangleHit at;
    if (a->valid[i] == -1 && intersectsLane(part, a->primID, sliver, Lane(rays, a->N, i), at))
      storeHit(a, i, at.t, at.u, at.v, cross(sliver.b - sliver.a, sliver.c - sliver.a));
  }
}

void occluded(const RTCOccludedFunctionNArguments* a) {
  const Part& part = *static_cast<const Part*>(a->geometryUserPtr);
  const Sliver sliver(part, a->primID);
  for (unsigned i = 0; i < a->N; i++) {
    TriangleHit at;
    if (a->valid[i] == -1 && intersectsLane(part, a->primID, sliver, Lane(a->ray, a->N, i), at))
      storeOcclusion(a, i, at.t, cross(sliver.b - sliver.a, sliver.c - sliver.a));
  }
}

} // namespace

RTCGeometry newSlivers(const EmbreeDevice& device, Part& part) {
  part.wrongHits = &device.wrongHits;
  return newUserGeometry(device, &part, part.indices.size() / 3, boundsOf, intersect, occluded);
}

} // namespace openrt
