// vectors.h: vectors of three floats: read from structure-of-arrays storage, multiplied, mapped.
// Pure functions.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "render/records.h"

namespace openrt {

struct Vector3 {
  float x[3];
  operator const float*() const { return x; }
};

inline Vector3 vectorOf(const float v[3]) { return {{v[0], v[1], v[2]}}; }

// Returns vector i of three arrays.
inline Vector3 vectorAt(const float* const arrays[3], uint32_t i) {
  return {{arrays[0][i], arrays[1][i], arrays[2][i]}};
}

inline float dot3(const float a[3], const float b[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

inline float largest(const float v[3]) { return std::max({v[0], v[1], v[2]}); }

inline Vector3 mapPoint(const Affine& m, const float p[3]) {
  Vector3 out;
  for (int k = 0; k < 3; k++)
    out.x[k] = m.r[k][0] * p[0] + m.r[k][1] * p[1] + m.r[k][2] * p[2] + m.r[k][3];
  return out;
}

inline Vector3 mapVector(const Affine& m, const float v[3]) {
  Vector3 out;
  for (int k = 0; k < 3; k++) out.x[k] = dot3(m.r[k], v);
  return out;
}

// Maps a vector and makes its length 1.
inline Vector3 mapDirection(const Affine& m, const float v[3]) {
  Vector3 out = mapVector(m, v);
  const float s = 1 / std::sqrt(dot3(out, out));
  for (float& x : out.x) x *= s;
  return out;
}

} // namespace openrt
