// first_hit.h: what the channels of the first hit say about one hit, which is seen directly or as
// an image in mirrors and glass (RT_FOLLOW_IMAGES). [render]
#pragma once

#include <cstdint>

#include "render/wave/pixel_samples.h"
#include "render/wave/points.h"
#include "scene/matrix.h"

namespace openrt {

// How the space beyond the mirrors of a path appears in front of them, in render space.
struct MirrorSpace {
  Matrix4d now, before;
  bool mirrorMoved = false; // before differs from now
  bool mirrorNew = false;   // the image was not there in the frame before
};

// An image lies on the ray of the camera, as far away as the light has travelled. Its normal and
// its motion are those of the surface, taken back through the mirrors.
struct SeenImage {
  const MirrorSpace& space;
  Vec3f tint;              // mirrors and glass multiply the albedo by it
  Vec3d origin, direction; // the ray of the camera; unit
};

struct FirstHit {
  const RenderScene& scene;
  const Points& points;
  uint32_t i;                       // the hit is number i of the points
  float* const* albedo;             // by hit, as their shader reports it
  const SeenImage* image = nullptr; // null: the hit is seen directly
};

// Records the hit as the first surface of a path, in the channels that the frame has.
void storeFirstHit(const FirstHit& hit, uint32_t path, PixelSamples& found);

} // namespace openrt
