// continue_paths.h: continues the camera paths at all hits of a batch with vector lanes: selects
// BSDF samples, applies Russian roulette or the energy cut, and queues the next rays. spawnRays()
// (render/path/spawn_rays.h) calls it. [render]
#pragma once

#include "render/surface/sample_arrays.h"

namespace openrt {

// The paths at the hits of a batch.
struct Continuation {
  const Points* points;
  const PathStates* states;
  uint32_t level; // number of surfaces that the paths have hit before
  // Random numbers by hit: to select a sample, for Russian roulette. Null without path tracing:
  // then paths end where they carry less than the energy cut.
  const float *choice, *survival;
  float energyCut;
  const Crossing* crossing; // boundaries of media by hit; null: there are none
  // By hit: 1 if light from behind the surface counts for light samples; null: nowhere.
  const uint32_t* twoSided;
  // By hit: 1 where light samples do not pass what the surface transmits straight on, so that rays
  // lose the pdf of their directions there; null: nowhere.
  const uint32_t* unsampled;
  // Written by chooseSamples(), by hit: number of samples; 1 if chance has decided which of them
  // are followed.
  uint32_t *count, *random;
};

// Decides which samples of each hit are followed: all, or a selected one if the path has split
// several times. The probability of the selection does not depend on the sampled directions,
// because the MIS weights of light sampling use it.
void chooseSamples(const Continuation& paths, const BsdfSampleArrays& samples);

// Appends to the queue the rays of the hits that follow a sample, in the order of the hits.
// `hitOf` is working storage for as many numbers as there are hits, padded, and 16 more.
void continuePaths(const Continuation& paths, const SampleArrays& sample, uint32_t* hitOf,
                   RayQueue& queue);

} // namespace openrt
