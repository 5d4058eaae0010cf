// bake.h: one placed geometry as the vertex and index arrays that Embree reads: transformed in
// double, rounded once; checked for what must not reach the kernels (indices out of range,
// degenerate triangles) and for slivers, which are met in double precision.
#pragma once

#include <vector>

#include "scene/scene.h"

namespace openrt {

struct BakedTriangles {
  std::vector<float> vertices;    // stride 3
  std::vector<uint32_t> indices;  // 3 a triangle that is kept in the main list; empty: the
                                  // geometry's own indices serve
  std::vector<uint32_t> kept;     // original triangle of each kept one, when indices is not empty
  std::vector<uint32_t> slivers;  // original triangles to be met in double precision
  std::vector<uint8_t> openEdges; // of each of these: sliver_edges.h
  uint64_t degenerate = 0;        // dropped
};

// toKernel: the geometry's local frame -> the kernel's frame.
BakedTriangles bakeTriangles(const Geometry& geometry, const Matrix4d& toKernel);

// Points of a geometry in the kernel's frame, stride 3.
std::vector<float> bakePoints(const Geometry& geometry, const Matrix4d& toKernel);

// True if indices are all below the number of points and attribute arrays are long enough.
bool consistent(const Geometry& geometry);

struct Box {
  Vec3d low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
  bool empty() const { return !(low.x <= high.x); }
  void add(const Vec3d& p);
  void add(const Box& box, const Matrix4d& matrix); // the transformed corners
};
Box boundsOf(const Geometry& geometry); // under its own matrix

} // namespace openrt
