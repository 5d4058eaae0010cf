// bare_shape.h: writes the Shape of a mesh that has no more than geometry, colours and one picture.
// STL and PLY make it; OBJ writes its geometry in the same way. [the thread that loads]
#pragma once

#include "parse/mesh/node_stream.h"

namespace xvrml {

// Faces whose normals differ by less are shaded smoothly, where a file says nothing about it:
// 30 degrees, which keeps the edges of machine parts and rounds scanned surfaces.
inline constexpr float meshCreaseAngle = 0.5236f;

// Faces, lines or points over one list of positions. Empty lists are left out. Without an index of
// its own, an attribute has one value for each point.
struct MeshGeometry {
  MFVec3f points;
  MFInt32 coordIndex; // -1 ends a face or line
  MFVec3f normals;
  MFInt32 normalIndex;
  MFColor colors;
  bool colorPerVertex = true;
  MFVec2f texCoords;
  MFInt32 texCoordIndex;
  bool convex = true;
  bool solid = false;
  bool ccw = true;
  float creaseAngle = meshCreaseAngle;
};

// Write the node of the open field `geometry`.
void writeFaces(NodeStream& nodes, MeshGeometry&& geometry);
void writeLines(NodeStream& nodes, MeshGeometry&& geometry);
void writePoints(NodeStream& nodes, MeshGeometry&& geometry);

enum class MeshKind : uint8_t { faces, lines, points };

struct BareShape : MeshGeometry {
  MeshKind kind = MeshKind::faces;
  std::string_view name; // the name of the object in the file
  std::string texture;   // URL of a picture; empty: none
};

// Writes a Shape at the root of the file. Points and lines without colours emit white light,
// because no lamp lights them.
void writeBareShape(NodeStream& nodes, BareShape&& shape);

} // namespace xvrml
