// texture_generator.h: texture coordinates that a TextureCoordinateGenerator computes (ISO/IEC
// 19775-1 18.4.8), and the coordinates of a MultiTextureCoordinate (18.4.4).
#pragma once

#include "geometry/mesh.h"
#include "xvrml/node.h"

namespace xvrml {

// Returns the node that has the coordinates of the first picture: the node itself, or the first of
// a MultiTextureCoordinate. Prototype instances are resolved; null: none.
Node* firstTextureCoordinate(const NodeRef& texCoord);

// Returns the field texCoord of a geometry node, null if it has no such field.
const NodeRef* texCoordOf(const Node& geometry);

// Returns whether cube maps on a geometry are looked up by its normal, not by the reflected ray.
bool looksUpByNormal(Node& geometry);

// Replaces the texture coordinates, also those in space, of a mesh of triangles if its geometry has
// a TextureCoordinateGenerator, and warns of what its mode cannot be here.
void generateTextureCoordinates(Node& geometry, const MeshOptions& options, Mesh& mesh);

} // namespace xvrml
