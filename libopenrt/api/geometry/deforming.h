// deforming.h: decides when the tree of a mesh that deforms is built anew. Between that, backends
// refit the tree: they keep which triangles stand together and enlarge the boxes as needed. Called
// on the application's thread.
//
// The choice is part of the commit (Geometry::rest), so that all backends, a recording and a worker
// that joins late have the same tree. It follows from the points alone.
#pragma once

#include "scene/commit.h"

namespace openrt {

// Returns whether a tree that was built of the points at rest has become so much more expensive for
// the points now that it should be built again. The arrays have the same size and are finite.
bool hasDeformedMuch(const Array& rest, const Array& now);

} // namespace openrt
