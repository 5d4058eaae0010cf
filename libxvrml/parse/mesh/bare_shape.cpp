// bare_shape.cpp: IndexedFaceSet, IndexedLineSet and PointSet of meshes.
#include "parse/mesh/bare_shape.h"

namespace xvrml {
namespace {

template <class T> void writeValues(NodeStream& nodes, std::string_view field,
                                    std::string_view type, std::string_view valueField,
                                    T&& values) {
  if (values.empty()) return;
  nodes.openIn(field, type);
  nodes.set(valueField, std::move(values));
  nodes.closeIn();
}

void writePositionsAndColors(NodeStream& nodes, MeshGeometry& geometry) {
  writeValues(nodes, "coord", "Coordinate", "point", std::move(geometry.points));
  writeValues(nodes, "color", "Color", "color", std::move(geometry.colors));
}

} // namespace

void writeFaces(NodeStream& nodes, MeshGeometry&& geometry) {
  nodes.open("IndexedFaceSet");
  if (!geometry.colorPerVertex && !geometry.colors.empty()) nodes.set("colorPerVertex", false);
  writePositionsAndColors(nodes, geometry);
  const bool smooth = geometry.normals.empty() && geometry.creaseAngle > 0;
  writeValues(nodes, "normal", "Normal", "vector", std::move(geometry.normals));
  writeValues(nodes, "texCoord", "TextureCoordinate", "point", std::move(geometry.texCoords));
  if (!geometry.ccw) nodes.set("ccw", false);
  if (!geometry.convex) nodes.set("convex", false);
  if (!geometry.solid) nodes.set("solid", false);
  if (smooth) nodes.set("creaseAngle", geometry.creaseAngle);
  nodes.set("coordIndex", std::move(geometry.coordIndex));
  if (!geometry.normalIndex.empty()) nodes.set("normalIndex", std::move(geometry.normalIndex));
  if (!geometry.texCoordIndex.empty())
    nodes.set("texCoordIndex", std::move(geometry.texCoordIndex));
  nodes.close();
}

void writeLines(NodeStream& nodes, MeshGeometry&& geometry) {
  nodes.open("IndexedLineSet");
  writePositionsAndColors(nodes, geometry);
  nodes.set("coordIndex", std::move(geometry.coordIndex));
  nodes.close();
}

void writePoints(NodeStream& nodes, MeshGeometry&& geometry) {
  nodes.open("PointSet");
  writePositionsAndColors(nodes, geometry);
  nodes.close();
}

void writeBareShape(NodeStream& nodes, BareShape&& shape) {
  const MeshKind kind = shape.kind;
  nodes.open("Shape", shape.name.empty() ? std::string_view() : nodes.define(shape.name, {}));
  nodes.openIn("appearance", "Appearance");
  nodes.openIn("material", "Material");
  if (kind != MeshKind::faces && shape.colors.empty()) nodes.set("emissiveColor", Color{1, 1, 1});
  nodes.closeIn();
  if (!shape.texture.empty()) {
    nodes.openIn("texture", "ImageTexture");
    nodes.setUrl(std::move(shape.texture));
    nodes.closeIn();
  }
  nodes.closeIn();
  nodes.openField("geometry");
  if (kind == MeshKind::faces)
    writeFaces(nodes, std::move(shape));
  else if (kind == MeshKind::lines)
    writeLines(nodes, std::move(shape));
  else
    writePoints(nodes, std::move(shape));
  nodes.closeField();
  nodes.close();
}

} // namespace xvrml
