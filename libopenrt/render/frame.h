// frame.h: completes a unit vector to an orthonormal frame. Pure functions. [any thread]
//
// No such frame is continuous over all directions. Where it jumps, neighbouring samples choose
// unrelated points on a light, which makes noise. T. Duff et al., "Building an Orthonormal Basis,
// Revisited", JCGT 6(1), 2017, jumps along the whole circle z = 0, on which the normals of walls
// and lights often lie. Rounding alone then decides which side of the jump is used. Here a fixed
// frame is reflected at the plane between its third axis and -n. That is continuous except in one
// direction, which was chosen so that scenes hardly use it.
#pragma once

#include <cmath>

namespace openrt {

// Writes s and t so that s, t and the unit vector n are a right-handed orthonormal frame.
template <class T> inline void basisOf(const T n[3], T s[3], T t[3]) {
  static constexpr T pole[3] = {T(-0.66499826946907159), T(-0.11246117974981107),
                                T(0.73832904903736574)};
  static constexpr T first[3] = {T(0.74560472389174559), T(-0.043022056127687142),
                                 T(0.66499826946907159)};
  static constexpr T second[3] = {T(-0.043022056127687142), T(0.99272432514562003),
                                  T(0.11246117974981107)};
  const T v[3] = {n[0] + pole[0], n[1] + pole[1], n[2] + pole[2]};
  const T square = v[0] * v[0] + v[1] * v[1] + v[2] * v[2], scale = square > 0 ? 2 / square : T(0);
  const T a = scale * (n[0] * first[0] + n[1] * first[1] + n[2] * first[2]);
  const T b = scale * (n[0] * second[0] + n[1] * second[1] + n[2] * second[2]);
  for (int k = 0; k < 3; k++) {
    s[k] = first[k] - a * v[k];
    t[k] = second[k] - b * v[k];
  }
  if (square > T(0.01)) return;
  // Near the jump the sum has lost digits, so the frame is made orthogonal again.
  const T along = s[0] * n[0] + s[1] * n[1] + s[2] * n[2];
  T length = 0;
  for (int k = 0; k < 3; k++) {
    s[k] -= along * n[k];
    length += s[k] * s[k];
  }
  length = std::sqrt(length);
  for (int k = 0; k < 3; k++) s[k] /= length;
  for (int k = 0; k < 3; k++)
    t[k] = n[(k + 1) % 3] * s[(k + 2) % 3] - n[(k + 2) % 3] * s[(k + 1) % 3];
}

} // namespace openrt
