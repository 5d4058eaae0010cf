// projection.h: The projection of a frame's camera, in the precision of the frame's planes. A place
// in the picture is given by two numbers from 0 (left, top) to 1, so that frames of different sizes
// compare. [any thread]
#pragma once

#include "libpicture/live/reconstruction.h"

namespace picture::live {

struct Projection {
  Projection() = default;
  explicit Projection(const FrameCamera& camera);

  // World to camera: the rows of the rotation, and the camera's place as a sum of two floats.
  float rotation[3][3] = {};
  float eye[3] = {}, eyeRest[3] = {};
  // Perspective: place = 0.5 + scale * x / depth. Parallel: place = 0.5 + scale * x.
  float scale[2] = {};
  bool parallel = false;
  // Parallel: depth * this is the nearness (planes.h).
  float perHeight = 0;
  // False: a shader makes the rays, or the numbers are no camera. Nothing can be projected then.
  bool usable = false;
  FrameCamera camera{}; // all 0, which no camera is
};

// Tells whether nothing of two cameras differs, so that what does not move stays where it is.
bool areEqual(const FrameCamera& a, const FrameCamera& b);

} // namespace picture::live
