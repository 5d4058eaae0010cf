// lobes.h: lobes that scatter light over directions: the engine's own kinds as the same functions
// that a plug-in brings for its own (RtsLobeFunctions). Pure functions. [render]
#pragma once

#include "openrt/openrts.h"
#include "render/arena.h"

namespace openrt {

// Null for lobes that know but one direction: mirrors, smooth boundaries, straight through.
const RtsLobeFunctions* scatteringOf(const RtsLobe& lobe);

// Whether the lobe's weight at a hit is above 0; out gets it, NaN, infinite and negative parts as
// 0.
bool weightAt(const RtsLobe& lobe, uint32_t hit, float out[3]);

// Whether light from behind the surface counts at a hit.
bool transmitsAt(const RtsBatch& batch, uint32_t hit);

// A lobe's answers to n pairs of a hit and a direction, checked: what is not finite or negative is
// 0.
struct LobeAnswers {
  float *value[3], *density;
  // batch: whose lobes; crashes and NaN in functions of a plug-in are then put down to its class
  LobeAnswers(Arena& arena, uint32_t n, const RtsBatch* batch = nullptr);
  void evaluate(const RtsLobe& lobe, const RtsHits& hits, uint32_t n, const uint32_t* hit,
                const float* const direction[3]);

 protected:
  const RtsBatch* batch_;
};

// Directions that a lobe has chosen, with `value` over density in LobeAnswers::value. Density 0:
// none.
struct LobeSamples : LobeAnswers {
  float* direction[3];
  LobeSamples(Arena& arena, uint32_t n, const RtsBatch* batch = nullptr);
  void sample(const RtsLobe& lobe, const RtsHits& hits, uint32_t n, const uint32_t* hit,
              const float* const square[2]);
};

} // namespace openrt
