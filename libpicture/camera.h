// camera.h: where a picture is taken from: a viewpoint of the world, a camera given by hand, or one
// fitted to the world. [any thread]
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "xvrml/mapper.h"

namespace picture {

struct LookAt {
  double position[3], target[3], up[3] = {0, 1, 0};
  bool saysUp = false; // else the view's up, where it has one
};

// What to look from. At most one of viewpoint, lookAt and fit is asked for, or lookAt and fit
// together: the direction of the one, and as far away as everything is in the picture. None: the
// world's first Viewpoint. In a world without one, and with an up axis that is given, fit and none
// look at the model from three quarters (docs/decisions/0040-models.md).
struct View {
  // A camera by its matrices, instead of all below but the shader. sheared: camera to world, with
  // what a principal point that is not in the middle and pixels that are not square do to the rays
  // of the angle fovy (radians, vertical).
  struct Pinhole {
    double matrix[16], sheared[16], fovy;
  };
  std::optional<Pinhole> pinhole;
  std::optional<size_t> viewpoint; // index into OpenRTMapper::viewpoints()
  std::optional<LookAt> lookAt;
  bool fit = false;
  std::optional<xvrml::CameraSettings> viewer; // of a running world: instead of the first Viewpoint
  std::optional<xvrml::Axis> up; // none: y where a Viewpoint is bound, else what the world suggests
  double turn =
      0; // radians about the up axis through the world's centre, counter-clockwise seen from above
  xvrml::NodeRef shader; // an ORTShader that makes the rays, instead of the viewpoint's own
  std::optional<double>
      fov; // degrees; the smaller of the two angles of view, as a Viewpoint's fieldOfView
};

// False where position and target coincide; an up vector along the view is replaced by one across
// it.
bool lookAtMatrix(const LookAt& view, double matrix[16]);

// The same with the up axis of the view; false without lookAt too.
bool lookAtMatrix(const View& view, double matrix[16]);

// "x", "-y", "+z" ..., and the other way round; nothing for another name.
std::optional<xvrml::Axis> axisNamed(std::string_view name);
const char* axisName(xvrml::Axis axis);

// The vertical angle for the smaller of both angles (clause 6.53), radians.
double verticalAngle(double smaller, double aspect);

// Which axis is up for a view: as it says, else y where a Viewpoint is bound, else what the world
// suggests.
xvrml::Axis upOf(const xvrml::OpenRTMapper& mapper, const View& view);

xvrml::CameraSettings chooseCamera(const xvrml::OpenRTMapper& mapper, const View& view,
                                   double aspect);

} // namespace picture
