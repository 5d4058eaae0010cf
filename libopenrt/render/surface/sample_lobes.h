// sample_lobes.h: the stage that takes the random decisions of BSDF sampling at the hits of a
// batch: a direction for each non-specular lobe, and the numbers that select one sample. [render]
#pragma once

#include "render/surface/lobes.h"
#include "render/wave/batch.h"
#include "render/wave/random_numbers.h"

namespace openrt {

// Without path tracing every pointer is null.
struct LobeSampling {
  RandomNumbers random;                           // by hit
  float* choices[2] = {};                         // by hit: selects a sample, Russian roulette
  const LobeSamples* samples[RTS_MAX_LOBES] = {}; // by lobe; null for specular lobes
  // By lobe and hit: probability that the lobe's sample is followed. spawnRays() writes it, light
  // sampling reads it. Null if the lobe is specular or emitters are not sampled.
  float* selectionProbability[RTS_MAX_LOBES] = {};
};

// Draws the choices at the hits, but samples no lobe.
LobeSampling drawChoices(const RtsBatch& batch, const RandomNumbers& random);
// Samples a direction for every hit from each non-specular lobe.
void sampleLobes(const RtsBatch& batch, LobeSampling& sampling);
// Allocates the selection probabilities, 0, of the lobes that light sampling wants to know.
void allocateSelection(const RtsBatch& batch, LobeSampling& sampling);

} // namespace openrt
