// ray_triangle.cpp: Intersects a ray and a triangle in double precision (ray_triangle.h). Numbers
// that double precision cannot tell from 0 are recomputed in long double, which has 64 bits of
// mantissa on x86. Such numbers, products of three differences of floats, occur for triangles a
// million times longer than high that are hit at an angle of 1e-7.
#include "backend/local/ray_triangle.h"

#include <algorithm>
#include <cmath>

namespace openrt {
namespace {

// Returns twice the volume that the direction and the edge from p to q span with the origin;
// swapping p and q exactly negates it. The sign says on which side of the edge the ray passes
// (Pluecker coordinates, as in S. Woop, C. Benthin, I. Wald: Watertight ray/triangle intersection,
// JCGT 2(1), 2013, but for any direction).
template <class T> T side(const Vec3<T>& p, const Vec3<T>& q, const Vec3<T>& d) {
  return dot(cross(q - p, q + p), d);
}

// Returns side(), recomputed in long double if the double result is below the error bound. The
// bound depends only on the edge, so both of its triangles choose the same precision. It leaves a
// factor of 2^20 above the rounding error, because a barycentric weight must be right to about 1e-6
// at grazing angles too.
double sideOf(const Vec3d& p, const Vec3d& q, const Vec3d& d) {
  const double rough = side(p, q, d);
  const double doubt =
      0x1p-30 * largest(abs(q - p)) * (largest(abs(p)) + largest(abs(q))) * largest(abs(d));
  if (std::fabs(rough) > doubt) return rough;
  using Long = Vec3<long double>;
  return double(side(Long(p), Long(q), Long(d)));
}

struct Sides {
  double ac, ba, cb; // barycentric weights of b, c and a, not normalised
};

Sides sidesOf(const RelativeTriangle& s, const Vec3d& d) {
  return {sideOf(s.a, s.c, d), sideOf(s.b, s.a, d), sideOf(s.c, s.b, d)};
}

// Finds the point (1 - s) p + s q of an edge that is closest to the line along d through the
// origin. Returns its distance from the line; t is its parameter along the line.
double closestPointOnEdge(const Vec3d& p, const Vec3d& q, const Vec3d& d, double& s, double& t) {
  const Vec3d e = q - p;
  const double dd = dot(d, d);
  // p and e without their components along the line.
  const Vec3d pp = p - d * (dot(p, d) / dd), ee = e - d * (dot(e, d) / dd);
  const double square = dot(ee, ee);
  s = square > 0 ? std::clamp(-dot(pp, ee) / square, 0.0, 1.0) : 0;
  t = dot(p + e * s, d) / dd;
  return length(pp + ee * s);
}

} // namespace

bool intersectTriangle(const RelativeTriangle& s, const Vec3d& d, TriangleHit& at) {
  const Sides w = sidesOf(s, d);
  const bool front = w.ac >= 0 && w.ba >= 0 && w.cb >= 0,
             back = w.ac <= 0 && w.ba <= 0 && w.cb <= 0;
  if (!front && !back) return false;
  const double sum = w.ac + w.ba + w.cb;
  if (sum == 0) return false;
  at.u = w.ac / sum;
  at.v = w.ba / sum;
  const Vec3d p = s.a * (w.cb / sum) + s.b * at.u + s.c * at.v;
  at.t = dot(p, d) / dot(d, d);
  return std::isfinite(at.t);
}

double closestPointToLine(const RelativeTriangle& s, const Vec3d& d, unsigned edges,
                          TriangleHit& at) {
  double best = HUGE_VAL, share = 0, t = 0;
  const auto nearer = [&](unsigned edge, const Vec3d& p, const Vec3d& q) {
    if (!(edges & (1u << edge))) return false;
    const double distance = closestPointOnEdge(p, q, d, share, t);
    if (!(distance < best)) return false;
    best = distance;
    at.t = t;
    return true;
  };
  if (nearer(0, s.a, s.c)) {
    at.u = 0;
    at.v = share;
  }
  if (nearer(1, s.a, s.b)) {
    at.u = share;
    at.v = 0;
  }
  if (nearer(2, s.b, s.c)) {
    at.u = 1 - share;
    at.v = share;
  }
  return best;
}

bool intersectUnitSphere(const Vec3d& o, const Vec3d& d, double t[2]) {
  const double dd = dot(d, d), middle = -dot(o, d) / dd;
  const Vec3d across = o + d * middle;
  const double h = length(across), square = (1 - h) * (1 + h) / dd;
  if (!(square >= 0)) return false;
  const double half = std::sqrt(square), far = middle + std::copysign(half, middle),
               distance = length(o);
  const double near = far != 0 ? (distance - 1) * (distance + 1) / dd / far : 0;
  t[0] = std::min(near, far);
  t[1] = std::max(near, far);
  return std::isfinite(near) && std::isfinite(far);
}

double intersectPlane(const RelativeTriangle& s, const Vec3d& d) {
  const Vec3d n = cross(s.b - s.a, s.c - s.a);
  return dot(n, s.a) / dot(n, d);
}

bool isHitInSinglePrecision(const RelativeTriangle& s, const Vec3d& direction, float near,
                            float far) {
  const Vec3f d(direction), a(s.a), b(s.b), c(s.c), e0 = c - a, e1 = a - b, e2 = b - c;
  const float u = dot(cross(e0, c + a), d), v = dot(cross(e1, a + b), d),
              w = dot(cross(e2, b + c), d);
  const float slack = 0x1p-23f * std::fabs(u + v + w);
  if (!(std::min({u, v, w}) >= -slack || std::max({u, v, w}) <= slack)) return false;
  const Vec3f n = cross(e0, e1);
  const float t = dot(a, n) / dot(n, d);
  return t >= near && t <= far;
}

std::optional<TriangleHit> refineHit(const Record& r, uint32_t primitive, const RaySegment& ray) {
  const auto place = [&](int k) {
    const Vec3d p(r.corner(primitive, k));
    return r.instanced ? p : p * double(r.scale);
  };
  Vec3d from = ray.origin, d = ray.direction;
  if (r.instanced) {
    Matrix4d m;
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 4; j++) m.m[size_t(4 * j + i)] = r.frames->toRender.r[i][j];
    const Matrix4d back = inverse(m);
    from = back.point(ray.origin);
    d = back.direction(ray.direction);
  }
  const RelativeTriangle seen{place(0) - from, place(1) - from, place(2) - from};
  TriangleHit at;
  if (!intersectTriangle(seen, d, at) && !std::isfinite(closestPointToLine(seen, d, 7, at)))
    return {};
  if (!std::isfinite(at.t) || !std::isfinite(at.u) || !std::isfinite(at.v)) return {};
  at.t = double(std::clamp(float(at.t), ray.near, ray.far));
  return at;
}

} // namespace openrt
