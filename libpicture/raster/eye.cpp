#include "libpicture/raster/eye.h"

namespace picture::raster {

Eye::Eye(const xvrml::CameraSettings& camera, const double* toWorld, int width, int height)
    : toWorld_(affineOf(toWorld ? toWorld : camera.matrix)), fromWorld_(toWorld_.inverse()),
      isParallel_(camera.fovy == 0),
      scale_(isParallel_ ? height / camera.height : height / (2 * std::tan(camera.fovy / 2))),
      left_(width / 2.0), top_(height / 2.0) {}

Corner Eye::project(const Vec& point) const {
  const Vec p = fromWorld_->point(point);
  const double w = isParallel_ ? 1 : -p.z;
  return {float(p.x * scale_ + left_ * w), float(top_ * w - p.y * scale_), float(w),
          float(isParallel_ ? p.z : 1)};
}

Eye::Ray Eye::ray(double x, double y) const {
  const double right = (x - left_) / scale_, up = (top_ - y) / scale_;
  if (isParallel_) return {toWorld_.point({right, up, 0}), toWorld_.z * -1.0};
  return {toWorld_.origin, toWorld_.vector({right, up, -1})};
}

} // namespace picture::raster
