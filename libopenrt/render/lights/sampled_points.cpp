#include "render/lights/sampled_points.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace openrt {
namespace {

// Bound of n roundings, each half a unit in the last place of a float.
constexpr double roundings(int n) { return n * 0x1p-24; }

double lengthOf(const double v[3]) { return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }
double lengthOf(const float v[3]) {
  const double d[3] = {v[0], v[1], v[2]};
  return lengthOf(d);
}
double distanceBetween(const float a[3], const float b[3]) {
  const double d[3] = {double(a[0]) - b[0], double(a[1]) - b[1], double(a[2]) - b[2]};
  return lengthOf(d);
}

void cross(const double a[3], const double b[3], double out[3]) {
  out[0] = a[1] * b[2] - a[2] * b[1];
  out[1] = a[2] * b[0] - a[0] * b[2];
  out[2] = a[0] * b[1] - a[1] * b[0];
}

// The edges from the first corner of a triangle, and their cross product.
struct Edges {
  double a[3], b[3], normal[3];
  explicit Edges(const EmissiveShapes::Shape& s) {
    for (int k = 0; k < 3; k++) {
      a[k] = double(s.corner[1][k]) - s.corner[0][k];
      b[k] = double(s.corner[2][k]) - s.corner[0][k];
    }
    cross(a, b, normal);
  }
};

double cosineOf(const double normal[3], const float direction[3]) {
  double along = 0;
  for (int k = 0; k < 3; k++) along += normal[k] * direction[k];
  return along / lengthOf(normal);
}

// A bound of the distance along the normal by which the surface that the kernel intersects may
// differ from the surface that was sampled, and the cosine there.
struct Rounding {
  double bound, cosine;
};

// The kernel subtracts the origin from the corners first, so its error is relative to the distance
// of the farthest corner. In an instance it also transforms the ray.
Rounding roundingOf(const EmissiveShapes::Shape& s, const Record& r, const float direction[3],
                    const float origin[3]) {
  double farthest = 0, coordinates = 0;
  for (const auto& corner : s.corner) {
    farthest = std::max(farthest, distanceBetween(corner, origin));
    coordinates = std::max(coordinates, lengthOf(corner));
  }
  double bound = roundings(24) * farthest;
  if (r.instanced) {
    const float translation[3] = {r.toRender.r[0][3], r.toRender.r[1][3], r.toRender.r[2][3]};
    bound += roundings(8) * (coordinates + lengthOf(origin) + lengthOf(translation));
  }
  return {bound, std::fabs(cosineOf(Edges(s).normal, direction))};
}

// The centre of a sphere and both of its maps are rounded relative to their coordinates.
Rounding roundingOfSphere(const Record& r, const float direction[3], const float origin[3],
                          double distance) {
  const auto& m = r.toRender.r;
  const float centre[3] = {m[0][3], m[1][3], m[2][3]};
  double local[3], normal[3] = {0, 0, 0}, square = 0;
  for (int i = 0; i < 3; i++) {
    local[i] = r.fromRender.r[i][3];
    for (int k = 0; k < 3; k++) {
      local[i] += r.fromRender.r[i][k] * (origin[k] + distance * direction[k]);
      square += double(m[i][k]) * m[i][k];
    }
  }
  for (int k = 0; k < 3; k++) // normals are transformed by the inverse transpose
    for (int i = 0; i < 3; i++) normal[k] += r.fromRender.r[i][k] * local[i];
  return {roundings(24) * (distanceBetween(centre, origin) + std::sqrt(square)) +
              roundings(8) * (lengthOf(centre) + lengthOf(origin)),
          std::fabs(cosineOf(normal, direction))};
}

} // namespace

float shadowRayEnd(const RenderScene& scene, const LightSample& sample, const float eye[3],
                   const float origin[3]) {
  if (sample.shape == EmissiveShapes::none) return std::numeric_limits<float>::infinity();
  const EmissiveShapes::Shape& s = (*scene.emitters.shapes())[sample.shape];
  const Record& r = scene.records[s.record];
  const double distance = sample.distance;
  const Rounding rounding = s.sphere ? roundingOfSphere(r, sample.direction, origin, distance)
                                     : roundingOf(s, r, sample.direction, origin);
  // An error along the normal, or across the direction, moves the intersection by at most this.
  const double error =
      (rounding.bound + distanceBetween(eye, origin)) / rounding.cosine + roundings(8) * distance;
  return float(distance - std::min(distance * 0x1p-10, error)); // 2^-10 also if error is NaN
}

const float* uniformRadiance(const EmissiveShapes::Shape& s, const float direction[3]) {
  if (!s.uniform) return nullptr;
  if (s.sphere || s.sides == 1) return s.radiance[0];
  return s.radiance[s.sides == 2 || cosineOf(Edges(s).normal, direction) > 0 ? 1 : 0];
}

void writeSampledHit(const RenderScene& scene, const LightSample& sample, const Rays& rays,
                     uint32_t lane, RayHits& hits) {
  const EmissiveShapes::Shape& s = (*scene.emitters.shapes())[sample.shape];
  hits.record[lane] = s.record;
  hits.primitive[lane] = s.primitive;
  hits.t[lane] = sample.distance;
  hits.u[lane] = hits.v[lane] = 0;
  if (s.sphere) { // makePoints() finds everything from the position
    for (int k = 0; k < 3; k++) hits.ng[k][lane] = -rays.dir[k][lane];
    return;
  }
  const Edges edges(s);
  double place[3], first[3], second[3], u = 0, v = 0, square = 0;
  for (int k = 0; k < 3; k++)
    place[k] =
        double(rays.org[k][lane]) + double(sample.distance) * rays.dir[k][lane] - s.corner[0][k];
  cross(place, edges.b, first);
  cross(edges.a, place, second);
  for (int k = 0; k < 3; k++) {
    u += first[k] * edges.normal[k];
    v += second[k] * edges.normal[k];
    square += edges.normal[k] * edges.normal[k];
  }
  const float across = float(std::clamp(u / square, 0.0, 1.0)),
              along = std::clamp(float(v / square), 0.0f, 1 - across);
  hits.u[lane] = s.swapped ? along : across;
  hits.v[lane] = s.swapped ? across : along;
  float normal[3], kernel[3];
  for (int k = 0; k < 3; k++) normal[k] = float(edges.normal[k] / std::sqrt(square));
  kernelNormal(scene.records[s.record], normal, kernel);
  for (int k = 0; k < 3; k++) hits.ng[k][lane] = kernel[k];
}

} // namespace openrt
