#include "render/lights/sampled_points.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scene/analytic.h"

namespace openrt {
namespace {

// Bound of n roundings, each half a unit in the last place of a float.
constexpr double roundings(int n) { return n * 0x1p-24; }

double distanceBetween(const Vec3f& a, const Vec3f& b) { return length(Vec3d(a) - Vec3d(b)); }

// The edges from the first corner of a triangle, and their cross product.
struct Edges {
  Vec3d a, b, normal;
  explicit Edges(const EmissiveShapes::Shape& s)
      : a(Vec3d(s.corner[1]) - Vec3d(s.corner[0])), b(Vec3d(s.corner[2]) - Vec3d(s.corner[0])),
        normal(cross(a, b)) {}
};

double cosineOf(const Vec3d& normal, const Vec3f& direction) {
  return dot(normal, Vec3d(direction)) / length(normal);
}

// A bound of the distance along the normal by which the surface that the kernel intersects may
// differ from the surface that was sampled, and the cosine there.
struct Rounding {
  double bound, cosine;
};

// The kernel subtracts the origin from the corners first, so its error is relative to the distance
// of the farthest corner. In an instance it also transforms the ray.
Rounding roundingOf(const EmissiveShapes::Shape& s, const Record& r, const Vec3f& direction,
                    const Vec3f& origin) {
  double farthest = 0, coordinates = 0;
  for (const Vec3f& corner : s.corner) {
    farthest = std::max(farthest, distanceBetween(corner, origin));
    coordinates = std::max(coordinates, length(Vec3d(corner)));
  }
  double bound = roundings(24) * farthest;
  if (r.instanced)
    bound += roundings(8) * (coordinates + length(Vec3d(origin)) +
                             length(Vec3d(r.frames->toRender.translation())));
  return {bound, std::fabs(cosineOf(Edges(s).normal, direction))};
}

// The centre of a sphere and both of its maps are rounded relative to their coordinates.
Rounding roundingOfSphere(const Record& r, const Vec3f& direction, const Vec3f& origin,
                          double distance) {
  const Vec3f center = r.frames->toRender.translation();
  const Vec3d local =
      r.frames->fromRender.pointFromTranslation(Vec3d(origin) + distance * Vec3d(direction));
  const double size = std::sqrt(squaredNormOf(r.frames->toRender));
  return {roundings(24) * (distanceBetween(center, origin) + size) +
              roundings(8) * (length(Vec3d(center)) + length(Vec3d(origin))),
          std::fabs(cosineOf(r.frames->fromRender.transposed(local), direction))};
}

// As for a sphere, whose normal is another.
Rounding roundingOfSurface(const Record& r, const Vec3f& direction, const Vec3f& origin,
                           double distance) {
  const AnalyticSurface& surface = *r.surface;
  const Vec3d center = r.frames->toRender.point((surface.low() + surface.high()) / 2),
              local = r.frames->fromRender.pointFromTranslation(Vec3d(origin) +
                                                                distance * Vec3d(direction));
  const double size =
      std::sqrt(squaredNormOf(r.frames->toRender)) * length(surface.high() - surface.low());
  Vec3d gradient;
  surface.valueAt(local, gradient);
  return {roundings(24) * (length(center - Vec3d(origin)) + size) +
              roundings(8) * (length(center) + length(Vec3d(origin))),
          std::fabs(cosineOf(r.frames->fromRender.transposed(gradient), direction))};
}

} // namespace

float shadowRayEnd(const RenderScene& scene, const LightSample& sample, const Vec3f& eye,
                   const Vec3f& origin) {
  if (sample.shape == EmissiveShapes::none) return std::numeric_limits<float>::infinity();
  const EmissiveShapes::Shape& s = (*scene.emitters->shapes())[sample.shape];
  const Record& r = scene.records[s.record];
  const double distance = sample.distance;
  const Rounding rounding = s.sphere    ? roundingOfSphere(r, sample.direction, origin, distance)
                            : s.surface ? roundingOfSurface(r, sample.direction, origin, distance)
                                        : roundingOf(s, r, sample.direction, origin);
  // An error along the normal, or across the direction, moves the intersection by at most this.
  const double error =
      (rounding.bound + distanceBetween(eye, origin)) / rounding.cosine + roundings(8) * distance;
  return float(distance - std::min(distance * 0x1p-10, error)); // 2^-10 also if error is NaN
}

const Vec3f* uniformRadiance(const EmissiveShapes::Shape& s, const Vec3f& direction) {
  if (!s.uniform) return nullptr;
  if (s.sphere || s.sides == 1) return &s.radiance[0];
  if (s.surface) // the side depends on the point
    return s.sides == 2                     ? &s.radiance[1]
           : s.radiance[0] == s.radiance[1] ? &s.radiance[0]
                                            : nullptr;
  return &s.radiance[s.sides == 2 || cosineOf(Edges(s).normal, direction) > 0 ? 1 : 0];
}

void writeSampledHit(const RenderScene& scene, const LightSample& sample, const Rays& rays,
                     uint32_t lane, RayHits& hits) {
  const EmissiveShapes::Shape& s = (*scene.emitters->shapes())[sample.shape];
  hits.record[lane] = s.record;
  hits.primitive[lane] = s.primitive;
  hits.t[lane] = sample.distance;
  hits.u[lane] = hits.v[lane] = 0;
  if (s.curved()) { // makePoints() finds everything from the position
    store(-load(rays.dir, lane), hits.ng, lane);
    return;
  }
  const Edges edges(s);
  const Vec3d origin(load(rays.org, lane)), direction(load(rays.dir, lane));
  const Vec3d place = origin + double(sample.distance) * direction - Vec3d(s.corner[0]);
  const double u = dot(cross(place, edges.b), edges.normal),
               v = dot(cross(edges.a, place), edges.normal),
               square = dot(edges.normal, edges.normal);
  const float across = float(std::clamp(u / square, 0.0, 1.0)),
              along = std::clamp(float(v / square), 0.0f, 1 - across);
  hits.u[lane] = s.swapped ? along : across;
  hits.v[lane] = s.swapped ? across : along;
  const Vec3f normal(edges.normal / std::sqrt(square));
  store(kernelNormal(scene.records[s.record], normal), hits.ng, lane);
}

} // namespace openrt
