// sphere.cpp: exact crossings of rays and placed spheres (crossings.h).
//
// With the adjugate A of the matrix and its determinant D, the point o + t d is on the sphere if
// |A (o - c) + t A d| = |D| r: a quadratic equation a t^2 + 2 b t + c = 0 whose coefficients are
// polynomials of the given numbers, so that Dyadic numbers hold them exactly.
#include <algorithm>

#include "backend/local/double/crossings.h"
#include "backend/local/double/dyadic.h"

namespace openrt {
namespace {

constexpr double tolerance = 0x1p-44; // relative error of t from which on it is computed exactly

template <class T> struct Quadratic {
  T a, b, c, discriminant; // discriminant: b^2 - a c

  Quadratic(const DoubleRay& ray, const Matrix4d& world, double radius) {
    const Vec3<T> x(world.column(0)), y(world.column(1)), z(world.column(2));
    const Vec3<T> yz = cross(y, z), zx = cross(z, x), xy = cross(x, y);
    const Vec3<T> from = Vec3<T>(ray.origin) - Vec3<T>(world.translation()), along(ray.direction);
    const Vec3<T> o{dot(yz, from), dot(zx, from), dot(xy, from)},
        d{dot(yz, along), dot(zx, along), dot(xy, along)};
    const T r = dot(x, yz) * T(radius);
    a = dot(d, d);
    b = dot(o, d);
    c = dot(o, o) - r * r;
    // The identity of Lagrange keeps the digits of spheres that are small and far away.
    const Vec3<T> across = cross(o, d);
    discriminant = a * r * r - dot(across, across);
  }
  T valueAt(double t) const { return (a * T(t) + b + b) * T(t) + c; }
  T slopeAt(double t) const { return a * T(t) + b; }
};

struct Roots {
  Bounded t[2];
};

// Without cancellation: the root of larger magnitude, and the other from the product of both.
Roots rootsOf(const Bounded& a, const Bounded& b, const Bounded& c, const Bounded& discriminant) {
  const Bounded root = sqrt(discriminant);
  const Bounded q = b.value < 0 ? root - b : -(root + b);
  Roots found{{q / a, c / q}};
  if (found.t[1].value < found.t[0].value) std::swap(found.t[0], found.t[1]);
  return found;
}

bool isGood(const Bounded& t) { return t.error <= tolerance * std::fabs(t.value); }

// Returns whether a root lies behind t: root 0 is the smaller one.
template <class T> bool isBehind(const Quadratic<T>& q, int root, double t) {
  const int value = q.valueAt(t).sign(), slope = q.slopeAt(t).sign();
  return root == 0 ? value > 0 && slope < 0 : value < 0 || slope < 0;
}

} // namespace

int crossSphere(const DoubleRay& ray, const Matrix4d& world, double radius,
                CrossingPoint (&at)[2]) {
  const Quadratic<Bounded> rough(ray, world, radius);
  if (rough.discriminant.sign() < 0) return 0;
  Roots found{{Bounded(0, HUGE_VAL), Bounded(0, HUGE_VAL)}};
  if (rough.discriminant.sign() > 0) found = rootsOf(rough.a, rough.b, rough.c, rough.discriminant);
  const auto isClear = [&](const Bounded& t) {
    return isGood(t) && (t - ray.near).sign() != 0 &&
           (std::isinf(ray.far) || (t - ray.far).sign() != 0);
  };
  bool inside[2];
  if (isClear(found.t[0]) && isClear(found.t[1])) {
    for (int i = 0; i < 2; i++)
      inside[i] = found.t[i].value > ray.near && found.t[i].value < ray.far;
  } else {
    const Quadratic<Dyadic> exact(ray, world, radius);
    if (exact.discriminant.sign() <= 0) return 0;
    found = rootsOf(exact.a.rounded(), exact.b.rounded(), exact.c.rounded(),
                    exact.discriminant.rounded());
    for (int i = 0; i < 2; i++)
      inside[i] =
          isBehind(exact, i, ray.near) && (std::isinf(ray.far) || !isBehind(exact, i, ray.far));
  }
  int count = 0;
  for (int i = 0; i < 2; i++)
    if (inside[i])
      at[count++] = {std::clamp(found.t[i].value, ray.near, ray.far), 0, 0, found.t[i].error, 0};
  return count;
}

} // namespace openrt
