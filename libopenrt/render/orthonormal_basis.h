// orthonormal_basis.h: completes a unit vector to an orthonormal frame. Pure functions. [any
// thread]
//
// No such frame is continuous over all directions. Where it jumps, neighbouring samples choose
// unrelated points on a light, which makes noise. T. Duff et al., "Building an Orthonormal Basis,
// Revisited", JCGT 6(1), 2017, jumps along the whole circle z = 0, on which the normals of walls
// and lights often lie. Rounding alone then decides which side of the jump is used. Here a fixed
// frame is reflected at the plane between its third axis and -n. That is continuous except in one
// direction, which was chosen so that scenes hardly use it.
#pragma once

#include "scene/vec3.h"

namespace openrt {

// Writes s and t so that s, t and the unit vector n are a right-handed orthonormal frame.
template <class T> inline void basisOf(const Vec3<T>& n, Vec3<T>& s, Vec3<T>& t) {
  constexpr Vec3<T> pole{T(-0.66499826946907159), T(-0.11246117974981107), T(0.73832904903736574)};
  constexpr Vec3<T> first{T(0.74560472389174559), T(-0.043022056127687142), T(0.66499826946907159)};
  constexpr Vec3<T> second{T(-0.043022056127687142), T(0.99272432514562003),
                           T(0.11246117974981107)};
  const Vec3<T> v = n + pole;
  const T square = dot(v, v), scale = square > 0 ? 2 / square : T(0);
  s = first - scale * dot(n, first) * v;
  t = second - scale * dot(n, second) * v;
  if (square > T(0.01)) return;
  // Near the jump the sum has lost digits, so the frame is made orthogonal again.
  s -= dot(s, n) * n;
  s = s / length(s);
  t = cross(n, s);
}

} // namespace openrt
