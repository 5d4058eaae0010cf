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

#include "scene/analytic.h"
#include "scene/matrix.h"

namespace openrt {

// A ray in the world. All numbers are finite, except that far may be infinite.
struct PreciseRay {
  Vec3d origin, direction;
  double near, far; // in lengths of the direction

  Vec3d at(double t) const { return origin + direction * t; }
};

struct PreciseCrossing {
  double t = 0, u = 0, v = 0;
  double tError = 0, uvError = 0; // none of t, u and v is farther from the truth
};

// Vertices as they are stored, and the matrix that places them in the world.
struct PlacedTriangle {
  Vec3f a, b, c;
  const Matrix4d& world;
};

// Returns whether the ray crosses the triangle within its interval, and where.
bool crosses(const PreciseRay& ray, const PlacedTriangle& triangle, PreciseCrossing& at);

// The places of a hit and bounds of the errors of their components: `onRay` from t, `onTriangle`
// from u and v. Where vertices are nearer to 0 than the ray's origin, the latter is better.
struct PrecisePlace {
  Vec3d point;
  double error;
};
PrecisePlace placeOnRay(const PreciseRay& ray, const PreciseCrossing& at);
PrecisePlace placeOnTriangle(const PlacedTriangle& triangle, const PreciseCrossing& at);

// Finds where the ray crosses the sphere of a radius about the origin of a frame, ascending.
// Returns how many crossings are in the interval. A ray that only touches the sphere passes it.
int crossSphere(const PreciseRay& ray, const Matrix4d& world, double radius,
                PreciseCrossing (&at)[2]);

// Returns a bound of the error of a crossing with an analytic surface: the surface's equation has
// different signs at both ends of t +- bound. Infinite if none is found below a thousandth
// of the distance.
double analyticError(const PreciseRay& ray, const Matrix4d& world, const AnalyticSurface& surface,
                     double t);

} // namespace openrt
