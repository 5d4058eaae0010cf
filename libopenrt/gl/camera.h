// camera.h: finds the camera that sees as a projection matrix of OpenGL does.
#pragma once

#include "gl/matrix.h"

namespace rtgl {

// A camera of OpenRT whose view is 2 high: at distance 1 if perspective, else everywhere.
struct Camera {
  bool perspective = false;
  Matrix toWorld = identity;
  bool operator==(const Camera&) const = default;
};

// projection: from eye space, which is the world, to clip coordinates. aspect: width / height of
// the picture. Returns false if the matrix is no projection that a camera has.
bool cameraOf(const Matrix& projection, double aspect, Camera& out);

} // namespace rtgl
