// eye.h: The camera of the z-buffer renderer: projects points of the world to the picture, and
// returns the ray of a pixel. [any thread]
#pragma once

#include "libpicture/raster/affine.h"
#include "xvrml/camera.h"

namespace picture::raster {

// A projected point. Divided by w, hx and hy are its place in the picture, in pixels from the left
// upper corner. d divided by w is its depth, which is linear in the picture and grows towards the
// eye.
struct Corner {
  float hx = 0, hy = 0, w = 0, d = 0;
  // Returns false for points that are too far away for floats.
  bool isFinite() const { return std::isfinite(hx + hy + w + d); }
};

class Eye {
 public:
  // toWorld: from the camera, which looks along -z, to the world; it may shear (View::Pinhole). It
  // replaces the matrix of the camera.
  Eye(const xvrml::CameraSettings& camera, const double* toWorld, int width, int height);
  // Returns false if the matrix of the camera is unusable: nothing can be drawn.
  bool isGood() const { return fromWorld_.has_value() && std::isfinite(scale_) && scale_ > 0; }
  Corner project(const Vec& point) const;
  const Vec& position() const { return toWorld_.origin; }
  struct Ray {
    Vec origin, direction; // the direction is not normalised
  };
  // x and y are in pixels.
  Ray ray(double x, double y) const;
  // Returns the depth of the eye: points with a greater one are behind it.
  double nearest() const { return isParallel_ ? 0 : 1e30; }

 private:
  Affine toWorld_;
  std::optional<Affine> fromWorld_;
  bool isParallel_;
  double scale_;      // pixels a unit: at distance 1, or everywhere in a parallel view
  double left_, top_; // the middle of the picture, in pixels
};

} // namespace picture::raster
