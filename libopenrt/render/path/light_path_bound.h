// light_path_bound.h: what the light paths of the photon pass tell about light that they have not
// found. A light path that ends at a surface of a tile adds some radiance to the tile. If no light
// path has found a part of the light, the tile may lack what about three of them would add (rule of
// three), in a part of its pixels. [render]
#pragma once

#include "render/path/spawn_rays.h"
#include "render/wave/batch.h"
#include "render/wave/tiles.h"

namespace openrt {

// The rays of a tile's camera, as a parallelogram that moves along them.
struct TileFootprint {
  Vec3f origin[2], direction[2]; // differences between the rays at its corners, along two sides
  // Returns its area after a distance.
  float area(float distance) const;
};
TileFootprint footprintOf(const StageContext& context, const Tile& tile);

// Adds the radiance that a light path would add to each path of a batch to the ledger. A path
// counts at each surface that scatters; the denser the paths of the tile lie there, the more a
// light path adds to their mean. After a surface that scatters the density follows from the pdf of
// the direction, and is at most that of the tile's own rays.
void addLightPathBound(const CameraPaths& paths, const LobeSampling& sampling,
                       const TileFootprint& footprint);

} // namespace openrt
