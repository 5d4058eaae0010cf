// descend.h: helpers for walks from the roots of a world down: the matrix of a node's children and
// the level of an LOD that the viewer sees. Pure functions.
#pragma once

#include <vector>

#include "geometry/matrix.h"
#include "xvrml/node.h"
#include "xvrml/nodes.h"

namespace xvrml {

// Computes `inner`, the world matrix of the node's children. toWorld: the world matrix of the node.
// view: the viewer's matrix, to which Billboards turn. local: if not null, receives the matrix from
// the children to the node; it must be the identity. Returns false if no child can be visible.
bool innerMatrix(const Node& node, const Matrix& toWorld, const Matrix& view, Matrix& inner,
                 Matrix* local = nullptr);

// Returns the level to show (clause 6.26); the first one if there are no ranges. The node must have
// levels.
size_t levelFor(const nodes::LOD& lod, const Matrix& toWorld, const Matrix& view);

// Appends what a node of the role `listing` draws: what its fields with `change children` hold; of
// a LayerSet, the layers of its order. Its other fields name nodes again, or hold what nothing
// draws. Returns false for nodes of every other type: all that they hold may be drawn.
bool appendPlaced(const Node& node, std::vector<Node*>& parts);
// Returns whether a child is drawn where its parent is: not if the parent only lists it.
bool isPlacedBy(const Node& parent, const Node& child);

// Appends the children of a CADLayer that its list `visible` shows.
void appendShownChildren(const nodes::CADLayer& layer, std::vector<Node*>& parts);

} // namespace xvrml
