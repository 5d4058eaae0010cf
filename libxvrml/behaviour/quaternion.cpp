#include "behaviour/quaternion.h"

#include <algorithm>
#include <cmath>

namespace xvrml {

Quaternion toQuaternion(const Rotation& r) {
  const V3d axis = unit(V3d(r.x, r.y, r.z));
  if (axis == V3d(0) || !std::isfinite(r.angle)) return {V3d(0), 1};
  return {axis * std::sin(0.5 * double(r.angle)), std::cos(0.5 * double(r.angle))};
}

Rotation toRotation(const Quaternion& q, const V3d& axis) {
  const V3d v = q.w < 0 ? -q.v : q.v;
  const V3d direction = unit(v);
  if (direction != V3d(0))
    return {float(direction.x), float(direction.y), float(direction.z),
            float(2 * std::atan2(v.length(), std::abs(q.w)))};
  const V3d kept = unit(axis);
  return kept == V3d(0) ? Rotation{0, 0, 1, 0}
                        : Rotation{float(kept.x), float(kept.y), float(kept.z), 0};
}

Quaternion operator*(const Quaternion& a, const Quaternion& b) {
  return {a.v.cross(b.v) + b.v * a.w + a.v * b.w, a.w * b.w - a.v.dot(b.v)};
}

V3d logarithm(const Quaternion& q) {
  const double sine = q.v.length();
  return sine > 0 ? q.v * (std::atan2(sine, q.w) / sine) : V3d(0);
}

Quaternion exponential(const V3d& v) {
  const double angle = v.length();
  return {angle > 0 ? v * (std::sin(angle) / angle) : V3d(0), std::cos(angle)};
}

std::pair<double, double> arcWeights(double angle, double t) {
  const double sine = std::sin(angle);
  if (sine < 1e-6) return {1 - t, t};
  return {std::sin((1 - t) * angle) / sine, std::sin(t * angle) / sine};
}

Quaternion slerp(const Quaternion& a, const Quaternion& b, double t) {
  const auto [x, y] = arcWeights(std::acos(std::clamp(dot(a, b), -1.0, 1.0)), t);
  return {a.v * x + b.v * y, a.w * x + b.w * y};
}

} // namespace xvrml
