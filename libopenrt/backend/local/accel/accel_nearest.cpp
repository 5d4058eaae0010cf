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
Vec3d closestOnEllipsoid(const Affine& map, const double p[3]) {
  double g[3][3], v[3][3], b[3], y[3];
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      g[i][j] = 0;
      for (int k = 0; k < 3; k++) g[i][j] += double(map.r[k][i]) * map.r[k][j];
    }
  eigen(g, v);
  double length = 0;
  for (int i = 0; i < 3; i++) {
    b[i] = 0;
    for (int j = 0; j < 3; j++)
      for (int k = 0; k < 3; k++) b[i] += v[j][i] * double(map.r[k][j]) * p[k];
    length += b[i] * b[i];
  }
  length = std::sqrt(length);
  const int smallest = g[0][0] <= g[1][1] && g[0][0] <= g[2][2] ? 0 : g[1][1] <= g[2][2] ? 1 : 2;
  const double floor = -g[smallest][smallest];
  const auto square = [&](double l) {
    double sum = 0;
    for (int i = 0; i < 3; i++) {
      y[i] = b[i] == 0 ? 0 : b[i] / (g[i][i] + l);
      sum += y[i] * y[i];
    }
    return sum;
  };
  double low = floor, high = floor + length;
  for (int i = 0; i < 100 && low < high; i++) {
    const double middle = low + (high - low) / 2;
    if (middle == low || middle == high) break;
    (square(middle) > 1 ? low : high) = middle;
  }
  const double sum = high > floor ? square(high) : 0;
  if (high == floor) y[0] = y[1] = y[2] = 0;
  if (sum < 1) { // p is in a plane of symmetry: points on both sides of it are equally close
    const double rest = std::sqrt(std::max(0.0, 1 - sum + y[smallest] * y[smallest]));
    y[smallest] = std::copysign(rest, y[smallest]);
  }
  Vec3d s;
  for (int i = 0; i < 3; i++) s = s + Vec3d{v[0][i], v[1][i], v[2][i]} * y[i];
  return s * (1 / openrt::length(s));
}

Vec3d moved(const Affine& m, const Vec3d& p) {
  const double v[3] = {p.x, p.y, p.z};
  double out[3];
  for (int i = 0; i < 3; i++)
    out[i] = m.r[i][0] * v[0] + m.r[i][1] * v[1] + m.r[i][2] * v[2] + m.r[i][3];
  return {out[0], out[1], out[2]};
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
    const double from[3] = {p.x - r.toRender.r[0][3], p.y - r.toRender.r[1][3],
                            p.z - r.toRender.r[2][3]};
    const Vec3d s = closestOnEllipsoid(r.toRender, from);
    at = moved(r.toRender, s);
    const double n[3] = {s.x, s.y, s.z};
    double out[3] = {};
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++) out[i] += double(r.fromRender.r[j][i]) * n[j];
    normal = {out[0], out[1], out[2]};
  } else if (r.primitive == edit::Primitive::Triangles) {
    Vec3d corner[3];
    for (int k = 0; k < 3; k++) {
      const float* vertex =
          r.vertices + 3 * size_t(r.indices[3 * size_t(found.primitive) + size_t(k)]);
      corner[k] = {vertex[0], vertex[1], vertex[2]};
    }
    normal = cross(corner[1] - corner[0], corner[2] - corner[0]); // in the kernel's frame
    if (r.instanced) {
      const auto& n = r.kernelNormal;
      normal = {n[0][0] * normal.x + n[0][1] * normal.y + n[0][2] * normal.z,
                n[1][0] * normal.x + n[1][1] * normal.y + n[1][2] * normal.z,
                n[2][0] * normal.x + n[2][1] * normal.y + n[2][2] * normal.z};
    }
    if (r.flip) normal = normal * -1;
    for (Vec3d& c : corner) c = r.instanced ? moved(r.toRender, c) : c * double(r.scale);
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
  best = {found.record,
          found.primitive,
          distance,
          {at.x, at.y, at.z},
          {normal.x, normal.y, normal.z},
          u,
          v};
  return true;
}

std::vector<uint32_t> Accel::spheres() const {
  std::vector<uint32_t> out;
  for (size_t c = 0; c < placed_.size(); c++) {
    if (c > 0 && !placed_[c].shown) continue;
    const size_t end = c + 1 < placed_.size() ? placed_[c + 1].firstRecord : records.size();
    for (size_t i = placed_[c].firstRecord; i < end; i++)
      if (records[i].primitive == edit::Primitive::Sphere) out.push_back(uint32_t(i));
  }
  return out;
}

bool Accel::nearest(const double place[3], double distance, std::span<const uint32_t> round,
                    Nearest& out) const {
  const float p[3] = {float(place[0] * scale_), float(place[1] * scale_), float(place[2] * scale_)};
  for (const float c : p)
    if (!(std::fabs(c) <= 1e18f)) return false;
  if (!(distance > 0)) return false;
  out = {};
  out.distance = distance;
  for (const Level* level : {&staticLevel_, &topLevel_}) {
    if (!level->masks) continue;
    PointSearch search{this, level, {place[0], place[1], place[2]}, &out};
    RTCPointQuery query;
    query.x = p[0];
    query.y = p[1];
    query.z = p[2];
    query.time = 0;
    query.radius = float(std::min(out.distance * scale_ * (1 + 1e-6),
                                  double(std::numeric_limits<float>::infinity())));
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(level->scene->scene, &query, &context, visitNear, &search);
  }
  for (const uint32_t record : round)
    // Embree has no point queries for spheres.
    updateNearest({record, 0}, {place[0], place[1], place[2]}, out);
  return out.record != noHit;
}

} // namespace openrt
