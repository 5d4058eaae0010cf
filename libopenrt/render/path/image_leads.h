// image_leads.h: where images are seen from hits: in smooth mirrors and through smooth glass
// (RT_FOLLOW_IMAGES). [render]
#pragma once

#include "render/wave/boundaries.h"

namespace openrt {

// The direction in which an image is seen from a hit.
struct ImageLead {
  Vec3f direction, tint{1, 1, 1};
  bool found = false; // else no image is to be followed
  bool reflected = false, straight = false;

  // Least share of images in what the lobes of a hit carry. Where less is reflected, as by
  // varnished wood at a low angle, the grain of the surface matters more than the image in it.
  static constexpr float leastTransmission = 0.7f, leastReflection = 0.95f;
  // Rough lobes narrower than this (alpha) show images.
  static constexpr float nearlySmooth = 0.05f;
};

// Finds the images of the hits of a batch with lobes, without random numbers: the heavier one of
// reflection and transmission, where the specular lobes clearly carry more than the others. By hit,
// in the arena of the batch.
const ImageLead* findImageLeads(const RtsBatch& batch, const Boundaries& boundaries);

} // namespace openrt
