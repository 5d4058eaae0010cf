// huge_spheres.h: which spheres are so large that single precision cannot tell where a ray meets
// them: it errs by about 1e-7 of the radius, which is more than what stands on them is high. They
// are met in double precision. [any]
#pragma once

#include <algorithm>

#include "render/records.h"

namespace openrt {

// In units of the ray kernels, which for all but extreme worlds are those of the world.
inline constexpr double hugeRadius = 1e4;

inline bool isHugeSphere(const Matrix4d& unitToKernel) {
  return std::max({length(unitToKernel.column(0)), length(unitToKernel.column(1)),
                   length(unitToKernel.column(2))}) >= hugeRadius;
}
// The same of its record: what is an instance keeps to the kernels' own precision.
inline bool metInDouble(const Record& r) {
  if (r.primitive != edit::Primitive::Sphere || r.instanced) return false;
  double largest = 0;
  for (int j = 0; j < 3; j++) {
    double square = 0;
    for (int i = 0; i < 3; i++) square += double(r.toRender.r[i][j]) * r.toRender.r[i][j];
    largest = std::max(largest, square);
  }
  // A little less: rounded to float here, it must not be told from what the kernels were given.
  return largest >= hugeRadius * hugeRadius * (1 - 1e-6) * r.scale * r.scale;
}

} // namespace openrt
