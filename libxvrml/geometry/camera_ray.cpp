// camera_ray.cpp: rays of the built-in camera, and where points appear.
#include <cmath>

#include "xvrml/camera.h"

namespace xvrml {
namespace {

// Returns half the height of the picture: at distance 1, or of a parallel one.
double halfHeight(const CameraSettings& camera) {
  return camera.fovy > 0 ? std::tan(camera.fovy / 2) : camera.height / 2;
}

} // namespace

CameraRay rayThrough(const CameraSettings& camera, double aspect, double x, double y) {
  const double* const m = camera.matrix;
  const double across = x * halfHeight(camera) * aspect, along = y * halfHeight(camera);
  CameraRay ray;
  for (int i = 0; i < 3; ++i) {
    const double aside = m[i] * across + m[4 + i] * along;
    ray.origin[i] = m[12 + i] + (camera.fovy > 0 ? 0 : aside);
    ray.direction[i] = -m[8 + i] + (camera.fovy > 0 ? aside : 0);
  }
  return ray;
}

bool projectPoint(const CameraSettings& camera, double aspect, const double point[3], double& x,
                  double& y) {
  const double* const m = camera.matrix;
  double own[3]; // the point in the coordinate system of the camera
  for (int axis = 0; axis < 3; ++axis) {
    own[axis] = 0;
    for (int i = 0; i < 3; ++i) own[axis] += m[4 * axis + i] * (point[i] - m[12 + i]);
  }
  if (!(own[2] < 0)) return false;
  const double size = halfHeight(camera) * (camera.fovy > 0 ? -own[2] : 1);
  x = own[0] / (size * aspect);
  y = own[1] / size;
  return std::isfinite(x) && std::isfinite(y);
}

} // namespace xvrml
