// vector_math.h: conversions between the scene graph's vectors and Imath's, and checks for finite
// numbers. Used by geometry/ only.
#pragma once

#include <Imath/ImathVec.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "xvrml/types.h"

namespace xvrml {

using V2d = Imath::V2d;
using V3d = Imath::V3d;
using V3f = Imath::V3f;

inline V3d toV3d(const Vec3f& v) { return {v.x, v.y, v.z}; }
inline V3f toV3f(const Vec3f& v) { return {v.x, v.y, v.z}; }
inline Vec3f toVec3f(const V3d& v) { return {float(v.x), float(v.y), float(v.z)}; }
inline Vec3f toVec3f(const V3f& v) { return {v.x, v.y, v.z}; }

inline bool isFinite(float v) { return std::isfinite(v); }
inline bool isFinite(const Vec2f& v) { return std::isfinite(v.x) && std::isfinite(v.y); }
inline bool isFinite(const Vec3f& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}
inline bool isFinite(const Color& v) {
  return std::isfinite(v.r) && std::isfinite(v.g) && std::isfinite(v.b);
}

// Returns whether all numbers are finite. x * 0 is 0 for finite x and NaN otherwise, so summing the
// products needs no branches.
template <class T> bool allFinite(std::span<const T> values) {
  static_assert(sizeof(T) % sizeof(float) == 0);
  const float* p = reinterpret_cast<const float*>(values.data());
  size_t n = values.size() * (sizeof(T) / sizeof(float)), i = 0;
  float sums[8] = {};
  for (; i + 8 <= n; i += 8)
    for (size_t k = 0; k < 8; k++) sums[k] += p[i + k] * 0.0f;
  for (; i < n; i++) sums[0] += p[i] * 0.0f;
  return sums[0] + sums[1] + sums[2] + sums[3] + sums[4] + sums[5] + sums[6] + sums[7] == 0.0f;
}

// Returns the unit vector of v, or zero if v has no direction.
inline V3d unit(const V3d& v) {
  double largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
  if (!(largest > 0) || !std::isfinite(largest)) return {0, 0, 0};
  V3d scaled = v / largest; // avoids overflow and underflow of the squares
  return scaled / std::sqrt(scaled.dot(scaled));
}

// Returns whether the cross product of two edges is non-zero. Computed in double, this is exact: it
// is zero only for degenerate triangles.
inline bool hasArea(const Vec3f& a, const Vec3f& b, const Vec3f& c) {
  V3f u = toV3f(b) - toV3f(a), v = toV3f(c) - toV3f(a);
  V3f quick = u.cross(v);
  if ((std::abs(quick.x) > 1e-30f || std::abs(quick.y) > 1e-30f || std::abs(quick.z) > 1e-30f) &&
      std::isfinite(quick.x + quick.y + quick.z))
    return true;
  V3d exact = (toV3d(b) - toV3d(a)).cross(toV3d(c) - toV3d(a));
  return exact.x != 0 || exact.y != 0 || exact.z != 0;
}

} // namespace xvrml
