// camera.cpp: Takes a projection matrix apart. The rays of a picture start on the near plane and
// meet in the eye, or are parallel. Asymmetric frusta become cameras whose matrix shears.
#include "gl/camera.h"

#include <cmath>

namespace rtgl {

bool cameraOf(const Matrix& projection, double aspect, Camera& out) {
  Matrix back;
  if (!finite(projection) || !invert(projection, back)) return false;
  const Vector middle = project(back, {0, 0, -1}), right = project(back, {1, 0, -1}),
               top = project(back, {0, 1, -1}), far = project(back, {0, 0, 1});
  // The eye is the point that the projection sends to infinity along its z axis.
  const std::array<double, 4> eye = transform(back, {0, 0, 1, 0});
  const double size = length({eye[0], eye[1], eye[2]});
  out.perspective = std::abs(eye[3]) > 1e-9 * size;
  Vector x = (1 / aspect) * (right - middle), y = top - middle, z, origin;
  if (out.perspective) {
    origin = {eye[0] / eye[3], eye[1] / eye[3], eye[2] / eye[3]};
    z = origin - middle;
    const double scale = 1 / length(z);
    x = scale * x;
    y = scale * y;
    z = scale * z;
  } else {
    origin = middle;
    z = unit(middle - far);
  }
  out.toWorld = {x[0], x[1], x[2], 0, y[0],      y[1],      y[2],      0,
                 z[0], z[1], z[2], 0, origin[0], origin[1], origin[2], 1};
  return finite(out.toWorld);
}

} // namespace rtgl
