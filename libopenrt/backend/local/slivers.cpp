// slivers.cpp: triangles that single precision cannot meet: far longer than high, or beside such.
// Embree finds their boxes, each is met here in double precision (exact.h), as a geometry of our
// own. Called by render threads.
#include <algorithm>
#include <cmath>
#include <limits>

#include "backend/local/accel/embree_parts.h"
#include "backend/local/exact.h"
#include "backend/local/own_geometry.h"

namespace openrt {
namespace {

double largest(const Vec3d& v) {
  return std::max({std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)});
}

Vec3d cornerOf(const Part& part, uint32_t triangle, int k) {
  const float* v =
      part.vertices.data() + 3 * size_t(part.indices[3 * size_t(triangle) + size_t(k)]);
  return {v[0], v[1], v[2]};
}

// A ray that passes an open edge, beyond which the neighbour is met in single precision, at a
// distance within what that rounds: neither of them might be found. Four units in the last place of
// the edge's distance from the ray's origin.
bool closesGap(const SeenTriangle& s, unsigned open, const Vec3d& d, double near, Meeting& at) {
  const double distance = nextTo(s, d, open, at),
               slack = 0x1p-21 * std::max({largest(s.a), largest(s.b), largest(s.c)});
  return distance <= slack && meetsPlane(s, d) >= near;
}

// A triangle, with what the question that most rays are answered by asks of it.
struct Sliver {
  Vec3d a, b, c;
  Vec3d edge[3], moment[3]; // c - a, a - b, b - c; and their products with the sums of their ends
  double extent, doubt; // largest coordinate; what the roundings of floats put in doubt, but for
                        // the ray's part
  Sliver(const Part& part, uint32_t triangle)
      : a(cornerOf(part, triangle, 0)), b(cornerOf(part, triangle, 1)),
        c(cornerOf(part, triangle, 2)), edge{c - a, a - b, b - c}, moment{cross(edge[0], c + a),
                                                                          cross(edge[1], a + b),
                                                                          cross(edge[2], b + c)},
        extent(std::max({largest(a), largest(b), largest(c)})),
        doubt(0x1p-18 * std::max({largest(edge[0]), largest(edge[1]), largest(edge[2])})) {}

  // Whether the ray's line passes so far away that no rounding of floats could put it there, nor a
  // gap be closed.
  bool isPassed(const Lane& ray) const {
    const Vec3d m = cross(ray.direction, ray.origin) * 2;
    const double slack = doubt * (extent + largest(ray.origin)) * largest(ray.direction);
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

bool meetsLane(const Part& part, uint32_t triangle, const Sliver& s, const Lane& lane,
               Meeting& at) {
  if (s.isPassed(lane)) return false;
  const SeenTriangle seen{s.a - lane.origin, s.b - lane.origin, s.c - lane.origin};
  bool met = meets(seen, lane.direction, at);
  if (!met && part.openEdges[triangle])
    met = closesGap(seen, part.openEdges[triangle], lane.direction, lane.near, at);
  if (met) return lane.reaches(at.t);
  if (foundInSingle(seen, lane.direction, lane.near, lane.far))
    part.wrongHits->fetch_add(1, std::memory_order_relaxed);
  return false;
}

void boundsOf(const RTCBoundsFunctionArguments* a) {
  const Part& part = *static_cast<const Part*>(a->geometryUserPtr);
  const Vec3d p = cornerOf(part, a->primID, 0), q = cornerOf(part, a->primID, 1),
              r = cornerOf(part, a->primID, 2);
  // As much wider as a gap that is closed (above) may be beside it.
  const auto wide = [](double x, double y, double z, float& low, float& high) {
    const double slack = 0x1p-21 * std::max({std::fabs(x), std::fabs(y), std::fabs(z)});
    low = float(std::min({x, y, z}) - slack);
    high = float(std::max({x, y, z}) + slack);
  };
  wide(p.x, q.x, r.x, a->bounds_o->lower_x, a->bounds_o->upper_x);
  wide(p.y, q.y, r.y, a->bounds_o->lower_y, a->bounds_o->upper_y);
  wide(p.z, q.z, r.z, a->bounds_o->lower_z, a->bounds_o->upper_z);
}

void intersect(const RTCIntersectFunctionNArguments* a) {
  const Part& part = *static_cast<const Part*>(a->geometryUserPtr);
  const Sliver sliver(part, a->primID);
  RTCRayN* rays = RTCRayHitN_RayN(a->rayhit, a->N);
  for (unsigned i = 0; i < a->N; i++) {
    Meeting at;
    if (a->valid[i] == -1 && meetsLane(part, a->primID, sliver, Lane(rays, a->N, i), at))
      takeHit(a, i, at.t, at.u, at.v, cross(sliver.b - sliver.a, sliver.c - sliver.a));
  }
}

void occluded(const RTCOccludedFunctionNArguments* a) {
  const Part& part = *static_cast<const Part*>(a->geometryUserPtr);
  const Sliver sliver(part, a->primID);
  for (unsigned i = 0; i < a->N; i++) {
    Meeting at;
    if (a->valid[i] == -1 && meetsLane(part, a->primID, sliver, Lane(a->ray, a->N, i), at))
      RTCRayN_tfar(a->ray, a->N, i) = -std::numeric_limits<float>::infinity();
  }
}

} // namespace

RTCGeometry newSlivers(const EmbreeDevice& device, Part& part) {
  part.wrongHits = &device.wrongHits;
  RTCGeometry geometry = rtcNewGeometry(device.device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(geometry, unsigned(part.indices.size() / 3));
  rtcSetGeometryUserData(geometry, &part);
  rtcSetGeometryBoundsFunction(geometry, boundsOf, nullptr);
  rtcSetGeometryIntersectFunction(geometry, intersect);
  rtcSetGeometryOccludedFunction(geometry, occluded);
  return geometry;
}

} // namespace openrt
