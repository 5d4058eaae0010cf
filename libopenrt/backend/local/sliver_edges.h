// sliver_edges.h: decides which triangles of a mesh are intersected in double precision: slivers,
// and triangles that share an edge with a sliver, so that both sides of that edge use the same
// test. Pure functions, called when a geometry is baked.
#pragma once

#include <cstdint>
#include <vector>

namespace openrt {

enum class TriangleShape : uint8_t { good, sliver, degenerate };

// Classifies the triangle of three points. A sliver is far longer than high, or so large or small
// that products of its edges leave the range of floats.
TriangleShape shapeOf(const float* a, const float* b, const float* c);

// Turns good triangles that share an edge with a sliver into slivers. Returns three bits for each
// sliver, in order: the edges that it still shares with a good triangle, numbered as in
// ray_triangle.h. Vertices at the same position count as one. shapes: one per triangle, at least
// one is a sliver. vertices: stride 3.
std::vector<uint8_t> widenSlivers(const std::vector<float>& vertices, const uint32_t* indices,
                                  std::vector<TriangleShape>& shapes);

} // namespace openrt
