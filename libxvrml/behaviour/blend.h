// blend.h: values between two others, as the interpolators need them (4.6.8). Pure functions; t in
// (0,1). [any thread]
#pragma once

#include "xvrml/types.h"

namespace xvrml {

inline float blend(float a, float b, float t) { return a + (b - a) * t; }
inline Vec3f blend(const Vec3f& a, const Vec3f& b, float t) {
  return {blend(a.x, b.x, t), blend(a.y, b.y, t), blend(a.z, b.z, t)};
}
// In HSV, the shortest way round the hues; opposite hues through rising ones. A grey has the other
// colour's hue (6.10).
Color blend(const Color& a, const Color& b, float t);
// The shortest way as quaternions (6.32); the angle of the result is in [0,pi]. The way between
// rotations that are half a turn apart is undefined: it goes as their angles, as written, say, so
// that 0, 3.1416, 6.2832 about one axis is one whole turn.
Rotation blend(const Rotation& a, const Rotation& b, float t);
// Along the great circle (6.31), of unit length whatever the lengths of a and b; a zero vector has
// the other's direction.
Vec3f blendNormals(const Vec3f& a, const Vec3f& b, float t);

} // namespace xvrml
