// crossings.h: decides exactly whether a ray given in double crosses a triangle or a sphere, and
// computes where, with a bound of the error.
//
// A triangle has vertices in floats, which a matrix of doubles places in the world. Neither the
// vertices nor the ray are rounded after that: signs are computed with Bounded numbers, and with
// Dyadic numbers if those leave them open. Rays exactly through edges and vertices are decided as
// in crossing.h, by a ray that is moved by (e, e^2, e^3). Intervals are half-open: t = near does
// not count, t = far does.
//
// Pure functions. [any thread]
#pragma once

#include "backend/local/crossing.h"
#include "scene/analytic.h"
#include "scene/matrix.h"

namespace openrt {

// A ray in the world. All numbers are finite, except that far may be infinite.
struct DoubleRay {
  Vec3d origin, direction;
  double near, far; // in lengths of the direction

  Vec3d at(double t) const { return origin + direction * t; }
};

// Vertices as they are stored, and the matrix that places them in the world.
struct PlacedTriangle {
  Vec3f a, b, c;
  const Matrix4d& world;
};

// Returns whether the ray crosses the triangle within its interval, and where.
bool crosses(const DoubleRay& ray, const PlacedTriangle& triangle, CrossingPoint& at);

// The places of a hit and bounds of the errors of their components: `onRay` from t, `onTriangle`
// from u and v. Where vertices are nearer to 0 than the ray's origin, the latter is better.
struct DoublePlace {
  Vec3d point;
  double error;
};
DoublePlace placeOnRay(const DoubleRay& ray, const CrossingPoint& at);
DoublePlace placeOnTriangle(const PlacedTriangle& triangle, const CrossingPoint& at);

// Finds where the ray crosses the sphere of a radius about the origin of a frame, ascending.
// Returns how many crossings are in the interval. A ray that only touches the sphere passes it.
int crossSphere(const DoubleRay& ray, const Matrix4d& world, double radius, CrossingPoint (&at)[2]);

// Returns a bound of the error of a crossing with an analytic surface: the surface's equation has
// different signs at both ends of t +- bound. Infinite if none is found below a thousandth
// of the distance.
double analyticError(const DoubleRay& ray, const Matrix4d& world, const AnalyticSurface& surface,
                     double t);

} // namespace openrt
