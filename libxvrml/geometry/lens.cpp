// lens.cpp: cameras of Viewpoint, OrthoViewpoint and ORTViewpoint.
#include "geometry/lens.h"

#include <algorithm>
#include <cmath>

#include "xvrml/world.h"

namespace xvrml {
namespace {

struct Extent {
  double left = -1, bottom = -1, right = 1, top = 1; // defaults of ISO/IEC 19775-1 23.4.5
};

// Returns the default for a list that gives no extent: the wrong number of values, or none between.
Extent extentOf(const MFFloat& given) {
  if (given.size() != 4) return {};
  const Extent extent{given[0], given[1], given[2], given[3]};
  const double width = extent.right - extent.left, height = extent.top - extent.bottom;
  return width > 0 && height > 0 && std::isfinite(width) && std::isfinite(height) ? extent
                                                                                  : Extent{};
}

// The whole extent is seen; a picture of another shape shows more in one direction (23.4.5).
void setParallel(CameraSettings& camera, const Extent& extent, double scale, double aspect) {
  const double width = (extent.right - extent.left) * scale,
               height = (extent.top - extent.bottom) * scale,
               right = (extent.left + extent.right) / 2 * scale,
               up = (extent.bottom + extent.top) / 2 * scale;
  camera.fovy = 0;
  camera.height = aspect > 0 ? std::max(height, width / aspect) : height;
  for (int i = 0; i < 3; ++i)
    camera.matrix[12 + i] += camera.matrix[i] * right + camera.matrix[4 + i] * up;
}

} // namespace

void setLens(CameraSettings& camera, const std::optional<ViewpointFields>& viewpoint,
             const Matrix& surroundings, double aspect) {
  if (viewpoint && viewpoint->extent) {
    const double scale = std::cbrt(std::abs(determinant(surroundings)));
    setParallel(camera, extentOf(*viewpoint->extent), scale > 0 && std::isfinite(scale) ? scale : 1,
                aspect);
  } else {
    const bool given = viewpoint && viewpoint->fieldOfView;
    camera.fovy = verticalFieldOfView(given ? *viewpoint->fieldOfView : 0.785398f, aspect);
  }
  if (viewpoint) camera.shader = renderedNode(viewpoint->shader);
}

std::optional<SphereView> viewOfAll(const ViewpointFields& viewpoint, const Vector& low,
                                    const Vector& high) {
  if (!viewpoint.viewAll || !*viewpoint.viewAll) return {};
  SphereView view{(low + high) / 2};
  const double radius = (high - low).length() / 2;
  if (!(radius < 1e30)) return {};
  // The box of a single point is as large as its rounding: any distance will do.
  if (radius <= 1e-7 * view.middle.length() + 1e-20) return view;
  if (viewpoint.fieldOfView) {
    view.distance = radius / std::sin(std::clamp(double(*viewpoint.fieldOfView), 1e-3, 3.0) / 2);
  } else {
    view.distance = 2 * radius;
    view.radius = radius;
  }
  return view;
}

void showSphere(CameraSettings& camera, double radius, double aspect) {
  camera.height = 2 * radius * std::max(1.0, aspect > 0 ? 1 / aspect : 1);
}

} // namespace xvrml
