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
  const Vec3d x(r.frames->toRender.column(0)), y(r.frames->toRender.column(1)),
      z(r.frames->toRender.column(2));
  // The threshold is a little lower here, because the record is rounded to float and the result
  // must agree with what the kernels were given.
  return std::max({dot(x, x), dot(y, y), dot(z, z)}) >=
         hugeRadius * hugeRadius * (1 - 1e-6) * r.scale * r.scale;
}

} // namespace openrt
