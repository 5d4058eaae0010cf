// thin.h: builds lines and points as round linear curves and spheres in the top level's frame.
// Their widths are in pixels of the camera's view, so they are rebuilt when they or the camera
// move. Called on the application thread, between frames.
#pragma once

#include <memory>

#include "backend/local/accel/accel.h"

namespace openrt {

// The size of a pixel at depth d along the view axis, in render space: constant + slope * |d|.
struct PixelFootprint {
  float constant = 0, slope = 0;
  Vec3f eye, axis{0, 0, -1};
  bool operator==(const PixelFootprint&) const = default;
};

// A geometry of lines or points where it is placed.
struct ThinGeometry {
  const Geometry& geometry;
  Matrix4d toKernel; // to the top level's frame
  uint32_t record = 0;
  bool joins = false; // rays go on behind it or in its gaps, so lines have no ends within others
};

// Adds lines or points to a part of their kind. `scale` converts render space to the top level's
// frame. If asked, lines that follow each other in the list and share a vertex are joined, so that
// a ray enters them once.
void addThin(Part& part, const ThinGeometry& thin, const PixelFootprint& footprint, float scale);

} // namespace openrt
