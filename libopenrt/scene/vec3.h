// vec3.h: vectors of three components and 3x3 matrices, in float or double. Header-only, any
// thread.
//
// Arrays hold vectors as structure of arrays or as three numbers in a row: `load`, `vectorOf` and
// `store` are the only conversions. Pictures are compared by their bytes, so every formula has a
// fixed order: sums run from x to z. The vector lanes of render/lanes have the same names.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace openrt {

template <class T> struct Vec3 {
  T x = 0, y = 0, z = 0;

  // Return component 0, 1 or 2.
  T& operator[](size_t k) { return k == 0 ? x : k == 1 ? y : z; }
  const T& operator[](size_t k) const { return k == 0 ? x : k == 1 ? y : z; }
  // Converts every component.
  template <class U> explicit operator Vec3<U>() const { return {U(x), U(y), U(z)}; }
  bool operator==(const Vec3&) const = default;

  friend Vec3 operator+(const Vec3& a, const Vec3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend Vec3 operator-(const Vec3& a, const Vec3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend Vec3 operator-(const Vec3& a) { return {-a.x, -a.y, -a.z}; }
  // Multiplies component by component.
  friend Vec3 operator*(const Vec3& a, const Vec3& b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
  friend Vec3 operator*(const Vec3& a, T s) { return {a.x * s, a.y * s, a.z * s}; }
  friend Vec3 operator*(T s, const Vec3& a) { return {s * a.x, s * a.y, s * a.z}; }
  // Divides every component, which is rounded once: not the same as a product with 1 / s.
  friend Vec3 operator/(const Vec3& a, T s) { return {a.x / s, a.y / s, a.z / s}; }
  Vec3& operator+=(const Vec3& b) { return *this = *this + b; }
  Vec3& operator-=(const Vec3& b) { return *this = *this - b; }
  Vec3& operator*=(const Vec3& b) { return *this = *this * b; }
  Vec3& operator*=(T s) { return *this = *this * s; }

  friend T dot(const Vec3& a, const Vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
  friend Vec3 cross(const Vec3& a, const Vec3& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
  }
  friend T length(const Vec3& a) { return std::sqrt(dot(a, a)); }
  // Returns a / |a|, or 0 0 0 if the length is 0 or not a number.
  friend Vec3 normalize(const Vec3& a) {
    const T l = length(a);
    return l > 0 ? a / l : Vec3();
  }

  friend Vec3 abs(const Vec3& a) { return {std::fabs(a.x), std::fabs(a.y), std::fabs(a.z)}; }
  friend T largest(const Vec3& a) { return std::max({a.x, a.y, a.z}); }
  friend T smallest(const Vec3& a) { return std::min({a.x, a.y, a.z}); }
  // Return the smaller and the larger numbers, component by component; that of `a` beside a NaN.
  friend Vec3 min(const Vec3& a, const Vec3& b) {
    return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
  }
  friend Vec3 max(const Vec3& a, const Vec3& b) {
    return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
  }
  friend bool isFinite(const Vec3& a) {
    return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
  }
};

using Vec3f = Vec3<float>;
using Vec3d = Vec3<double>;

// Return and write three numbers in a row.
template <class T> inline Vec3<T> vectorOf(const T* v) { return {v[0], v[1], v[2]}; }
template <class T> inline void store(const Vec3<T>& v, T* to) {
  to[0] = v.x;
  to[1] = v.y;
  to[2] = v.z;
}
// Return and write element i of a structure of arrays.
inline Vec3f load(const float* const from[3], size_t i) {
  return {from[0][i], from[1][i], from[2][i]};
}
inline void store(const Vec3f& v, float* const to[3], size_t i) {
  to[0][i] = v.x;
  to[1][i] = v.y;
  to[2][i] = v.z;
}
// Writes element i of three consecutive arrays.
template <size_t n> inline void store(const Vec3f& v, float (&to)[3][n], size_t i) {
  to[0][i] = v.x;
  to[1][i] = v.y;
  to[2][i] = v.z;
}

// A 3x3 matrix: the rows of a linear map.
template <class T> struct Rows {
  Vec3<T> x, y, z;

  static Rows ofColumns(const Vec3<T>& a, const Vec3<T>& b, const Vec3<T>& c) {
    return {{a.x, b.x, c.x}, {a.y, b.y, c.y}, {a.z, b.z, c.z}};
  }
  // Returns row 0, 1 or 2.
  const Vec3<T>& operator[](size_t k) const { return k == 0 ? x : k == 1 ? y : z; }
  Vec3<T> column(size_t k) const { return {x[k], y[k], z[k]}; }
  // Computes in the type of the vector's components.
  template <class U> friend Vec3<U> operator*(const Rows& m, const Vec3<U>& v) {
    return {dot(Vec3<U>(m.x), v), dot(Vec3<U>(m.y), v), dot(Vec3<U>(m.z), v)};
  }
};

} // namespace openrt
