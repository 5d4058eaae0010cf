#include "behaviour/squad.h"

#include "behaviour/quaternion.h"

namespace xvrml {
namespace {

// Returns the quaternion of a rotation on the side of another: -q is the same rotation as q.
Quaternion near(const Quaternion& other, const Rotation& r) {
  const Quaternion q = toQuaternion(r);
  return dot(other, q) < 0 ? -q : q;
}

// Returns the inner control point of a value: q exp(-(log(q^-1 next) + log(q^-1 previous)) / 4).
// The ends of the list are their own control points.
Quaternion control(std::span<const Rotation> values, size_t i, const Quaternion& q) {
  if (i == 0 || i + 1 == values.size()) return q;
  const Quaternion back = inverse(q);
  const V3d sum =
      logarithm(back * near(q, values[i + 1])) + logarithm(back * near(q, values[i - 1]));
  return q * exponential(sum * -0.25);
}

} // namespace

Rotation squad(std::span<const Rotation> values, size_t left, double t) {
  const Quaternion a = toQuaternion(values[left]), b = near(a, values[left + 1]);
  const Quaternion outer = slerp(a, b, t);
  const Quaternion inner = slerp(control(values, left, a), control(values, left + 1, b), t);
  return toRotation(slerp(outer, inner, 2 * t * (1 - t)),
                    V3d(values[left].x, values[left].y, values[left].z));
}

} // namespace xvrml
