// lobes.h: evaluation and sampling of non-specular lobes. The built-in kinds have the same function
// table as the custom lobes of plug-ins (RtsLobeFunctions). Pure functions. [render]
#pragma once

#include "openrt/openrts.h"
#include "render/arena.h"
#include "scene/vec3.h"

namespace openrt {

// Returns the evaluate and sample functions of a lobe; null for specular lobes: mirrors, smooth
// boundaries, straight transmission.
const RtsLobeFunctions* nonSpecularFunctions(const RtsLobe& lobe);

// Returns whether the lobe's weight at a hit is above 0 and writes the weight to `out`. NaN,
// infinite and negative components become 0.
bool weightAt(const RtsLobe& lobe, uint32_t hit, Vec3f& out);

// Returns whether light from behind the surface contributes at a hit.
bool transmitsAt(const RtsBatch& batch, uint32_t hit);
// Returns transmitsAt() of all hits as an array in the batch's arena; null: it is false for all.
const uint32_t* transmitsByHit(const RtsBatch& batch);

// Values and pdfs of a lobe for n pairs of a hit and a direction. Values that are not finite or
// negative are replaced by 0.
struct LobeValues {
  float *value[3], *pdf;
  // batch: the batch that has the lobes. It attributes crashes and NaN in a plug-in's functions to
  // its class.
  LobeValues(Arena& arena, uint32_t n, const RtsBatch* batch = nullptr);
  void evaluate(const RtsLobe& lobe, const RtsHits& hits, uint32_t n, const uint32_t* hit,
                const float* const direction[3]);

 protected:
  const RtsBatch* batch_;
};

// Directions sampled from a lobe. LobeValues::value holds value / pdf. A pdf of 0 means that no
// direction was sampled.
struct LobeSamples : LobeValues {
  float* direction[3];
  LobeSamples(Arena& arena, uint32_t n, const RtsBatch* batch = nullptr);
  void sample(const RtsLobe& lobe, const RtsHits& hits, uint32_t n, const uint32_t* hit,
              const float* const square[2]);
};

} // namespace openrt
