// crossing.h: decides exactly whether a ray crosses a triangle, so that every crossing of a closed
// surface counts once.
//
// Where the ray passes exactly through an edge or a vertex, the decision is that for a ray whose
// origin is moved by (e, e^2, e^3), with e > 0 and smaller than any number (simulation of
// simplicity: H. Edelsbrunner, E. P. Muecke, ACM Transactions on Graphics 9(1), 1990). The moved
// ray meets neither edges nor vertices, and no face that contains its direction. The rule uses
// nothing but positions, so vertices that are equal count as one. The interval of the ray is
// half-open: t = near does not count, t = far does.
//
// Pure functions. [any thread]
#pragma once

#include "scene/matrix.h"

namespace openrt {

// A ray in render space. Its direction and interval have been prepared by exactRay().
struct ExactRay {
  Vec3d origin, direction;
  double near, far; // in lengths of the direction
  double unit;      // t of the caller is t of this ray times `unit`, a power of two
  // The relative error of barycentric weights from which on they are computed exactly.
  double tolerance;
};

// Makes a ray for crosses(). Numbers too small to matter become 0, so that no product underflows.
// All numbers must be finite (far may be infinite), and the direction not 0.
ExactRay exactRay(const Vec3d& origin, const Vec3d& direction, double near, double far,
                  double tolerance);

// Where a ray crosses a surface. t counts lengths of ExactRay::direction.
struct CrossingPoint {
  double t = 0, u = 0, v = 0;
  double tError = 0, uvError = 0; // upper bounds of the rounding errors
};

// Returns whether the ray crosses the triangle within its interval, and where. The decision is
// exact; t, u and v are rounded.
bool crosses(const ExactRay& ray, const Vec3d& a, const Vec3d& b, const Vec3d& c,
             CrossingPoint& at);

} // namespace openrt
