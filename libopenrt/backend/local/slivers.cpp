// slivers.cpp: an Embree user geometry for slivers, triangles that single precision cannot
// intersect (sliver_edges.h). Embree traverses the bounding boxes of their pieces
// (sliver_pieces.h). Most rays of a box are rejected in single precision (sliver_lanes.h), the
// others are intersected here in double precision (ray_triangle.h). Called by render threads.
#include <bit>

#include "backend/local/accel/embree_parts.h"
#include "backend/local/ray_triangle.h"
#include "backend/local/sliver_pieces.h"
#include "backend/local/user_geometry.h"

namespace openrt {
namespace {

// Returns the largest absolute value of the components of three vectors.
double reachOf(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  return largest(max(max(abs(a), abs(b)), abs(c)));
}

struct Corners {
  Vec3d a, b, c;
  Corners(const Part& part, uint32_t primitive)
      : a(cornerOf(part, primitive, 0)), b(cornerOf(part, primitive, 1)),
        c(cornerOf(part, primitive, 2)) {}
  Vec3d normal() const { return cross(b - a, c - a); }

 private:
  static Vec3d cornerOf(const Part& part, uint32_t primitive, uint32_t k) {
    return Vec3d(vectorOf(&part.vertices[3 * size_t(part.indices[3 * size_t(primitive) + k])]));
  }
};

// Returns whether a ray passes an open edge so closely that it counts as a hit. The neighbour
// beyond the edge is intersected in single precision, whose rounding might also miss. The tolerance
// is four units in the last place of the edge's distance from the ray's origin.
bool closesGap(const RelativeTriangle& s, unsigned open, const Vec3d& d, double near,
               TriangleHit& at) {
  const double distance = closestPointToLine(s, d, open, at),
               slack = 0x1p-21 * reachOf(s.a, s.b, s.c);
  return distance <= slack && intersectPlane(s, d) >= near;
}

// Finds where the ray of a lane hits the triangle of a primitive.
bool intersectsLane(const Part& part, uint32_t primitive, const Corners& s, const Lane& lane,
                    TriangleHit& at) {
  const RelativeTriangle seen{s.a - lane.origin, s.b - lane.origin, s.c - lane.origin};
  bool met = intersectTriangle(seen, lane.direction, at);
  if (!met && part.openEdges[primitive])
    met = closesGap(seen, part.openEdges[primitive], lane.direction, lane.near, at);
  if (met) return lane.reaches(at.t);
  // The piece to which the wrong hit belongs counts it.
  if (isHitInSinglePrecision(seen, lane.direction, lane.near, lane.far) &&
      isInPiece(s.a, s.b, s.c, part.pieces[primitive],
                lane.origin + lane.direction * intersectPlane(seen, lane.direction)))
    part.wrongHits->fetch_add(1, std::memory_order_relaxed);
  return false;
}

// Calls hit(lane, at, corners) for every ray of a packet that hits the primitive's triangle.
template <class F> void forHits(const Part& part, uint32_t primitive, RTCRayN* rays, unsigned size,
                                const int* valid, const F& hit) {
  const PacketLines lines{
      {&RTCRayN_org_x(rays, size, 0), &RTCRayN_org_y(rays, size, 0), &RTCRayN_org_z(rays, size, 0)},
      {&RTCRayN_dir_x(rays, size, 0), &RTCRayN_dir_y(rays, size, 0), &RTCRayN_dir_z(rays, size, 0)},
      valid,
      size};
  uint32_t left = mayHit(part.outlines[primitive], lines);
  if (!left) return;
  const Corners corners(part, primitive);
  for (; left; left &= left - 1) {
    const unsigned i = unsigned(std::countr_zero(left));
    TriangleHit at;
    if (intersectsLane(part, primitive, corners, Lane(rays, size, i), at)) hit(i, at, corners);
  }
}

// The bounds are padded by the tolerance of closesGap() for rays that start within the part's
// bounds.
void boundsOf(const RTCBoundsFunctionArguments* a) {
  const Part& part = *static_cast<const Part*>(a->geometryUserPtr);
  const Corners s(part, a->primID);
  const Box box = boundsOfPiece(s.a, s.b, s.c, part.pieces[a->primID]);
  const Vec3d slack = 0x1p-21 * max(max(abs(s.a), abs(s.b)), abs(s.c));
  storeBounds(Vec3f(box.low - slack), Vec3f(box.high + slack), *a->bounds_o);
}

void intersect(const RTCIntersectFunctionNArguments* a) {
  const Part& part = *static_cast<const Part*>(a->geometryUserPtr);
  forHits(part, a->primID, RTCRayHitN_RayN(a->rayhit, a->N), a->N, a->valid,
          [&](unsigned i, const TriangleHit& at, const Corners& s) {
            storeHit(a, i, at.t, at.u, at.v, s.normal());
          });
}

void occluded(const RTCOccludedFunctionNArguments* a) {
  const Part& part = *static_cast<const Part*>(a->geometryUserPtr);
  forHits(part, a->primID, a->ray, a->N, a->valid,
          [&](unsigned i, const TriangleHit& at, const Corners& s) {
            storeOcclusion(a, i, at.t, s.normal());
          });
}

} // namespace

RTCGeometry newSlivers(const EmbreeDevice& device, Part& part) {
  part.wrongHits = &device.wrongHits;
  part.outlines.clear();
  for (uint32_t i = 0; i < part.pieces.size(); i++) {
    const Corners s(part, i);
    part.outlines.emplace_back(s.a, s.b, s.c);
  }
  return newUserGeometry(device, &part, part.pieces.size(), boundsOf, intersect, occluded);
}

} // namespace openrt
