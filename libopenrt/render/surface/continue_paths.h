// continue_paths.h: continues many paths at once, with vector lanes, where a surface has one
// non-specular lobe and is no boundary of a medium. spawnRays() (render/path/spawn_rays.h) calls
// it, and does the same hit by hit at other surfaces. [render]
#pragma once

#include "render/path/path_states.h"
#include "render/surface/points.h"

namespace openrt {

struct LobeSamples;

struct Continuation {
  const Points* points;
  const PathStates* states;
  const uint32_t* order; // by hit: lane in `states`
  const RtsLobe* lobe;
  bool transmits; // light from behind the surface counts, too
  const LobeSamples* samples;
  const float* survival; // random numbers for Russian roulette
  // By hit: gets 1 where the sample is followed if it survives, which light sampling must know.
  // Null if emitters are not sampled.
  float* selectionProbability;
};

// Appends the spawned rays to the queue, in the order of the hits. `lanes` is working storage for
// as many numbers as there are hits, padded.
void continuePaths(const Continuation& from, uint32_t* lanes, RayQueue& queue);

} // namespace openrt
