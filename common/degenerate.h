// degenerate.h: Defines which triangles the API drops. libopenrt uses it, and so do bindings whose
// users number the triangles. Pure function.
#pragma once

#include <cmath>

namespace openrt {

// Returns whether a triangle has no area: two corners coincide, or the cross product of the edges
// does not exceed its own rounding error in double.
inline bool degenerateTriangle(const float* a, const float* b, const float* c) {
  const double ux = double(b[0]) - a[0], uy = double(b[1]) - a[1], uz = double(b[2]) - a[2];
  const double vx = double(c[0]) - a[0], vy = double(c[1]) - a[1], vz = double(c[2]) - a[2];
  constexpr double bound = 4 * 0x1p-53;
  const auto vanishes = [](double p, double q) {
    return std::fabs(p - q) <= bound * (std::fabs(p) + std::fabs(q));
  };
  return vanishes(uy * vz, uz * vy) && vanishes(uz * vx, ux * vz) && vanishes(ux * vy, uy * vx);
}

} // namespace openrt
