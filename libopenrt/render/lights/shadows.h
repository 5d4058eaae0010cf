// shadows.h: shadow rays: visibility of one light from the points of a batch. [render]
#pragma once

#include "render/wave/batch.h"

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
  const uint32_t* hit = nullptr; // by lane: the hit of the batch; null: the lane itself
  // The media at the rays' origins, in scenes with media that scatter. Null: no medium attenuates
  // the rays.
  MediaStack* media = nullptr;
  // The rays belong to light samples. They pass what rays of paths pass with the pdf of their
  // directions, so that the MIS weights of both agree: passesStraight(), and boundaries without
  // effect. No glass is crossed, because rays of paths are bent there.
  bool toEmitters = false;
  // The rays connect light paths to the camera. They cross no glass either.
  bool toCamera = false;
  float* const* lastOrigin = nullptr; // gets the origins of the rays' last parts, by `lane`
};
// Returns whether light samples pass what the surfaces of a shader transmit straight on. Those of
// media with RTS_TRANSPARENT let them pass where the boundary has no effect.
bool passesStraight(const ShaderSlot& shader);
// Returns RenderScene::samplesPass of a scene whose other members are set. [commit]
bool samplesPass(const RenderScene& scene);
// Allocates shadow rays. Their number is still to be set.
ShadowRays allocateShadowRays(const RenderScene& scene, uint32_t capacity, Arena& arena,
                              bool toEmitters = false);
// Multiplies colours by the transmittance along the rays. Overwrites the rays. A ray that passes
// more than mostPassages surfaces is dark; what is cut from it is counted in the ledger.
void traceTransmittance(const RtsBatch& batch, ShadowRays& rays, float* const color[3]);

} // namespace openrt
