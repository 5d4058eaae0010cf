// ray_triangle.h: intersects a ray and a triangle in double precision, where single precision
// fails: triangles far longer than high, rays at grazing angles, and coordinates far larger than
// the part of the scene in view. Pure functions. [any thread]
#pragma once

#include <cstdint>
#include <optional>

#include "render/records.h"
#include "scene/matrix.h"

namespace openrt {

// The intersection of a ray and a triangle: origin + t direction = (1 - u - v) a + u b + v c.
struct TriangleHit {
  double t = 0, u = 0, v = 0;
};

// The corners of a triangle relative to the ray's origin. Edge 0 joins a and c, edge 1 joins b and
// a, edge 2 joins c and b.
struct RelativeTriangle {
  Vec3d a, b, c;
};

// Returns whether the line along `direction` intersects the triangle, edges included. Two triangles
// that share an edge decide by the same number, so no ray passes between them.
bool intersectTriangle(const RelativeTriangle& triangle, const Vec3d& direction, TriangleHit& at);

// Finds the point on the triangle's edges that is closest to the line along `direction`, which
// misses the triangle, and returns its distance from the line. edges: one bit for each edge to
// consider, not 0.
double closestPointToLine(const RelativeTriangle& triangle, const Vec3d& direction, unsigned edges,
                          TriangleHit& at);

// Intersects the line o + t d with the unit sphere. Returns false if it misses, else both t, the
// smaller one first. The nearer one is computed from the product of both, which follows from the
// origin's distance from the surface, so that it keeps its digits.
bool intersectUnitSphere(const Vec3d& o, const Vec3d& d, double t[2]);

// Returns t where the line intersects the plane of the triangle; not finite if they are parallel.
double intersectPlane(const RelativeTriangle& triangle, const Vec3d& direction);

// Returns whether the single-precision test of the ray kernels hits the triangle within an interval
// of the ray: Pluecker coordinates as in Embree's robust mode. The result is only used to count the
// errors of that test.
bool isHitInSinglePrecision(const RelativeTriangle& triangle, const Vec3d& direction, float near,
                            float far);

// Returns whether the ray is at such a grazing angle that single precision misplaces t, u and v by
// more than about 1e-5 of the triangle's distance. normal: the triangle's normal, of any length, in
// the frame of the direction. It computes in floats, because it is called for every hit.
inline bool grazes(const Vec3f& normal, const Vec3f& direction) {
  const float along = dot(normal, direction);
  // Also true if the products leave the range of floats.
  return !(along * along > 0x1p-12f * dot(normal, normal) * dot(direction, direction));
}

// A ray in render space with its interval of t.
struct RaySegment {
  Vec3d origin, direction;
  float near, far;
};

// Recomputes the hit of a ray with triangle `primitive` of a record in double precision. If the ray
// misses the triangle, the hit moves to the closest point of its edges. t is rounded to float and
// stays within the interval. Returns nothing if the result is not finite.
std::optional<TriangleHit> refineHit(const Record& record, uint32_t primitive,
                                     const RaySegment& ray);

} // namespace openrt
