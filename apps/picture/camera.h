// camera.h: where a picture is taken from: a viewpoint of the world, a camera given by hand, or one fitted to the world.
// [any thread]
#pragma once

#include <optional>
#include <string>

#include "xvrml/openrt.h"

namespace picture {

struct LookAt {
  double position[3], target[3], up[3] = {0, 1, 0};
};

// What to look from. At most one of viewpoint, lookAt and fit is asked for; none: the world's first Viewpoint, or a fitted
// camera in a world without one.
struct View {
  std::optional<size_t> viewpoint; // index into OpenRTMapper::viewpoints()
  std::optional<LookAt> lookAt;
  bool fit = false;
  std::optional<xvrml::CameraSettings> viewer; // of a running world: instead of the first Viewpoint
  double turn = 0;           // radians about the vertical axis through the world's centre, counter-clockwise seen from above
  xvrml::NodeRef shader;     // an ORTShader that makes the rays, instead of the viewpoint's own
  std::optional<double> fov; // degrees; the smaller of the two angles of view, as a Viewpoint's fieldOfView
};

// False where position and target coincide; an up vector along the view is replaced by one across it.
bool lookAtMatrix(const LookAt& view, double matrix[16]);

// The vertical angle for the smaller of both angles (clause 6.53), radians.
double verticalAngle(double smaller, double aspect);

xvrml::CameraSettings chooseCamera(const xvrml::OpenRTMapper& mapper, const View& view, double aspect);

} // namespace picture
