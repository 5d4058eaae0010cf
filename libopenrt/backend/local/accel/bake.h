// bake.h: converts a placed geometry to the vertex and index arrays that Embree reads. Vertices are
// transformed in double precision and rounded once. Degenerate triangles and indices out of range
// are kept from the ray kernels; slivers are separated for intersection in double precision. Called
// between frames, on the application thread.
#pragma once

#include <vector>

#include "scene/scene.h"

namespace openrt {

struct BakedTriangles {
  std::vector<float> vertices; // stride 3
  // 3 for each triangle of the main list. Empty: all triangles, with the geometry's own indices.
  std::vector<uint32_t> indices;
  std::vector<uint32_t> kept;     // original number of each triangle in `indices`
  std::vector<uint32_t> slivers;  // original numbers of triangles for double precision
  std::vector<uint8_t> openEdges; // for each sliver (sliver_edges.h)
  uint64_t degenerate = 0;        // number of degenerate triangles, which were dropped
  bool whole() const { return indices.empty() && slivers.empty() && degenerate == 0; }
};

// toKernel: from the geometry's local frame to the kernel's frame.
BakedTriangles bakeTriangles(const Geometry& geometry, const Matrix4d& toKernel);

// Returns the points of a geometry in the kernel's frame, stride 3.
std::vector<float> bakePoints(const Geometry& geometry, const Matrix4d& toKernel);

// Returns true if all indices are below the number of points and the attribute arrays are long
// enough.
bool consistent(const Geometry& geometry);

// All that shares a frame may be this many times as large as its smallest part, of which single
// precision then tells 2^-8 of the size apart.
inline constexpr double largestToSmallest = 65536;

struct Box {
  Vec3d low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
  bool empty() const { return !(low.x <= high.x); }
  void add(const Vec3d& p);
  void add(const Box& box, const Matrix4d& matrix); // adds the transformed corners of the box
};
Box boundsOf(const Geometry& geometry); // transformed by the geometry's own matrix
double halfDiagonal(const Box& box);    // 0 if the box is empty
// Returns whether several points of a mesh lie so close to its own origin, where floats are
// densest, that they would be one point in a frame about the middle of the mesh.
bool hasDetailAtOrigin(const Geometry& geometry);

} // namespace openrt
