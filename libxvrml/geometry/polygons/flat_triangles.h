// flat_triangles.h: removes slivers: triangles without area that connect a vertex with an edge on
// which it lies. The tessellator makes them from polygons with collinear corners (an H). [any
// thread]
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "geometry/vector_math.h"

namespace xvrml {

// Removes the slivers of a triangulation (3 vertex numbers per triangle). The triangle behind a
// sliver's longest edge is split at the vertex on that edge. So the vertex keeps its colour, normal
// and texture coordinate on both sides, and no T-junction is left. position: returns the position
// of a vertex. hasArea: returns whether a triangle of three vertices is kept.
void removeFlatTriangles(std::vector<uint32_t>& triangles,
                         const std::function<V3d(uint32_t)>& position,
                         const std::function<bool(uint32_t, uint32_t, uint32_t)>& hasArea);

} // namespace xvrml
