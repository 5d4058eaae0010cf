// extent.h: the bounds of what is drawn, in double. Pure; called by the mapper once.
#pragma once

#include "mapper/graph/places.h"
#include "xvrml/mapper.h"

namespace xvrml::mapper {

// World bounds with every billboard and level of detail as the places now have it; for LODs the
// highest level.
Bounds boundsOf(Graph& graph, const Places& places);
// The sphere about the middle of these bounds.
BoundingSphere sphereOf(Graph& graph, const Places& places, const Bounds& bounds);

} // namespace xvrml::mapper
