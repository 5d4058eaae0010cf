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

} // namespace xvrml
