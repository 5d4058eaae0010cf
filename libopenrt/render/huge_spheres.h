// huge_spheres.h: tells which spheres are too large for ray intersection in single precision. The
// error of single precision is about 1e-7 of the radius, which may exceed the height of objects
// that stand on the sphere. Huge spheres are intersected in double precision. [any]
#pragma once

#include <algorithm>

#include "render/records.h"

namespace openrt {

// Spheres of at least this radius are huge. It is in units of the ray kernels, which are those of
// the world except for worlds of extreme size.
inline constexpr double hugeRadius = 1e4;

inline bool isHugeSphere(const Matrix4d& unitToKernel) {
  return std::max({length(unitToKernel.column(0)), length(unitToKernel.column(1)),
                   length(unitToKernel.column(2))}) >= hugeRadius;
}
// Returns whether the record is a huge sphere. Spheres in instances are intersected by the kernels,
// in single precision.
inline bool intersectedInDouble(const Record& r) {
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
