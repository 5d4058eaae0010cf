// paths.h: the samples of a tile that are under way: the rays of the wave being traced by lane,
// what has been gathered by path. Shared by the two halves of TileRenderer. [render]
#pragma once

#include "render/path/tile.h"
#include "render/rays.h"

namespace openrt {

struct TileRenderer::Paths {
  Rays rays;          // of the wave
  RayState* state;    // by ray lane
  float* travelled;   // state[lane].travelled, as makePoints reads it
  float* radiance[3]; // by path, from here on
  float* alpha;
  uint8_t* first;                                     // nothing was shaded on the path yet
  float *normal[3], *albedo[3], *position[3], *depth; // null where nobody asks
  uint32_t* name;
  // storage of a wave's intersections
  RayHits hits;
  uint32_t *missed, *met, *order;
};

} // namespace openrt
