// copied.h: copies of geometry nodes. A thread may build a mesh of a copy while the world goes on,
// because nobody else has the copy. [the thread that owns the original]
#pragma once

#include "xvrml/node.h"

namespace xvrml {

// Returns the length of the arrays that decide how many triangles a list of faces has, 0 for other
// geometry. It has no more triangles, and rarely more than a third.
uint64_t lengthOfFaces(const Node& geometry);

// Returns whether the mesh of a geometry node takes so long to build that a moving picture stands
// still meanwhile.
bool isSlowToBuild(const Node& geometry);

// Returns how many triangles a list of faces has at most, if none of its faces crosses itself. It
// reads the list.
uint64_t mostTriangles(const Node& geometry);

// Returns a copy of a rendered geometry node, with copies of the Coordinate and the like that it
// holds. buildMesh() makes the same mesh of it. Returns null for a node that cannot be copied so: a
// figure moves its points, or it is no list of faces.
NodeRef copyOfGeometry(const Node& geometry);

} // namespace xvrml
