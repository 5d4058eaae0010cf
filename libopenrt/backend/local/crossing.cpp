// crossing.cpp: exact crossings of rays and triangles (crossing.h). Every sign is first computed in
// double precision with an error bound, and only if that leaves it open with expansions.
#include "backend/local/crossing.h"

#include <cmath>

#include "backend/local/expansion.h"

namespace openrt {
namespace {

// The sums of products below have at most 6 terms of 3 factors. Each factor and each operation
// errs by 2^-53 at most, so 64 * 2^-53 times the largest product bounds the error of the sum, with
// a reserve of 2.
constexpr double rounding = 0x1p-46;

int signOf(double x) { return x > 0 ? 1 : x < 0 ? -1 : 0; }

struct ExactVec {
  Expansion x, y, z;
  static ExactVec difference(const Vec3d& a, const Vec3d& b) {
    return {Expansion::difference(a.x, b.x), Expansion::difference(a.y, b.y),
            Expansion::difference(a.z, b.z)};
  }
  static ExactVec of(const Vec3d& a) { return {Expansion(a.x), Expansion(a.y), Expansion(a.z)}; }
};

Expansion minorOf(const Expansion& a, const Expansion& b, const Expansion& c, const Expansion& d) {
  return a * d - b * c;
}

// Returns the determinant of the rows a, b, c.
Expansion determinant(const ExactVec& a, const ExactVec& b, const ExactVec& c) {
  Expansion sum = minorOf(b.y, b.z, c.y, c.z) * a.x;
  sum += minorOf(b.z, b.x, c.z, c.x) * a.y;
  return sum += minorOf(b.x, b.y, c.x, c.y) * a.z;
}

// Decides on which side of an edge a ray passes that meets the edge exactly. The side of the moved
// origin o + e is side(o) + e . ((p - q) x d), so the first component that is not 0 decides. All
// are 0 for an edge along the ray; its triangle is seen edge-on and never crossed.
int sideOfMovedRay(const Vec3d& p, const Vec3d& q, const Vec3d& direction) {
  const ExactVec e = ExactVec::difference(p, q), d = ExactVec::of(direction);
  if (const int s = minorOf(e.y, e.z, d.y, d.z).sign()) return s;
  if (const int s = minorOf(e.z, e.x, d.z, d.x).sign()) return s;
  return minorOf(e.x, e.y, d.x, d.y).sign();
}

// side(p, q) = d . ((p - o) x (q - o)), with p and q relative to o: swapping p and q negates it.
struct Side {
  double value, error;
  Side(const Vec3d& p, const Vec3d& q, const Vec3d& d)
      : value(dot(cross(p, q), d)),
        error(rounding * largest(abs(p)) * largest(abs(q)) * largest(abs(d))) {}
  bool certain() const { return std::fabs(value) > error; }
};

Expansion exactSide(const ExactRay& ray, const Vec3d& p, const Vec3d& q) {
  return determinant(ExactVec::of(ray.direction), ExactVec::difference(p, ray.origin),
                     ExactVec::difference(q, ray.origin));
}

int signOfSide(const Side& rough, const ExactRay& ray, const Vec3d& p, const Vec3d& q) {
  if (rough.certain()) return signOf(rough.value);
  const int sign = exactSide(ray, p, q).sign();
  return sign != 0 ? sign : sideOfMovedRay(p, q, ray.direction);
}

// The corners of a triangle, and its edges from a. Relative to the ray's origin: ra.
struct Plane {
  const Vec3d &a, &b, &c;
  Vec3d ab, ac, ra;
};

// Returns the sign of n . (a - (o + t d)), n = (b - a) x (c - a): the side of the plane on which
// the ray's point at t lies.
int sideOfPoint(const Plane& plane, const ExactRay& ray, double t) {
  const Vec3d to = plane.ra - ray.direction * t;
  const double rough = dot(cross(plane.ab, plane.ac), to),
               size = largest(abs(plane.ra)) + largest(abs(ray.direction)) * std::fabs(t),
               error = rounding * largest(abs(plane.ab)) * largest(abs(plane.ac)) * size;
  if (std::fabs(rough) > error) return signOf(rough);
  ExactVec at = ExactVec::difference(plane.a, ray.origin);
  const auto advance = [t](Expansion& x, double d) {
    const TwoTerms p = exactProduct(-t, d);
    x.add(p.low);
    x.add(p.high);
  };
  advance(at.x, ray.direction.x);
  advance(at.y, ray.direction.y);
  advance(at.z, ray.direction.z);
  return determinant(at, ExactVec::difference(plane.b, plane.a),
                     ExactVec::difference(plane.c, plane.a))
      .sign();
}

// Computes where the ray's line meets the triangle, from the weights of a, b and c.
bool locate(const ExactRay& ray, const Plane& s, const double (&weight)[3], double error,
            CrossingPoint& at) {
  const double sum = weight[0] + weight[1] + weight[2];
  at.u = weight[1] / sum;
  at.v = weight[2] / sum;
  at.uvError = 4 * error / std::fabs(sum) + 0x1p-50;
  const Vec3d point = s.ra + s.ab * at.u + s.ac * at.v;
  const double square = dot(ray.direction, ray.direction);
  at.t = dot(point, ray.direction) / square;
  const double reach = largest(abs(s.ra)) + largest(abs(s.ab)) + largest(abs(s.ac)),
               spread = largest(abs(s.ab)) + largest(abs(s.ac));
  at.tError = (2 * at.uvError * spread + 0x1p-48 * reach) / std::sqrt(square);
  return std::isfinite(at.t) && std::isfinite(at.u) && std::isfinite(at.v);
}

} // namespace

ExactRay exactRay(const Vec3d& origin, const Vec3d& direction, double near, double far,
                  double tolerance) {
  const auto kept = [](double x) { return std::fabs(x) < 0x1p-200 ? 0 : x; };
  const double unit = std::exp2(-std::ilogb(largest(abs(direction))));
  const Vec3d d = direction * unit;
  return {{kept(origin.x), kept(origin.y), kept(origin.z)},
          {kept(d.x), kept(d.y), kept(d.z)},
          kept(near / unit),
          far / unit,
          unit,
          tolerance};
}

bool crosses(const ExactRay& ray, const Vec3d& a, const Vec3d& b, const Vec3d& c,
             CrossingPoint& at) {
  const Vec3d &d = ray.direction, ra = a - ray.origin, rb = b - ray.origin, rc = c - ray.origin;
  // Most triangles are rejected by two certain signs that differ.
  const Side bc(rb, rc, d), ca(rc, ra, d), ab(ra, rb, d);
  const bool positive = (bc.certain() && bc.value > 0) || (ca.certain() && ca.value > 0) ||
                        (ab.certain() && ab.value > 0),
             negative = (bc.certain() && bc.value < 0) || (ca.certain() && ca.value < 0) ||
                        (ab.certain() && ab.value < 0);
  if (positive && negative) return false;
  const int sign = signOfSide(bc, ray, b, c);
  if (sign == 0 || signOfSide(ca, ray, c, a) != sign || signOfSide(ab, ray, a, b) != sign)
    return false;
  // The three sides add up to n . d, so `sign` is that of n . d.
  const Plane plane{a, b, c, b - a, c - a, ra};
  if (sideOfPoint(plane, ray, ray.near) != sign) return false;
  if (std::isfinite(ray.far) && sideOfPoint(plane, ray, ray.far) == sign) return false;
  double weight[3] = {bc.value, ca.value, ab.value};
  double error = bc.error + ca.error + ab.error;
  if (error > ray.tolerance * std::fabs(weight[0] + weight[1] + weight[2])) {
    weight[0] = exactSide(ray, b, c).rounded();
    weight[1] = exactSide(ray, c, a).rounded();
    weight[2] = exactSide(ray, a, b).rounded();
    error = 0x1p-50 * std::fabs(weight[0] + weight[1] + weight[2]);
  }
  return locate(ray, plane, weight, error, at);
}

} // namespace openrt
