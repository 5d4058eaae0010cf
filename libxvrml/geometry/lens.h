// lens.h: what a viewpoint node sees: the angle of a view in perspective, the extent of one in
// parallel projection. [any thread that owns the node]
#pragma once

#include "geometry/matrix.h"
#include "nodes/viewpoint.h"
#include "xvrml/camera.h"

namespace xvrml {

// Sets all of a camera but its place, which camera.matrix holds already. viewpoint: nullopt stands
// for the default Viewpoint of ISO/IEC 14772-1 6.53. surroundings: the coordinate system around the
// node, in whose units an OrthoViewpoint gives its extent. aspect: width of the picture by height.
// An extent that is not centred moves the camera aside.
void setLens(CameraSettings& camera, const std::optional<ViewpointFields>& viewpoint,
             const Matrix& surroundings, double aspect);

// How a viewpoint whose viewAll is TRUE sees the sphere around the bounding box of a world, so that
// it fits into a picture of any shape (ISO/IEC 19775-1 23.3.1).
struct SphereView {
  Vector middle;
  double distance = 1; // from the eye to the middle
  double radius = 0;   // radius that a parallel view shows; 0: the view is in perspective
};
// Returns nullopt if the viewpoint does not ask for it, or the box has no size that can be seen.
// low, high: the corners of the box.
std::optional<SphereView> viewOfAll(const ViewpointFields& viewpoint, const Vector& low,
                                    const Vector& high);
// Sets the extent of a parallel view of a sphere in a picture of this shape.
void showSphere(CameraSettings& camera, double radius, double aspect);

} // namespace xvrml
