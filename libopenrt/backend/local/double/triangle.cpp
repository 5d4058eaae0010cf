// triangle.cpp: exact crossings of rays and placed triangles (crossings.h). All formulas are
// templates over the kind of number: Bounded first, and Dyadic where that is not enough.
#include <algorithm>
#include <array>
#include <optional>

#include "backend/local/double/crossings.h"
#include "backend/local/double/dyadic.h"

namespace openrt {
namespace {

// Results of Bounded numbers with larger errors are computed again: relative to t, and of u and v.
constexpr double tTolerance = 0x1p-44, uvTolerance = 0x1p-36;

template <class T> Vec3<T> column(const Matrix4d& m, int k) { return Vec3<T>(m.column(k)); }

template <class T> Vec3<T> turned(const Matrix4d& m, const Vec3<T>& p) {
  return column<T>(m, 0) * p.x + column<T>(m, 1) * p.y + column<T>(m, 2) * p.z;
}

// The plane of a triangle in the world, with the edges from a.
template <class T> struct Plane {
  Vec3<T> ab, ac, normal, direction;

  Plane(const DoubleRay& ray, const PlacedTriangle& s)
      : ab(turned(s.world, Vec3<T>(s.b) - Vec3<T>(s.a))),
        ac(turned(s.world, Vec3<T>(s.c) - Vec3<T>(s.a))), normal(cross(ab, ac)),
        direction(ray.direction) {}
  // A face that contains the direction of the ray has 0 here.
  T along() const { return dot(normal, direction); }
};

// A triangle in the world, relative to the ray's origin.
template <class T> struct Seen : Plane<T> {
  using Plane<T>::ab, Plane<T>::ac, Plane<T>::normal, Plane<T>::direction;
  Vec3<T> a, b, c;

  Seen(const DoubleRay& ray, const PlacedTriangle& s, const Plane<T>& plane)
      : Plane<T>(plane),
        a(column<T>(s.world, 3) - Vec3<T>(ray.origin) + turned(s.world, Vec3<T>(s.a))), b(a + ab),
        c(a + ac) {}
  // Returns on which side of edge k, opposite corner k, the line of the ray passes. The three sides
  // add up to normal . direction.
  T side(int k) const {
    const Vec3<T>&p = k == 0 ? b : k == 1 ? c : a, &q = k == 0 ? c : k == 1 ? a : b;
    return dot(cross(p, q), direction);
  }
  // Returns on which side of the plane the point of the ray at t lies.
  T sideOfPoint(double t) const { return dot(normal, a - direction * T(t)); }
};

// Decides for a line that meets edge k exactly. See sideOfMovedRay() in crossing.cpp.
int sideOfMovedRay(const Seen<Dyadic>& s, int k) {
  const Vec3<Dyadic>&p = k == 0 ? s.b : k == 1 ? s.c : s.a, &q = k == 0 ? s.c : k == 1 ? s.a : s.b;
  const Vec3<Dyadic> by = cross(p - q, s.direction);
  if (const int sign = by.x.sign()) return sign;
  if (const int sign = by.y.sign()) return sign;
  return by.z.sign();
}

// The triangle in exact numbers, of which each part is made when it is needed.
class Exact {
 public:
  Exact(const DoubleRay& ray, const PlacedTriangle& s) : ray_(ray), triangle_(s) {}
  const Plane<Dyadic>& plane() {
    if (!plane_) plane_.emplace(ray_, triangle_);
    return *plane_;
  }
  const Seen<Dyadic>& get() {
    if (!seen_) seen_.emplace(ray_, triangle_, plane());
    return *seen_;
  }

