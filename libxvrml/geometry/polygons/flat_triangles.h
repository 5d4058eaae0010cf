// flat_triangles.h: triangles without area that connect a vertex with an edge it lies on. A polygon
// with corners in one line (an H) is cut into such triangles besides the visible ones. [any thread]
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "geometry/vector_math.h"

namespace xvrml {

// Removes the triangles without area from a triangulation (3 vertex numbers each). The triangle on
// the other side of the longest edge is cut at the vertex that lies on that edge, so that the
// vertex keeps its colour, normal and texture coordinate on both sides and no T-junction is left.
// position: of a vertex. hasArea: whether a triangle of three vertices is to be kept.
void removeFlatTriangles(std::vector<uint32_t>& triangles,
                         const std::function<V3d(uint32_t)>& position,
                         const std::function<bool(uint32_t, uint32_t, uint32_t)>& hasArea);

} // namespace xvrml
