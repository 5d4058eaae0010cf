// huge_spheres.h: tells which spheres are too large for ray intersection in single precision. Its
// error is about 1e-7 of the radius, which may exceed the height of what stands on the sphere.
// These spheres are intersected in double precision. [any]
#pragma once

#include <algorithm>

#include "render/records.h"

namespace openrt {

// In units of the ray kernels, which are the world's except for extreme worlds.
inline constexpr double hugeRadius = 1e4;

inline bool isHugeSphere(const Matrix4d& unitToKernel) {
  return std::max({length(unitToKernel.column(0)), length(unitToKernel.column(1)),
                   length(unitToKernel.column(2))}) >= hugeRadius;
}
// The same for a sphere's record. Instances keep the kernels' precision.
inline bool metInDouble(const Record& r) {
  if (r.primitive != edit::Primitive::Sphere || r.instanced) return false;
  double largest = 0;
  for (int j = 0; j < 3; j++) {
    double square = 0;
    for (int i = 0; i < 3; i++) square += double(r.toRender.r[i][j]) * r.toRender.r[i][j];
    largest = std::max(largest, square);
  }
  // The threshold is a little lower here, because the record is rounded to float and the result
  // must agree with what the kernels were given.
  return largest >= hugeRadius * hugeRadius * (1 - 1e-6) * r.scale * r.scale;
}

} // namespace openrt
