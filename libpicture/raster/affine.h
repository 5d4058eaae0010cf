// affine.h: affine maps in double precision, as matrices of nodes and cameras are. [any thread]
#pragma once

#include <cmath>
#include <optional>

#include "libpicture/vec.h"

namespace picture::raster {

// Maps p to p.x x + p.y y + p.z z + origin.
struct Affine {
  Vec x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1}, origin;

  Vec vector(const Vec& v) const { return x * v.x + y * v.y + z * v.z; }
  Vec point(const Vec& p) const { return vector(p) + origin; }
  // Returns nothing for a map that flattens space or has numbers that are not finite.
  std::optional<Affine> inverse() const;
};

// matrix: 16 numbers, column by column.
inline Affine affineOf(const double* m) {
  return {{m[0], m[1], m[2]}, {m[4], m[5], m[6]}, {m[8], m[9], m[10]}, {m[12], m[13], m[14]}};
}

inline std::optional<Affine> Affine::inverse() const {
  const Vec rows[3] = {cross(y, z), cross(z, x), cross(x, y)};
  const double determinant = dot(x, rows[0]), scale = 1 / determinant;
  if (determinant == 0 || !std::isfinite(scale) || !std::isfinite(dot(origin, origin))) return {};
  Affine back;
  back.x = Vec{rows[0].x, rows[1].x, rows[2].x} * scale;
  back.y = Vec{rows[0].y, rows[1].y, rows[2].y} * scale;
  back.z = Vec{rows[0].z, rows[1].z, rows[2].z} * scale;
  back.origin = back.vector(origin) * -1.0;
  return back;
}

// Returns a vector of length 1, or of length 0 if that cannot be done.
inline Vec unit(const Vec& v) {
  const double size = length(v);
  return size > 0 && std::isfinite(size) ? v / size : Vec{};
}

} // namespace picture::raster
