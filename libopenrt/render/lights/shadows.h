// shadows.h: visibility of one light from the points of a batch. [render]
#pragma once

#include "render/surface/batch.h"

namespace openrt {

// Storage for what a light sends to the points of a batch. It goes with the block of the arena that
// is open when the first light is asked, so whoever asks for several within blocks of his own calls
// this before.
void makeRoomForLight(RtsBatch& batch, uint32_t n);
// Multiplies light.color by what is let through between the points and the light last looked at,
// where wanted.
void castShadows(RtsBatch& batch, const uint8_t* wanted, RtsIllumination& light);

// Rays towards light, with the place in `color` that each belongs to.
struct ShadowRays {
  Rays rays;
  uint32_t* lane;
};
// Multiplies colours by what is let through between the rays' ends. The rays are used up.
void passShadows(const RtsBatch& batch, ShadowRays& rays, float* const color[3]);

} // namespace openrt
