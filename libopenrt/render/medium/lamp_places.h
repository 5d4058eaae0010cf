// lamp_places.h: where along a ray in a medium the light of lamps is gathered. [render]
#pragma once

#include "render/medium/flights.h"

namespace openrt {

// Places along rays, with the light that each sends back to the path's start for a radiance of 1
// that it scatters into the ray. By lane; the arrays lie in the arena.
struct LampPlaces {
  RayPlaces places;
  float* weight[3]; // throughput, coefficient of scattering and transmittance over the pdf
};

// Samples one place for each of the rays, which fly through one medium. Half of the places are
// distributed like collisions before the surface, half at equal angles as seen from a lamp, so that
// the growth of the irradiance towards the lamp is cancelled (C. Kulla, M. Fajardo, "Importance
// Sampling Techniques for Path Tracing in Participating Media", EGSR 2012); the weight is that of
// both together (balance heuristic). Called before sampleFlights(). pair:
// PathTracer::firstPair().
LampPlaces sampleLampPlaces(const StageContext& context, const PathSamples& samples, uint32_t pair,
                            uint16_t medium, std::span<const uint32_t> flights, const Wave& wave);

} // namespace openrt
