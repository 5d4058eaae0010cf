// mesh.h: makes triangles, lines and points of the vertices between glBegin and glEnd.
#pragma once

#include "gl/frame.h"

namespace rtgl {

// Arrays for rtDrawElements.
struct Mesh {
  std::vector<Vertex> vertices;
  std::vector<uint32_t> triangles, lines, points;
};

// Polygons are triangulated, turned over and left out, drawn as lines or points, as the state of
// the part says. With GL_FLAT each face has the normal and colour of its provoking vertex. Without
// culling, triangles that are lit face where their normals point.
Mesh meshOf(const Part& part);

} // namespace rtgl
