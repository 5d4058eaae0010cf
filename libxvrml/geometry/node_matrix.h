// node_matrix.h: the matrix that a node gives its children, as a Transform does. Code
// that walks down to what is drawn asks here, so that all of it knows the same nodes. Pure
// functions, any thread that owns the nodes.
#pragma once

#include "geometry/matrix.h"
#include "xvrml/node.h"

namespace xvrml {

// Returns whether nodes of this type place their children with a matrix.
bool hasMatrix(const Node& node);
// Returns the matrix of a node; the identity if hasMatrix is false.
Matrix matrixOf(const Node& node);

// Returns the matrix of a TextureTransform, TextureTransform3D or TextureTransformMatrix3D for
// (s, t, r, q); the identity for null.
Matrix textureMatrixOf(const Node* textureTransform);

// Returns the matrix from geocentric metres to the coordinates of the world that holds the node
// (GlobeOrigin).
Matrix globeToWorld(const Node& node);

} // namespace xvrml
