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
  return normalize(r.frames->fromRender.point(Vec3d(position)));
}

// Returns the image of a point of the geometry under the difference of the two matrices.
Vec3d change(const Motion& m, const Vec3d& point) {
  Vec3d sum = m.now.translation() - m.before.translation();
  for (int i = 0; i < 3; i++) sum += (m.now.column(i) - m.before.column(i)) * point[size_t(i)];
  return sum;
}

// Returns the length of the first axis: the scale of a map that scales all directions equally.
double scaleOf(const Matrix4d& m) { return length(m.column(0)); }

// Returns whether the shading normals of the triangle that was hit are the same everywhere.
bool isFlat(const Record& r, uint32_t triangle) {
  if (r.primitive != edit::Primitive::Triangles) return false;
  if (!r.normals) return true;
  const uint32_t* corner = r.indices + 3 * size_t(triangle);
  const auto normal = [&](int k) { return vectorOf(r.normals + 3 * size_t(corner[k])); };
  return normal(0) == normal(1) && normal(0) == normal(2);
}

// Returns the plane of a triangle. Its normal is 0 if the corners lie on a line.
Plane planeOf(const Matrix4d& toWorld, const Array& points, const uint32_t* corner,
              const Vec3d& origin) {
  Vec3d at[3];
  for (int k = 0; k < 3; k++) at[k] = toWorld.point(vertex(points, corner[k])) - origin;
  return {at[0], normalize(cross(at[1] - at[0], at[2] - at[0]))};
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
  if (r.surface) return change(*m, r.frames->fromRender.point(Vec3d(position)));
  const Vec3d point = pointOfMesh(r, hits, lane, *m->points);
  if (!m->pointsBefore) return change(*m, point);
  const Vec3d before = pointOfMesh(r, hits, lane, *m->pointsBefore);
  return change(*m, point) + m->before.direction(point - before);
}

bool findMirrorPlanes(const RenderScene& scene, const RayHits& hits, uint32_t lane, Plane& now,
                      Plane& before) {
  const uint32_t record = hits.record[lane];
  const uint32_t kind = scene.motions ? scene.motions->kindOf(record) : Motions::resting;
  if (kind == Motions::isNew) return false;
  before = now;
  if (kind == Motions::resting) return true;
  const Motion& m = *movedRecord(scene, record);
  const Record& r = scene.records[record];
  if (r.primitive == edit::Primitive::Sphere) {
    const double growth =
        double(m.radius) * scaleOf(m.now) - double(m.radiusBefore) * scaleOf(m.before);
    before.point -= change(m, {}) + now.normal * growth;
    return true;
  }
  if (isFlat(r, hits.primitive[lane])) {
    const uint32_t* corner = r.indices + 3 * size_t(hits.primitive[lane]);
    const Vec3d origin = vectorOf(scene.origin);
    const Array& points = m.pointsBefore ? *m.pointsBefore : *m.points;
    const Plane is = planeOf(m.now, *m.points, corner, origin),
                was = planeOf(m.before, points, corner, origin);
    if (is.normal != Vec3d() && was.normal != Vec3d()) {
      now = is;
      before = was;
      return true;
    }
  }
  before.point -= motionOf(scene, hits, lane, Vec3f(now.point));
  return true;
}

} // namespace openrt
