// flights.h: how far rays fly in a medium that scatters before they collide with it. [render]
#pragma once

#include <span>

#include "render/path/random_numbers.h"
#include "render/path/wave.h"

namespace openrt {

// The rays of a wave that collide before they reach a surface. The arrays lie in the arena.
struct Collisions {
  std::span<const uint32_t> lanes; // in ascending order
  const float* distance;           // from the rays' origins to the collisions
};

// Samples for each ray in a medium that scatters whether it collides and where. Removes the rays
// that collide from wave.met. Multiplies the throughputs of the rays by their weights: the
// transmittance for rays that reach a surface, transmittance times coefficient of scattering for
// rays that collide, each over the pdf. Marks the paths as random. pair: TileRenderer::firstPair().
//
// A ray that leaves the scene keeps its throughput: it was not inside a closed body.
//
// One colour is selected in proportion to the throughput and the distance is sampled for its
// extinction. The pdf is that of all colours together (balance heuristic), so no colour has a large
// weight: A. Wilkie et al., "Hero Wavelength Spectral Sampling", EGSR 2014; M. Pharr, W. Jakob, G.
// Humphreys, "Physically Based Rendering", 4th ed., 14.2.2.
Collisions sampleFlights(const StageContext& context, const PathSamples& samples, uint32_t pair,
                         Wave& wave);

// Makes shading points of collisions, whose normals point against the rays.
Points collisionPoints(const StageContext& context, const Wave& wave, const Collisions& collisions);

} // namespace openrt
