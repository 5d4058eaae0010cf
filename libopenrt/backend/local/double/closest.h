// closest.h: computes the place of a triangle or of a sphere that is closest to a point given in
// double, with a bound of the error. Nothing is rounded before: see crossings.h. Pure functions.
// [any thread]
#pragma once

#include <optional>

#include "backend/local/double/crossings.h"

namespace openrt {

struct DoubleClosest {
  double distance = 0, u = 0, v = 0;
  double distanceError = 0, uvError = 0; // none of them is farther from the truth
};

// Returns the place of a triangle that is closest to a point, or nothing if the triangle has no
// area, or if its distance is certainly more than `most`.
std::optional<DoubleClosest> closestOnTriangle(const Vec3d& point, const PlacedTriangle& triangle,
                                               double most);

// Returns how much the sphere that a matrix makes of a sphere differs from one: no axis is longer
// or shorter than `scale` by more than this share of it.
struct SphereShape {
  double scale, uneven;
};
SphereShape shapeOf(const Matrix4d& world);

// Finds the place of a placed sphere that is closest to a point.
struct ClosestOnSphere {
  double distance, distanceError;
  DoublePlace place;
};
ClosestOnSphere closestOnSphere(const Vec3d& point, const Matrix4d& world, double radius);

} // namespace openrt
