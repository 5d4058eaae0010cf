// camera.h: Chooses the camera of a picture: a Viewpoint of the world, a camera given by the user,
// or one that fits the whole world. [any thread]
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "xvrml/mapper.h"

namespace picture {

struct LookAt {
  double position[3], target[3], up[3] = {0, 1, 0};
  bool saysUp = false; // false: the view's up axis, where it has one, replaces `up`
};

// A side that a model is seen from. The front is where an eye stands that has x to its right.
enum class Side : unsigned char {
  threeQuarter, // 35 degrees to the right of the front and 25 above
  above,        // 20 degrees to the right of the front and 50 above
  front,
  back,
  left,
  right,
  top,   // the front is below in the picture
  bottom // the model is turned over about the axis that points from the front to the back
};
// Returns the side with a name such as "three-quarter" or "top". sideName is the inverse;
// sideNames lists all names for messages.
std::optional<Side> sideNamed(std::string_view name);
const char* sideName(Side side);
std::string sideNames();

// The inner geometry of a camera as OpenCV describes it: a point at (x, y, z) of the camera, where
// x points to the right, y down and z forward, appears at (fx x/z + skew y/z + cx, fy y/z + cy), in
// pixels from the left upper corner of the picture. The centre of the first pixel is at (0.5, 0.5).
struct Intrinsics {
  double fx, fy, cx, cy, skew = 0;
};

// Describes where a picture is taken from. The caller sets one of viewpoint, lookAt and fit, or
// lookAt and fit together: the direction of lookAt, at the distance that shows everything. If none
// is set, the camera is the world's first Viewpoint. A world without a Viewpoint but with a given
// up axis shows the model from three quarters, for fit and for none
// (docs/decisions/0040-models.md).
struct View {
  // A camera given by its matrices. It replaces all other members except the shader. `sheared` maps
  // camera to world; it also contains the effect of an off-centre principal point and of non-square
  // pixels on the rays of the angle `fovy` (radians, vertical).
  struct Pinhole {
    double matrix[16], sheared[16], fovy;
  };
  std::optional<Pinhole> pinhole;
  // How the first Viewpoint of the file is used if no other member chooses a view. A camera that a
  // modeller saved by the way may cut off the model (mayLeaveCameraOut in bare_model.h).
  enum class Authored : unsigned char {
    shown,
    unlessCut, // left out if it stands outside of the model and does not see all of it
    leftOut    // the model is shown as if the file had no Viewpoint, at that one's angle of view
  };
  Authored authored = Authored::shown;
  // Replaces the angle of view, and the projection, of the camera that the other members choose.
  std::optional<Intrinsics> intrinsics;
  std::optional<size_t> viewpoint; // index into OpenRTMapper::viewpoints()
  std::optional<LookAt> lookAt;
  bool fit = false;
  // The whole world from this side; it replaces the direction of viewpoint and lookAt.
  std::optional<Side> side;
  // With side or fit, and for models: at such a distance that a full turn stays in the picture.
  bool turns = false;
  // camera of a running world; it replaces the first Viewpoint
  std::optional<xvrml::CameraSettings> viewer;
  // none: y if a Viewpoint is bound, otherwise what the world suggests
  std::optional<xvrml::Axis> up;
  // Radians about the up axis through the world's centre, counter-clockwise seen from above.
  double turn = 0;
  // an ORTShader that generates the camera rays; it replaces the viewpoint's own
  xvrml::NodeRef shader;
  // Degrees, for the smaller of the two angles of view, as in Viewpoint.fieldOfView.
  std::optional<double> fov;
  // The height of a parallel view in world units. It replaces what the other members say about the
  // projection.
  std::optional<double> ortho;
};

// Returns the camera of a pose: a 4x4 matrix from camera to world, by rows, for a camera that looks
// along -z with +y up. Throws std::invalid_argument if it does more than turn and move.
LookAt lookAtOf(const double rows[16]);

// Returns the camera of these intrinsics that stands and looks as `matrix` says: from camera to
// world, by columns, looking along -z with +y up. height: that of the picture, in pixels.
View::Pinhole pinholeOf(const Intrinsics& inner, const double matrix[16], int width, int height);

// Returns false if position and target coincide. Replaces an up vector that is parallel to the view
// direction by a perpendicular one.
bool lookAtMatrix(const LookAt& view, double matrix[16]);

// Does the same with the up axis of the view. Also returns false if the view has no lookAt.
bool lookAtMatrix(const View& view, double matrix[16]);

// Parses "x", "-y", "+z" and so on; axisName is its inverse. Returns nothing for another name.
std::optional<xvrml::Axis> axisNamed(std::string_view name);
const char* axisName(xvrml::Axis axis);

// Returns the vertical angle of view, given the smaller of both angles (clause 6.53), in radians.
double verticalAngle(double smaller, double aspect);

// Returns the up axis for a view: the view's own if it has one, otherwise y if a Viewpoint is
// bound, otherwise what the world suggests.
xvrml::Axis upOf(const xvrml::OpenRTMapper& mapper, const View& view);

// Returns whether the view leaves out the first Viewpoint of the file.
bool leavesViewpointOut(const xvrml::OpenRTMapper& mapper, const View& view, double aspect);

xvrml::CameraSettings chooseCamera(const xvrml::OpenRTMapper& mapper, const View& view,
                                   double aspect);

} // namespace picture
