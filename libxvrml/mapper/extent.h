// extent.h: bounds of the drawn world, in double precision. Pure functions, called by the mapper on
// request.
#pragma once

#include <vector>

#include "mapper/graph/places.h"
#include "mapper/outermost.h"
#include "xvrml/mapper.h"

namespace xvrml::mapper {

// Returns the world bounds, with billboards as the places now have them and the highest level of
// each LOD.
Bounds boundsOf(Graph& graph, const Places& places);
// Returns the bounding sphere around the centre of `bounds`, of all levels of each LOD.
BoundingSphere sphereOf(Graph& graph, const Places& places, const Bounds& bounds);

// Returns the points of the world that lie farthest out in these directions (outermost.h), with
// billboards and levels of LODs as the places now have them. An object that is drawn several times
// is represented by the corners of its box.
std::vector<Vector> outermostPoints(Graph& graph, const Places& places,
                                    const Outermost::Directions& directions);

} // namespace xvrml::mapper
