// paths.h: the paths of a tile that are in flight. Ray arrays are indexed by lane of the current
// wave, accumulated results by path. Shared by the source files of TileRenderer. [render]
#pragma once

#include "render/path/tile.h"
#include "render/rays.h"

namespace openrt {

struct TileRenderer::Paths {
  Rays rays;          // rays of the current wave
  PathStates states;  // indexed by ray lane
  float* radiance[3]; // this and the following arrays are indexed by path
  float* alpha;
  uint8_t* first; // 1 until the first surface of the path has been shaded
  float *normal[3], *albedo[3], *position[3], *depth; // null if the frame does not have the channel
  uint32_t* name;
  // Working storage for the intersections of a wave.
  RayHits hits;
  uint32_t *missed, *met, *order;
};

} // namespace openrt
