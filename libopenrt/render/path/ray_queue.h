// ray_queue.h: rays queued for the next wave of a tile. A path may spawn several rays. The tile
// renderer keeps the queues from tile to tile to reuse their memory. [render]
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "render/lights/emitters.h"
#include "render/surface/media.h"

namespace openrt {

// Class of a path so far. Light tracing takes over the `caustic` camera paths that end on a light
// source; path tracing must leave those out.
enum class PathClass : uint8_t {
  undeflected, // no scattering event yet: the ray still follows the camera ray
  diffuse,     // the first and the last scattering events were non-specular
  caustic,     // as `diffuse`, followed only by specular events since the last non-specular one
  // The first event was specular. For a path from a light source: this is a path that light tracing
  // follows.
  specularFirst
};

// State that a ray carries for its path.
struct RayState {
  float throughput[3] = {1, 1, 1};
  float travelled = 0; // path length up to the ray's origin
  uint32_t path = 0;   // index of the path (sample) in the tile
  // Distinguishes the random numbers of the path's branches; 0: the branch of the camera ray.
  uint32_t branch = 0;
  // Solid-angle pdf with which BSDF sampling chose the direction; 0: specular or camera ray.
  float pdf = 0;
  // The previous path vertex, where `pdf` was sampled; needed for the light pdf in MIS.
  LightSampleContext previous;
  MediaStack media = {}; // the media that contain the ray
  PathClass pathClass = PathClass::undeflected;
  uint8_t scattered = 0; // the path has a non-specular vertex
  // The path has a non-specular vertex and only specular ones since: light sampling cannot find an
  // emitter that the ray hits (UnsampledLight, ledger.h).
  uint8_t specularSinceDiffuse = 0;
  uint8_t deflected = 0; // a surface has changed the direction: the pixel's alpha is final
  uint8_t splits = 0;    // number of times the path has split into several rays
  // 1 + index of the only colour that the ray carries (dispersion); 0: all colours
  uint8_t channel = 0;
};

struct QueuedRay {
  float origin[3], direction[3];
  RayState state;
};

using RayQueue = std::vector<QueuedRay>;

} // namespace openrt
