// plain_triangles.h: the fast path for large sets of triangles whose points each are one vertex:
// the mesh uses the arrays of the nodes as they are. A FaceSet with such arrays would give the same
// mesh. Stateless; any thread.
#pragma once

#include "geometry/polygons/face_set.h"

namespace xvrml {

struct PlainTriangles {
  std::span<const int32_t> index; // points of the corners
  bool ended = false;             // each triangle ends with -1; that of the last may be missing
  float creaseAngle = 0;          // as in a FaceSet, for triangles without normals
  bool solid = true, ccw = true;
};

// Builds the mesh of triangles with the points and values of a set, which belong to the points in
// their order. Returns false if the node has anything else; then the mesh is built of the set.
bool buildPlain(const PlainTriangles& triangles, const FaceSet& set, const MeshOptions& options,
                Mesh& mesh);

} // namespace xvrml
