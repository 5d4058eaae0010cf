// closest.cpp: closest places in double (closest.h). The formulas for triangles are templates over
// the kind of number: double to reject most triangles, then Bounded, and Dyadic where that leaves a
// decision open.
#include "backend/local/double/closest.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

#include "backend/local/double/dyadic.h"

namespace openrt {
namespace {

constexpr double distanceTolerance = 0x1p-44, uvTolerance = 0x1p-36;

int signOf(double x) { return (x > 0) - (x < 0); }
template <class T> int signOf(const T& x) { return x.sign(); }
double quotientOf(double a, double b) { return a / b; }
Bounded quotientOf(const Bounded& a, const Bounded& b) { return a / b; }
Bounded quotientOf(const Dyadic& a, const Dyadic& b) { return quotient(a, b); }

template <class T> Vec3<T> turned(const Matrix4d& m, const Vec3<T>& p) {
  return Vec3<T>(m.column(0)) * p.x + Vec3<T>(m.column(1)) * p.y + Vec3<T>(m.column(2)) * p.z;
}

enum class Part { unsure, none, a, b, c, ab, ac, bc, face };

// A triangle as seen from the point: the edges from a, and the projections of the way from each
// corner to the point on them (C. Ericson: Real-Time Collision Detection (2005), 5.1.5).
template <class T> struct Seen {
  Vec3<T> a, ab, ac; // a: from the point to corner a
  T d1, d2, d3, d4, d5, d6;

  Seen(const Vec3d& point, const PlacedTriangle& s)
      : a(Vec3<T>(s.world.translation()) - Vec3<T>(point) + turned(s.world, Vec3<T>(s.a))),
        ab(turned(s.world, Vec3<T>(s.b) - Vec3<T>(s.a))),
        ac(turned(s.world, Vec3<T>(s.c) - Vec3<T>(s.a))) {
    const Vec3<T> b = a + ab, c = a + ac;
    d1 = -dot(ab, a);
    d2 = -dot(ac, a);
    d3 = -dot(ab, b);
    d4 = -dot(ac, b);
    d5 = -dot(ab, c);
    d6 = -dot(ac, c);
  }
  Vec3<T> normal() const { return cross(ab, ac); }
  // Returns the part of the triangle on which the closest point lies; `unsure` if a sign is.
  Part part() const {
    bool sure = true;
    const auto sign = [&](const T& x) {
      const int s = signOf(x);
      if constexpr (std::is_same_v<T, Bounded>) sure &= s != 0;
      return s;
    };
    const Part found = partBy(sign);
    return sure ? found : Part::unsure;
  }

 private:
  template <class Sign> Part partBy(const Sign& sign) const {
    const Vec3<T> n = normal();
    if (sign(dot(n, n)) <= 0) return Part::none;
    if (sign(d1) <= 0 && sign(d2) <= 0) return Part::a;
    if (sign(d3) >= 0 && sign(d4 - d3) <= 0) return Part::b;
    if (sign(d1) >= 0 && sign(d3) <= 0 && sign(d1 * d4 - d3 * d2) <= 0) return Part::ab;
    if (sign(d6) >= 0 && sign(d5 - d6) <= 0) return Part::c;
    if (sign(d2) >= 0 && sign(d6) <= 0 && sign(d5 * d2 - d1 * d6) <= 0) return Part::ac;
    if (sign(d4 - d3) >= 0 && sign(d5 - d6) >= 0 && sign(d3 * d6 - d5 * d4) <= 0) return Part::bc;
    return Part::face;
  }
};

// The square of the distance, and the weights of corners b and c.
template <class N> struct Located { N square, u, v; };

template <class T> auto locate(const Seen<T>& s, Part part) {
  using N = decltype(quotientOf(s.d1, s.d1));
  const auto onEdge = [](const Vec3<T>& p, const Vec3<T>& edge) { // p: of an end of the edge
    const Vec3<T> across = cross(p, edge);
    return quotientOf(dot(across, across), dot(edge, edge));
  };
  const T one(1.0);
  const auto at = [&](const Vec3<T>& corner) { return quotientOf(dot(corner, corner), one); };
  switch (part) {
  case Part::a: return Located<N>{at(s.a), N(0), N(0)};
  case Part::b: return Located<N>{at(s.a + s.ab), N(1), N(0)};
  case Part::c: return Located<N>{at(s.a + s.ac), N(0), N(1)};
  case Part::ab: return Located<N>{onEdge(s.a, s.ab), quotientOf(s.d1, s.d1 - s.d3), N(0)};
  case Part::ac: return Located<N>{onEdge(s.a, s.ac), N(0), quotientOf(s.d2, s.d2 - s.d6)};
  case Part::bc: {
    const T whole = s.d4 - s.d3 + s.d5 - s.d6;
    return Located<N>{onEdge(s.a + s.ab, s.ac - s.ab), quotientOf(s.d5 - s.d6, whole),
                      quotientOf(s.d4 - s.d3, whole)};
  }
  default: {
    const Vec3<T> n = s.normal();
    const T height = dot(n, s.a), area = dot(n, n);
    return Located<N>{quotientOf(height * height, area),
                      quotientOf(s.d5 * s.d2 - s.d1 * s.d6, area),
                      quotientOf(s.d1 * s.d4 - s.d3 * s.d2, area)};
  }
  }
}

// Returns the root of a number that is not negative, but whose value may be.
Bounded rootOf(const Bounded& square) {
  if (square.value > 2 * square.error) return sqrt(square);
  // The truth is between 0 and the sum.
  const double most = std::sqrt(std::max(0.0, square.value + square.error)) * (1 + 0x1p-50);
  return {most / 2, most / 2};
}

DoubleClosest resultOf(const Located<Bounded>& found) {
  const Bounded distance = rootOf(found.square);
  return {std::max(distance.value, 0.0), std::clamp(found.u.value, 0.0, 1.0),
          std::clamp(found.v.value, 0.0, 1.0), distance.error,
          std::max(found.u.error, found.v.error)};
}

bool isGood(const DoubleClosest& c) {
  return c.distanceError <= distanceTolerance * c.distance && c.uvError <= uvTolerance;
}

// Returns whether the triangle is certainly farther than `most`, by a sum with a wide margin.
bool isFarther(const Vec3d& point, const PlacedTriangle& triangle, double most) {
  const Seen<double> rough(point, triangle);
  const Part part = rough.part();
  if (part == Part::none) return false;
  const double extent = largest(abs(rough.a)) + largest(abs(rough.ab)) + largest(abs(rough.ac)) +
                        largest(abs(point)) + largest(abs(triangle.world.translation())),
               slack = 1e-6 * (largest(abs(rough.ab)) + largest(abs(rough.ac))) + 1e-12 * extent;
  // With rounded signs the place may be on a wrong part, but it is one of the triangle; only a
  // sliver's can be off by much.
  const Vec3d n = rough.normal();
  const double longest = std::max(dot(rough.ab, rough.ab), dot(rough.ac, rough.ac));
  if (!(dot(n, n) > 1e-8 * longest * longest)) return false;
  return std::sqrt(locate(rough, part).square) - slack > most;
}

} // namespace

std::optional<DoubleClosest> closestOnTriangle(const Vec3d& point, const PlacedTriangle& triangle,
                                               double most) {
  if (isFarther(point, triangle, most)) return {};
  const Seen<Bounded> rough(point, triangle);
  Part part = rough.part();
  if (part != Part::unsure && part != Part::none) {
    const DoubleClosest found = resultOf(locate(rough, part));
    if (found.distance - found.distanceError > most) return {};
    if (isGood(found)) return found;
  }
  const Seen<Dyadic> exact(point, triangle);
  part = exact.part();
  if (part == Part::none) return {};
  return resultOf(locate(exact, part));
}

SphereShape shapeOf(const Matrix4d& world) {
  const Vec3d x = world.column(0), y = world.column(1), z = world.column(2);
  const double square = (dot(x, x) + dot(y, y) + dot(z, z)) / 3;
  // The matrix M has M'M = square (1 + E), and its singular values are within a share |E| of
  // sqrt(square). The norm of E is at most the sum of its elements.
  const double sum = std::fabs(dot(x, x) - square) + std::fabs(dot(y, y) - square) +
                     std::fabs(dot(z, z) - square) +
                     2 * (std::fabs(dot(x, y)) + std::fabs(dot(y, z)) + std::fabs(dot(z, x)));
  return {std::sqrt(square), sum / square + 0x1p-49};
}

ClosestOnSphere closestOnSphere(const Vec3d& point, const Matrix4d& world, double radius) {
  const SphereShape shape = shapeOf(world);
  const Bounded r(shape.scale * radius, shape.scale * radius * (shape.uneven + 0x1p-52));
  const Vec3<Bounded> center(world.translation()), from = Vec3<Bounded>(point) - center;
  const Bounded away = rootOf(dot(from, from)), distance = away - r;
  Vec3<Bounded> to{r, Bounded(0), Bounded(0)}; // in the middle all places are as close
  if (away.sign() > 0) to = from * (r / away);
  const Vec3<Bounded> place = center + to;
  // On an ellipsoid that is nearly a sphere, the closest place is off by the angle of its normal.
  const double turn = away.sign() > 0 ? 4 * shape.uneven * r.value * (1 + r.value / away.value) : 0;
  return {std::fabs(distance.value),
          distance.error,
          {{place.x.value, place.y.value, place.z.value},
           std::max({place.x.error, place.y.error, place.z.error}) + turn}};
}

} // namespace openrt
