// blend.cpp: interpolates between two values. It computes in double, because the arguments are
// floats of any size.
#include "behaviour/blend.h"

#include <algorithm>
#include <cmath>

#include "behaviour/quaternion.h"

namespace xvrml {
namespace {

struct Hsv {
  double h = 0, s = 0, v = 0; // hue in sixths of the circle, [0,6)
};

Hsv toHsv(const Color& c) {
  const double r = c.r, g = c.g, b = c.b;
  const double most = std::max({r, g, b}), range = most - std::min({r, g, b});
  if (!(most > 0) || !(range > 0)) return {0, 0, most};
  double h = 0;
  if (most == r)
    h = (g - b) / range;
  else if (most == g)
    h = 2 + (b - r) / range;
  else
    h = 4 + (r - g) / range;
  return {h < 0 ? h + 6 : h, range / most, most};
}

Color toRgb(const Hsv& c) {
  // HSV to RGB of Smith 1978, written as one expression per channel
  const auto channel = [&](double n) {
    const double k = std::fmod(n + c.h, 6);
    return float(c.v - c.v * c.s * std::clamp(std::min(k, 4 - k), 0.0, 1.0));
  };
  return {channel(5), channel(3), channel(1)};
}

// Returns the angle of two unit vectors. It is accurate also near 0 and pi (Kahan).
double angleBetween(const V3d& a, const V3d& b) {
  return 2 * std::atan2((a - b).length(), (a + b).length());
}

} // namespace

Color blend(const Color& first, const Color& second, float t) {
  Hsv a = toHsv(first), b = toHsv(second);
  if (a.s == 0) a.h = b.h;
  if (b.s == 0) b.h = a.h;
  double turn = b.h - a.h;
  if (turn > 3) turn -= 6;
  if (turn <= -3) turn += 6;
  Hsv c{a.h + turn * t, a.s + (b.s - a.s) * t, a.v + (b.v - a.v) * t};
  if (c.h < 0) c.h += 6;
  return toRgb(c);
}

Rotation blend(const Rotation& first, const Rotation& second, float t) {
  const Quaternion a = toQuaternion(first);
  Quaternion b = toQuaternion(second);
  if (dot(a, b) < -1e-3) b = -b; // -q is the same rotation as q
  // no rotation keeps the axis of one of the ends
  return toRotation(slerp(a, b, t), V3d(first.x, first.y, first.z));
}

Vec3f blendNormals(const Vec3f& first, const Vec3f& second, float t) {
  V3d a = unit(toV3d(first)), b = unit(toV3d(second));
  if (a == V3d(0)) a = b;
  if (b == V3d(0)) b = a;
  if (a == V3d(0)) return {0, 0, 0};
  const double angle = angleBetween(a, b);
  if (angle > M_PI - 1e-6) { // opposite: half a turn about an axis that depends on a only
    const V3d side =
        unit(std::abs(a.x) < 0.7 ? a.cross(V3d(1, 0, 0)) : a.cross(V3d(0, 1, 0))).cross(a);
    return toVec3f(a * std::cos(M_PI * t) + side * std::sin(M_PI * t));
  }
  const auto [x, y] = arcWeights(angle, t);
  return toVec3f(unit(a * x + b * y));
}

} // namespace xvrml
