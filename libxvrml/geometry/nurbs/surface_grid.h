// surface_grid.h: vertices of a surface of two parameters, and the mesh of a whole grid of them.
// Pure functions; any thread.
#pragma once

#include <vector>

#include "geometry/faults.h"
#include "geometry/mesh.h"
#include "geometry/vector_math.h"

namespace xvrml {

struct SurfaceVertex {
  V3d place, normal; // a zero normal becomes the mean of the facets around it
  Vec2f texCoord;
};

// Points of a surface, row by row along the first parameter.
struct SurfaceGrid {
  size_t columns = 0, rows = 0; // at least 2
  std::vector<SurfaceVertex> vertices;
};

// Returns whether a grid of this many steps can be drawn, and notes a fault if it is too large.
bool isGridAllowed(uint64_t uSteps, uint64_t vSteps, const MeshOptions& options, Faults& faults);

// Returns the mesh of a grid. Its front is where the normals point, or flipped the other side. Rows
// and columns that shrink to a point, and first ones that meet the last, share their places, so
// that the mesh is closed there.
Mesh meshOfGrid(SurfaceGrid&& grid, bool flipped, Faults& faults);

// Sets the views of a mesh whose own vectors hold the vertices and triangles of a surface, and the
// normals that are zero. Returns an empty mesh, with a fault, if a vertex is not finite.
Mesh finishSurface(Mesh&& mesh, bool flipped, Faults& faults);

} // namespace xvrml
