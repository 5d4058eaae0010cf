// sliver_edges.h: which triangles of a mesh must be met in double precision: slivers, and what
// shares an edge with one, so that a ray past that edge is judged by one measure on both sides.
// Pure functions, called when a geometry is baked.
#pragma once

#include <cstdint>
#include <vector>

namespace openrt {

enum class TriangleShape : uint8_t { good, sliver, degenerate };

// Of three points, stride 3: a sliver is far longer than high, or so large or small that products
// of its edges leave the range of floats.
TriangleShape shapeOf(const float* a, const float* b, const float* c);

// Turns good triangles beside slivers into slivers. Returns three bits for each sliver, in order:
// edges that it still shares with a good one, numbered as in exact.h. Vertices at the same place
// are the same. shapes: by triangle, at least one a sliver.
std::vector<uint8_t> widenSlivers(const std::vector<float>& vertices, const uint32_t* indices,
                                  std::vector<TriangleShape>& shapes);

} // namespace openrt
