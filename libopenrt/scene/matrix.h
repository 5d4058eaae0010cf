// matrix.h: 4x4 matrices in double, column-major as in the API; affine use. Header-only, any
// thread.
#pragma once

#include <array>
#include <cmath>

#include "scene/vec3.h"

namespace openrt {

struct Matrix4d {
  std::array<double, 16> m{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

  bool operator==(const Matrix4d&) const = default;
  Vec3d column(int i) const { return {m[4 * i], m[4 * i + 1], m[4 * i + 2]}; }
  Vec3d row(int i) const { return {m[i], m[4 + i], m[8 + i]}; } // a row of the linear part
  Vec3d translation() const { return column(3); }
  // Return the images of a direction and of a point.
  Vec3d direction(const Vec3d& v) const {
    return column(0) * v.x + column(1) * v.y + column(2) * v.z;
  }
  Vec3d point(const Vec3d& p) const { return direction(p) + translation(); }
  // Multiplies the transpose of the linear part by v. A map transforms normals by the transpose of
  // its inverse: inverse(m).transposed(normal).
  Vec3d transposed(const Vec3d& v) const {
    return {dot(column(0), v), dot(column(1), v), dot(column(2), v)};
  }
  double determinant() const { return dot(column(0), cross(column(1), column(2))); }
  void translate(const Vec3d& t) {
    m[12] += t.x;
    m[13] += t.y;
    m[14] += t.z;
  }

  bool finite() const {
    for (double v : m)
      if (!std::isfinite(v)) return false;
    return true;
  }
  // Returns true if the ray kernels can use the matrix: finite, not singular, columns of length
  // 1e-15 to 1e15.
  bool usable() const {
    if (!finite()) return false;
    double product = 1;
    for (int i = 0; i < 3; i++) {
      const double l = length(column(i));
      if (!(l >= 1e-15 && l <= 1e15)) return false;
      product *= l;
    }
    return std::fabs(determinant()) > 1e-30 * product && length(translation()) <= 1e17;
  }
};

inline Matrix4d operator*(const Matrix4d& a, const Matrix4d& b) {
  Matrix4d r;
  for (int c = 0; c < 4; c++)
    for (int row = 0; row < 4; row++) {
      double sum = 0;
      for (int k = 0; k < 4; k++) sum += a.m[4 * k + row] * b.m[4 * c + k];
      r.m[4 * c + row] = sum;
    }
  return r;
}

// Returns the inverse of an affine matrix that is not singular.
inline Matrix4d inverse(const Matrix4d& a) {
  const Vec3d c0 = a.column(0), c1 = a.column(1), c2 = a.column(2);
  const double d = 1 / a.determinant();
  // Rows of the inverse.
  const Vec3d r0 = cross(c1, c2) * d, r1 = cross(c2, c0) * d, r2 = cross(c0, c1) * d;
  const Vec3d t = a.translation();
  Matrix4d r;
  r.m = {r0.x, r1.x, r2.x, 0, r0.y,        r1.y,        r2.y,        0,
         r0.z, r1.z, r2.z, 0, -dot(r0, t), -dot(r1, t), -dot(r2, t), 1};
  return r;
}

} // namespace openrt
