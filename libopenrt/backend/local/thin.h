// thin.h: lines and points: round linear curves and spheres, pixels wide as the camera sees them,
// in the frame of the top level. They are made anew when they or the camera move. Application
// thread, between frames.
#pragma once

#include <memory>

#include "backend/local/accel/accel.h"

namespace openrt {

struct PixelFootprint { // size of a pixel at a distance along the view axis, render space
  float constant = 0, slope = 0;
  float eye[3] = {}, axis[3] = {0, 0, -1};
  bool operator==(const PixelFootprint&) const = default;
};

// Adds a geometry's lines or points to a part of their kind. scale: render space to the top level's
// frame.
void addThin(Part& part, const Geometry& geometry, const Matrix4d& toKernel, uint32_t record,
             const PixelFootprint& footprint, float scale);

} // namespace openrt
