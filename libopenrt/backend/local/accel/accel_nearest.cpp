// accel_nearest.cpp: finds the surface point closest to a given point. Embree finds the primitives
// whose bounding boxes are near enough; their distances are computed here in double precision, in
// render space. Called by the threads of a query.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>

#include "backend/local/accel/accel.h"

namespace openrt {
namespace {

using Weights = std::array<double, 3>;

// Returns the barycentric weights of the triangle's point closest to p (C. Ericson: Real-Time
// Collision Detection (2005), 5.1.5).
Weights closestOnTriangle(const Vec3d& p, const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  const Vec3d ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const double d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return {1, 0, 0};
  const double d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return {0, 1, 0};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return {1 - d1 / (d1 - d3), d1 / (d1 - d3), 0};
  const double d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return {0, 0, 1};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return {1 - d2 / (d2 - d6), 0, d2 / (d2 - d6)};
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    const double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return {0, 1 - w, w};
  }
  const double sum = va + vb + vc;
  if (!(sum > 0)) return {1, 0, 0}; // no area
  return {va / sum, vb / sum, vc / sum};
}

// Computes the eigenvalues (diagonal of a) and eigenvectors (columns of v) of a symmetric matrix by
// Jacobi rotations.
void eigen(double a[3][3], double v[3][3]) {
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) v[i][j] = i == j;
  for (int round = 0; round < 30; round++)
    for (int p = 0; p < 2; p++)
      for (int q = p + 1; q < 3; q++) {
        if (a[p][q] == 0) continue;
        const double theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
        const double t =
            std::copysign(1, theta) / (std::fabs(theta) + std::sqrt(theta * theta + 1));
        const double c = 1 / std::sqrt(t * t + 1), s = t * c;
        for (int k = 0; k < 3; k++) {
          const double x = a[k][p], y = a[k][q];
          a[k][p] = c * x - s * y;
          a[k][q] = s * x + c * y;
        }
        for (int k = 0; k < 3; k++) {
          const double x = a[p][k], y = a[q][k];
          a[p][k] = c * x - s * y;
          a[q][k] = s * x + c * y;
        }
        for (int k = 0; k < 3; k++) {
          const double x = v[k][p], y = v[k][q];
          v[k][p] = c * x - s * y;
          v[k][q] = s * x + c * y;
        }
      }
}

// Returns the unit vector s whose image m s is closest to p; m is the linear part of an ellipsoid's
// map. s solves (G + l) s = b with G = m'm and b = m'p, for the only l with |s| = 1 and G + l
// positive (J. More, D. Sorensen: Computing a trust region step, 1983).
Vec3d closestOnEllipsoid(const Affine& map, const Vec3d& p) {
  double g[3][3], v[3][3];
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) g[i][j] = dot(Vec3d(map.column(i)), Vec3d(map.column(j)));
  eigen(g, v);
  Vec3d b, y;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      for (int k = 0; k < 3; k++) b[i] += v[j][i] * double(map.r[k][j]) * p[k];
  const int smallest = g[0][0] <= g[1][1] && g[0][0] <= g[2][2] ? 0 : g[1][1] <= g[2][2] ? 1 : 2;
  const double floor = -g[smallest][smallest];
  const auto square = [&](double l) {
    for (int i = 0; i < 3; i++) y[i] = b[i] == 0 ? 0 : b[i] / (g[i][i] + l);
    return dot(y, y);
  };
  double low = floor, high = floor + length(b);
  for (int i = 0; i < 100 && low < high; i++) {
    const double middle = low + (high - low) / 2;
    if (middle == low || middle == high) break;
    (square(middle) > 1 ? low : high) = middle;
  }
  const double sum = high > floor ? square(high) : 0;
  if (high == floor) y = {};
  if (sum < 1) { // p is in a plane of symmetry: points on both sides of it are equally close
    const double rest = std::sqrt(std::max(0.0, 1 - sum + y[smallest] * y[smallest]));
    y[smallest] = std::copysign(rest, y[smallest]);
  }
  Vec3d s;
  for (int i = 0; i < 3; i++) s += Vec3d{v[0][i], v[1][i], v[2][i]} * y[i];
  return s * (1 / length(s));
}

} // namespace

struct Accel::PointSearch {
  const Accel* accel;
  const Level* level;
  Vec3d place;
  Nearest* best;
};

bool Accel::visitNear(RTCPointQueryFunctionArguments* a) {
  const PointSearch& search = *static_cast<const PointSearch*>(a->userPtr);
  const uint32_t instance =
      a->context->instStackSize > 0 ? a->context->instID[0] : RTC_INVALID_GEOMETRY_ID;
  if (!search.accel->updateNearest(find(*search.level->scene, instance, a->geomID, a->primID),
                                   search.place, *search.best))
    return false;
  const double reach = search.best->distance * search.accel->scale_ * (1 + 1e-6);
  if (!(reach < a->query->radius)) return false;
  a->query->radius = float(reach);
  return true;
}

// Computes the closest point of a primitive. Updates `best` and returns true if it is closer.
bool Accel::updateNearest(const PrimitiveId& found, const Vec3d& p, Nearest& best) const {
  const Record& r = records[found.record];
  Vec3d at, normal;
  double u = 0, v = 0;
  if (r.primitive == edit::Primitive::Sphere) {
    const Vec3d s =
        closestOnEllipsoid(r.frames->toRender, p - Vec3d(r.frames->toRender.translation()));
    at = r.frames->toRender.point(s);
    normal = r.frames->fromRender.transposed(s);
  } else if (r.primitive == edit::Primitive::Triangles) {
    Vec3d corner[3];
    for (int k = 0; k < 3; k++) corner[k] = Vec3d(r.corner(found.primitive, k));
    normal = cross(corner[1] - corner[0], corner[2] - corner[0]); // in the kernel's frame
    if (r.instanced) normal = r.frames->kernelNormal * normal;
    if (r.flip) normal = -normal;
    for (Vec3d& c : corner) c = r.placeOf(c);
    const Weights w = closestOnTriangle(p, corner[0], corner[1], corner[2]);
    at = corner[0] * w[0] + corner[1] * w[1] + corner[2] * w[2];
    u = w[1];
    v = w[2];
  } else {
    return false;
  }
  const double distance = length(at - p);
  if (!(distance <= best.distance)) return false;
  if (distance == best.distance &&
      std::tuple(found.record, found.primitive) >= std::tuple(best.record, best.primitive))
    return false;
  const double l = length(normal);
  normal = l > 0 ? normal * (1 / l) : Vec3d{};
  best = {found.record, found.primitive, distance, at, normal, u, v};
  return true;
}

bool Accel::nearest(const Vec3d& place, double distance, std::span<const uint32_t> round,
                    Nearest& out) const {
  const Vec3f p(place * double(scale_));
  if (!isFinite(p) || largest(abs(p)) > 1e18f || !(distance > 0)) return false;
  out = {};
  out.distance = distance;
  for (const Level* level : {&staticLevel_, &topLevel_}) {
    if (!level->masks) continue;
    PointSearch search{this, level, place, &out};
    RTCPointQuery query;
    query.x = p.x;
    query.y = p.y;
    query.z = p.z;
    query.time = 0;
    query.radius = float(std::min(out.distance * scale_ * (1 + 1e-6),
                                  double(std::numeric_limits<float>::infinity())));
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(level->scene->scene, &query, &context, visitNear, &search);
  }
  for (const uint32_t record : round)
    // Embree has no point queries for spheres.
    updateNearest({record, 0}, place, out);
  return out.record != noHit;
}

} // namespace openrt