 private:
  const DoubleRay& ray_;
  const PlacedTriangle& triangle_;
  std::optional<Plane<Dyadic>> plane_;
  std::optional<Seen<Dyadic>> seen_;
};

// Quotients of numbers of type T: t, u and v of the point where the line meets the plane.
Bounded quotientOf(const Bounded& a, const Bounded& b) { return a / b; }
Bounded quotientOf(const Dyadic& a, const Dyadic& b) { return quotient(a, b); }

struct Located {
  Bounded t, u, v;
};

// t = normal . a / normal . d. The point, relative to a, is h / (normal . d); its coordinates along
// the edges follow from the two axes that are best across the normal, numbered by i and k.
template <class T> Located locate(const Seen<T>& s, size_t i, size_t k) {
  const T height = dot(s.normal, s.a), along = s.along();
  const Vec3<T> h = s.direction * height - s.a * along;
  const T area = (s.ab[i] * s.ac[k] - s.ab[k] * s.ac[i]) * along;
  return {quotientOf(height, along), quotientOf(h[i] * s.ac[k] - h[k] * s.ac[i], area),
          quotientOf(s.ab[i] * h[k] - s.ab[k] * h[i], area)};
}

bool isGood(const Located& found) {
  return found.t.error <= tTolerance * std::fabs(found.t.value) && found.u.error <= uvTolerance &&
         found.v.error <= uvTolerance;
}

// Returns the numbers of the two axes that are not the normal's largest component.
std::array<size_t, 2> axesAcross(const Vec3<Bounded>& n) {
  const Vec3d size{std::fabs(n.x.value), std::fabs(n.y.value), std::fabs(n.z.value)};
  const size_t most = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  return {(most + 1) % 3, (most + 2) % 3};
}

} // namespace

bool crosses(const DoubleRay& ray, const PlacedTriangle& triangle, CrossingPoint& at) {
  const Seen<Bounded> rough(ray, triangle, Plane<Bounded>(ray, triangle));
  // The three sides of a ray that crosses have the sign of their sum, which is that of
  // normal . direction. Most triangles are rejected by two certain signs that differ.
  int along = rough.along().sign(), signs[3];
  for (int k = 0; k < 3; k++) signs[k] = rough.side(k).sign();
  if (std::max({along, signs[0], signs[1], signs[2]}) > 0 &&
      std::min({along, signs[0], signs[1], signs[2]}) < 0)
    return false;
  Exact exact(ray, triangle);
  if (along == 0) along = exact.plane().along().sign();
  if (along == 0) return false;
  for (int k = 0; k < 3; k++) {
    if (signs[k] == 0) signs[k] = exact.get().side(k).sign();
    if (signs[k] == 0) signs[k] = sideOfMovedRay(exact.get(), k);
    if (signs[k] != along) return false;
  }
  const auto sideOfPoint = [&](double t) {
    const int sign = rough.sideOfPoint(t).sign();
    return sign != 0 ? sign : exact.get().sideOfPoint(t).sign();
  };
  if (sideOfPoint(ray.near) != along) return false;
  if (std::isfinite(ray.far) && sideOfPoint(ray.far) == along) return false;
  const auto [i, k] = axesAcross(rough.normal);
  Located found = locate(rough, i, k);
  if (!isGood(found)) {
    const Vec3<Dyadic>& n = exact.get().normal;
    const auto [e, f] = axesAcross({n.x.rounded(), n.y.rounded(), n.z.rounded()});
    found = locate(exact.get(), e, f);
  }
  // The truth is within these limits, so that a number comes nearer to it.
  at.t = std::clamp(found.t.value, ray.near, ray.far);
  at.u = std::clamp(found.u.value, 0.0, 1.0);
  at.v = std::clamp(found.v.value, 0.0, 1.0);
  at.tError = found.t.error;
  at.uvError = std::max(found.u.error, found.v.error);
  return true;
}

namespace {

DoublePlace placeOf(const Vec3<Bounded>& p) {
  return {{p.x.value, p.y.value, p.z.value}, std::max({p.x.error, p.y.error, p.z.error})};
}

} // namespace

DoublePlace placeOnRay(const DoubleRay& ray, const CrossingPoint& at) {
  const Bounded t(at.t, at.tError);
  return placeOf(Vec3<Bounded>(ray.origin) + Vec3<Bounded>(ray.direction) * t);
}

DoublePlace placeOnTriangle(const PlacedTriangle& s, const CrossingPoint& at) {
  const Vec3<Bounded> a(s.a), b(s.b), c(s.c);
  const Bounded u(at.u, at.uvError), v(at.v, at.uvError);
  const Vec3<Bounded> p = a + (b - a) * u + (c - a) * v;
  return placeOf(column<Bounded>(s.world, 3) + turned(s.world, p));
}

} // namespace openrt
