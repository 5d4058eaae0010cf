// shadows.h: shadow rays: visibility of one light from the points of a batch. [render]
#pragma once

#include "render/surface/batch.h"

namespace openrt {

// Allocates the arrays for a light's illumination of the points. They live in the arena scope that
// is open when the first light is evaluated. So a caller that evaluates several lights in scopes of
// their own must call this before.
void allocateLightArrays(RtsBatch& batch, uint32_t n);
// Multiplies light.color by the transmittance between the points and the light evaluated last, at
// the points where `wanted` is not 0.
void castShadows(RtsBatch& batch, const uint8_t* wanted, RtsIllumination& light);

// Shadow rays, and for each ray the index into `color` that it belongs to.
struct ShadowRays {
  Rays rays;
  uint32_t* lane;
};
// Multiplies colours by the transmittance along the rays. Overwrites the rays.
void traceTransmittance(const RtsBatch& batch, ShadowRays& rays, float* const color[3]);

} // namespace openrt
