// blend.h: interpolation between two values, as the interpolator nodes need it (4.6.8). Pure
// functions; t in (0,1). [any thread]
#pragma once

#include "xvrml/types.h"

namespace xvrml {

inline float blend(float a, float b, float t) { return a + (b - a) * t; }
inline Vec2f blend(const Vec2f& a, const Vec2f& b, float t) {
  return {blend(a.x, b.x, t), blend(a.y, b.y, t)};
}
inline Vec3f blend(const Vec3f& a, const Vec3f& b, float t) {
  return {blend(a.x, b.x, t), blend(a.y, b.y, t), blend(a.z, b.z, t)};
}
// Interpolates in HSV along the shorter arc of hues; opposite hues go through increasing hues. A
// grey takes the other colour's hue (6.10).
Color blend(const Color& a, const Color& b, float t);
// Interpolates along the shortest quaternion path (6.32). The angle of the result is in [0,pi]. The
// path between rotations half a turn apart is undefined. It then follows the angles as written, so
// that 0, 3.1416, 6.2832 about one axis make one whole turn.
Rotation blend(const Rotation& a, const Rotation& b, float t);
// Interpolates along the great circle (6.31). The result has unit length whatever the lengths of a
// and b. A zero vector takes the other's direction.
Vec3f blendNormals(const Vec3f& a, const Vec3f& b, float t);

} // namespace xvrml
