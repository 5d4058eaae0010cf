#include "render/path/sensor_plane.h"

#include <cmath>

#include "render/path/camera_rays.h"
#include "render/render_scene.h"

namespace openrt {
namespace {

// How far rays may be from parallel, and their origins from a plane across them: more than the
// rounding of floats, less than anybody would want.
constexpr double straight = 1e-4;

bool parallel(const Vec3d& a, const Vec3d& b) {
  return length(cross(a, b)) <= straight * length(a) * length(b);
}

} // namespace

std::optional<SensorPlane> SensorPlane::of(const RenderScene& scene) {
  const RtsClass* camera = scene.camera.shader.shaderClass;
  if (!camera || !camera->generate) return {};
  Arena arena;
  RayCounters counters;
  Rays rays;
  constexpr uint32_t corners = 4; // the film's: upper left, upper right, lower left, lower right
  rays.allocate(arena, corners);
  rays.count = corners;
  const auto width = float(scene.frame.width), height = float(scene.frame.height);
  const float at[2][corners] = {{0, width, 0, width}, {0, 0, height, height}};
  float* xy[2];
  for (int k = 0; k < 2; k++) {
    xy[k] = arena.take<float>(padded(corners));
    for (uint32_t i = 0; i < padded(corners); i++) xy[k][i] = at[k][i % corners];
  }
  makeCameraRays(StageContext{scene, arena, counters}, xy, rays);
  Vec3d origin[corners];
  const Vec3d normal(load(rays.dir, 0));
  for (uint32_t i = 0; i < corners; i++) {
    origin[i] = Vec3d(load(rays.org, i));
    if (!isFinite(load(rays.org, i)) || !(length(Vec3d(load(rays.dir, i)) - normal) <= straight))
      return {};
  }
  const Vec3d across = origin[1] - origin[0], down = origin[2] - origin[0],
              areaNormal = cross(across, down);
  const double area = length(areaNormal);
  if (!(area > straight * length(across) * length(down)) || !parallel(areaNormal, normal) ||
      !(length(origin[3] - origin[2] - across) <= straight * (length(across) + length(down))))
    return {};
  SensorPlane plane;
  plane.corner_ = origin[0];
  plane.normal_ = normal;
  plane.columns_ = scene.frame.width;
  plane.rows_ = scene.frame.height;
  plane.cellArea_ = area / (double(plane.columns_) * plane.rows_);
  // The dual basis of the two edges in their plane.
  const double square = area * area;
  plane.toColumn_ = cross(down, areaNormal) * (plane.columns_ / square);
  plane.toRow_ = cross(areaNormal, across) * (plane.rows_ / square);
  return plane;
}

std::optional<SensorPlane::Crossing> SensorPlane::crossing(const Vec3f& origin,
                                                           const Vec3f& direction) const {
  const Vec3d from(origin), along(direction);
  const double towards = dot(along, normal_), distance = dot(corner_ - from, normal_) / towards;
  if (!(towards < 0) || !(distance > 0)) return {};
  const Vec3d place = from + along * distance - corner_;
  const double column = dot(place, toColumn_), row = dot(place, toRow_);
  if (!(column >= 0 && column < columns_ && row >= 0 && row < rows_)) return {};
  return Crossing{uint32_t(row) * columns_ + uint32_t(column), distance};
}

} // namespace openrt
