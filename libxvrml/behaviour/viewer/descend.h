// descend.h: where the children of a node stand and which of them a viewer sees: for walks from the
// roots of a world down. Pure functions.
#pragma once

#include "geometry/matrix.h"
#include "xvrml/node.h"
#include "xvrml/nodes.h"

namespace xvrml {

// Where children stand, seen from where the node stands. view: the viewer's, to whom Billboards
// turn. False if nothing of them can be seen.
bool innerMatrix(const Node& node, const Matrix& toWorld, const Matrix& view, Matrix& inner);

// The level that is shown (clause 6.26); without ranges the first one. The node has levels.
size_t levelFor(const nodes::LOD& lod, const Matrix& toWorld, const Matrix& view);

} // namespace xvrml
