// surface_connections.h: connects vertices of light paths with the first non-specular surfaces of
// camera paths, seen by way of mirrors and smooth glass. The surface takes the place of the camera
// in light tracing: E. Veach, "Robust Monte Carlo Methods for Light Transport Simulation", 1997,
// chapter 10, with a camera subpath that ends at that surface. [render]
#pragma once

#include "render/lights/light_sources.h"
#include "render/path/light_path_gain.h"
#include "render/path/light_path_ratios.h"
#include "render/surface/sent_light.h"
#include "render/wave/boundaries.h"

namespace openrt {

// Hits of a batch of camera paths. Each has a light path of its own, so that the samples of pixels
// stay independent.
struct ConnectedSurfaces {
  const RtsBatch& batch;
  const Boundaries& boundaries;
  const SentLight& sent; // gets the light
  uint32_t level;        // number of surfaces that the camera paths have hit before
  uint32_t count;
  const uint32_t* hit; // by light path: index of the hit in the batch
  LightPathGain* gain; // gets what the connections are worth; null: nobody asks
};

// Vertices of light paths: hits of a batch, at most one of each path.
struct LightVertices {
  const RtsBatch& batch;
  uint32_t count;
  const uint32_t* hit;      // by vertex
  const float* const* flux; // that arrives, by vertex
  LightStarts starts;
};

// Adds the light of the vertices to the surfaces of their paths: one shadow ray each.
void connectVertices(const ConnectedSurfaces& surfaces, const LightVertices& vertices);

} // namespace openrt
