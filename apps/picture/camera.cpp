// camera.cpp: see camera.h.
#include "picture/camera.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace picture {

namespace {

struct Vec {
  double x, y, z;
};
Vec cross(Vec a, Vec b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
double length(Vec a) { return std::hypot(a.x, a.y, a.z); }
Vec divided(Vec a, double s) { return {a.x / s, a.y / s, a.z / s}; }

// The axis that is farthest from the direction v.
Vec acrossAxis(Vec v) {
  const double x = std::abs(v.x), y = std::abs(v.y), z = std::abs(v.z);
  if (x <= y && x <= z) return {1, 0, 0};
  return y <= z ? Vec{0, 1, 0} : Vec{0, 0, 1};
}

} // namespace

bool lookAtMatrix(const LookAt& view, double matrix[16]) {
  const double* p = view.position;
  Vec back{p[0] - view.target[0], p[1] - view.target[1], p[2] - view.target[2]};
  const double distance = length(back);
  if (!(distance > 0) || !std::isfinite(distance)) return false;
  back = divided(back, distance);
  Vec up{view.up[0], view.up[1], view.up[2]};
  up = length(up) > 0 ? divided(up, length(up)) : Vec{0, 1, 0};
  Vec right = cross(up, back);
  if (length(right) < 1e-9) right = cross(acrossAxis(back), back);
  right = divided(right, length(right));
  up = cross(back, right);
  const double columns[16] = {right.x, right.y, right.z, 0, up.x, up.y, up.z, 0, back.x, back.y, back.z, 0, p[0], p[1], p[2], 1};
  std::copy_n(columns, 16, matrix);
  return true;
}

double verticalAngle(double smaller, double aspect) {
  return aspect >= 1 ? smaller : 2 * std::atan(std::tan(smaller / 2) / aspect);
}

namespace {

// Turns a camera and its place about the vertical axis through the middle of the bounds.
void turn(xvrml::CameraSettings& camera, const xvrml::Bounds& bounds, double angle) {
  if (angle == 0) return;
  const double cx = bounds.empty ? 0 : (bounds.minimum[0] + bounds.maximum[0]) / 2;
  const double cz = bounds.empty ? 0 : (bounds.minimum[2] + bounds.maximum[2]) / 2;
  const double c = std::cos(angle), s = std::sin(angle);
  for (size_t column = 0; column < 4; ++column) {
    double* v = camera.matrix + 4 * column;
    const double x = v[0] - (column == 3 ? cx : 0), z = v[2] - (column == 3 ? cz : 0);
    v[0] = c * x + s * z + (column == 3 ? cx : 0);
    v[2] = -s * x + c * z + (column == 3 ? cz : 0);
  }
}

} // namespace

xvrml::CameraSettings chooseCamera(const xvrml::OpenRTMapper& mapper, const View& view, double aspect) {
  constexpr double radians = std::numbers::pi / 180;
  const double smaller = view.fov ? *view.fov * radians : std::numbers::pi / 4; // a Viewpoint's default
  const double fovy = verticalAngle(smaller, aspect);
  xvrml::CameraSettings camera;
  if (view.lookAt) {
    lookAtMatrix(*view.lookAt, camera.matrix);
    camera.fovy = fovy;
  } else if (view.viewer && !view.viewpoint && !view.fit) {
    camera = *view.viewer;
    if (view.fov) camera.fovy = fovy;
  } else if (view.viewpoint || (!view.fit && mapper.boundViewpoint() >= 0)) {
    camera = mapper.viewpointCamera(view.viewpoint.value_or(size_t(std::max(0, mapper.boundViewpoint()))));
    if (view.fov) camera.fovy = fovy;
  } else {
    camera = mapper.fitCamera(fovy);
  }
  turn(camera, mapper.bounds(), view.turn);
  if (view.shader) camera.shader = view.shader.get();
  return camera;
}

} // namespace picture
