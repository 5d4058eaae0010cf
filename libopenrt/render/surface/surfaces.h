// surfaces.h: what rays meet before shaders answer: backs that are not there, boundaries of media.
// For those who follow paths from the camera and from lamps. [render]
#pragma once

#include "render/surface/batch.h"
#include "render/surface/media.h"

namespace openrt {

// Rays whose nearest hit is a back that is not there are traced again without such backs. From
// their origin: a face and a back in the same place must not hide each other.
void lookThroughBacks(const RenderScene& scene, Arena& arena, RayCounters& counters,
                      const Rays& rays, RayHits& hits);

// Boundaries of media at the hits of a batch.
struct Boundaries {
  Crossing* crossing; // by hit
  float (*eta)[3];    // index on the ray's side over that behind, by colour
};
// For a batch whose class has a medium, after its `surface`: what lies on both sides of each hit.
// At a boundary within a body of higher priority all weights become 0.
void meetBoundaries(RtsBatch& batch, RayState* states, Boundaries& out);

// What the media absorb of rays on their way to what they have met.
void absorbOnTheWay(const RenderScene& scene, const Rays& rays, const RayHits& hits,
                    RayState* states);

} // namespace openrt
