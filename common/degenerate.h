// degenerate.h: which triangles the API drops: for libopenrt, and for bindings that number
// triangles as their users do. Pure.
#pragma once

#include <cmath>

namespace openrt {

// No area: two corners in one place, or the cross product of the edges is not above its own
// rounding error in double.
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
