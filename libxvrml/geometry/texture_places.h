// texture_places.h: texture coordinates in space (ISO/IEC 19775-1 clause 33). Pure functions, on
// the thread that owns the nodes.
#pragma once

#include "geometry/mesh.h"
#include "xvrml/node.h"

namespace xvrml {

// Returns whether a geometry has a TextureCoordinate3D or TextureCoordinate4D.
bool hasTexPlaces(Node& geometry);

// Gives a mesh the texture coordinates that volumes need, if the options ask for them. Without a
// texCoord the bounding box of the geometry is the volume, with r from the front to the back
// (33.2.4). A sphere, and what the ray tracer would draw by an equation, becomes triangles.
void placeInVolume(Node& geometry, const MeshOptions& options, Mesh& mesh);

} // namespace xvrml
