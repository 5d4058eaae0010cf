#include "render/motion.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace openrt {
namespace {

// Returns the motion of a record that has moved; null if it rests or is new.
const Motion* movedRecord(const RenderScene& scene, uint32_t record) {
  if (!scene.motions) return nullptr;
  const uint32_t kind = scene.motions->kindOf(record);
  return kind < Motions::firstMoved ? nullptr : &scene.motions->moved[kind - Motions::firstMoved];
}

Vec3d vertex(const Array& points, uint32_t index) {
  return Vec3d(vectorOf(points.as<float>() + 3 * size_t(index)));
}

// Returns the point of a mesh that was hit, in the frame of its geometry.
Vec3d pointOfMesh(const Record& r, const RayHits& hits, uint32_t lane, const Array& points) {
  const size_t primitive = hits.primitive[lane];
  if (r.primitive == edit::Primitive::Points) return vertex(points, r.indices[primitive]);
  if (r.primitive == edit::Primitive::Lines) {
    const uint32_t* end = r.indices + 2 * primitive;
    const double u = std::clamp(double(hits.u[lane]), 0.0, 1.0);
    return (1 - u) * vertex(points, end[0]) + u * vertex(points, end[1]);
  }
  const uint32_t* corner = r.indices + 3 * primitive;
  const double u = hits.u[lane], v = hits.v[lane];
  return (1 - u - v) * vertex(points, corner[0]) + u * vertex(points, corner[1]) +
         v * vertex(points, corner[2]);
}

// Returns the direction of a sphere's point from its centre, in the frame of its geometry.
Vec3d directionOnSphere(const Record& r, const Vec3f& position) {
  return normalize(r.fromRender.point(Vec3d(position)));
}

// Returns the image of a point of the geometry under the difference of the two matrices.
Vec3d change(const Motion& m, const Vec3d& point) {
  Vec3d sum = m.now.translation() - m.before.translation();
  for (int i = 0; i < 3; i++) sum += (m.now.column(i) - m.before.column(i)) * point[size_t(i)];
  return sum;
}

Plane planeOf(const Vec3d (&corner)[3]) {
  return {corner[0], normalize(cross(corner[1] - corner[0], corner[2] - corner[0]))};
}

} // namespace

Vec3d motionOf(const RenderScene& scene, const RayHits& hits, uint32_t lane,
               const Vec3f& position) {
  const uint32_t record = hits.record[lane];
  if (!scene.motions || scene.motions->kindOf(record) == Motions::resting) return {};
  const Motion* m = movedRecord(scene, record);
  if (!m) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    return {nan, nan, nan};
  }
  const Record& r = scene.records[record];
  if (r.primitive == edit::Primitive::Sphere) {
    const Vec3d direction = directionOnSphere(r, position);
    return change(*m, direction * double(m->radius)) +
           m->before.direction(direction * (double(m->radius) - double(m->radiusBefore)));
  }
  const Vec3d point = pointOfMesh(r, hits, lane, *m->points);
  if (!m->pointsBefore) return change(*m, point);
  const Vec3d before = pointOfMesh(r, hits, lane, *m->pointsBefore);
  return change(*m, point) + m->before.direction(point - before);
}

bool movedPlane(const RenderScene& scene, const RayHits& hits, uint32_t lane, Plane& now,
                Plane& before) {
  const uint32_t record = hits.record[lane];
  const Motion* m = movedRecord(scene, record);
  const Record& r = scene.records[record];
  if (!m || r.primitive != edit::Primitive::Triangles) return false;
  const Array& pointsBefore = m->pointsBefore ? *m->pointsBefore : *m->points;
  const Vec3d origin = vectorOf(scene.origin);
  const uint32_t* corner = r.indices + 3 * size_t(hits.primitive[lane]);
  Vec3d is[3], was[3];
  for (int k = 0; k < 3; k++) {
    is[k] = m->now.point(vertex(*m->points, corner[k])) - origin;
    was[k] = m->before.point(vertex(pointsBefore, corner[k])) - origin;
  }
  const Plane planes[2] = {planeOf(is), planeOf(was)};
  if (planes[0].normal == Vec3d() || planes[1].normal == Vec3d()) return false;
  now = planes[0];
  before = planes[1];
  return true;
}

} // namespace openrt
