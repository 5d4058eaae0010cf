// mesh.cpp: chooses the builder of a geometry node and sets the views of a Mesh to its own arrays.
#include "geometry/mesh.h"

#include <algorithm>
#include <cmath>

#include "geometry/builders.h"
#include "geometry/texture_generator.h"
#include "geometry/texture_places.h"
#include "geometry/thick.h"
#include "xvrml/deformed.h"
#include "xvrml/world.h"

namespace xvrml {

void Mesh::viewOwn() {
  points = ownPoints;
  indices = ownIndices;
  normals = ownNormals;
  texCoords = ownTexCoords;
  texPlaces = ownTexPlaces;
  colors = ownColors;
  alphas = ownAlphas;
  fogCoords = ownFogCoords;
}

namespace {
template <class T> void takeView(std::span<const T>& view, std::vector<T>& own) {
  if (view.data() == own.data()) return;
  own.assign(view.begin(), view.end());
  view = own;
}
} // namespace

void Mesh::takeAll() {
  takeView(points, ownPoints);
  takeView(indices, ownIndices);
  takeView(normals, ownNormals);
  takeView(texCoords, ownTexCoords);
  takeView(texPlaces, ownTexPlaces);
  takeView(colors, ownColors);
  takeView(alphas, ownAlphas);
  takeView(fogCoords, ownFogCoords);
}

Coordinates coordinates(const NodeRef& node) {
  Coordinates result;
  Node* rendered = renderedNode(node.get());
  if (auto* coordinate = nodeCast<nodes::Coordinate>(rendered)) {
    result.points = drawnPoints(*coordinate);
  } else if (auto* exact = nodeCast<nodes::CoordinateDouble>(rendered)) {
    const std::span<const Vec3d> drawn = drawnPoints(*exact);
    result.own.reserve(drawn.size());
    for (const Vec3d& p : drawn) result.own.push_back({float(p.x), float(p.y), float(p.z)});
    result.points = result.own;
  }
  return result;
}

std::span<const Vec3f> normalVectors(const NodeRef& node) {
  auto* normal = nodeCast<nodes::Normal>(renderedNode(node.get()));
  return normal ? drawnNormals(*normal) : std::span<const Vec3f>();
}

ColorValues colorValues(const NodeRef& node) {
  ColorValues values;
  Node* rendered = renderedNode(node.get());
  if (auto* color = nodeCast<nodes::Color>(rendered)) {
    values.rgb = color->color;
  } else if (auto* withAlpha = nodeCast<nodes::ColorRGBA>(rendered)) {
    values.own.reserve(withAlpha->color.size());
    values.alphas.reserve(withAlpha->color.size());
    for (const ColorRGBA& c : withAlpha->color) {
      values.own.push_back({c.r, c.g, c.b});
      values.alphas.push_back(std::isfinite(c.a) ? std::clamp(c.a, 0.0f, 1.0f) : 1.0f);
    }
    values.rgb = values.own;
  }
  return values;
}

std::vector<float> fogCoordinates(const NodeRef& node, size_t points) {
  auto* given = nodeCast<nodes::FogCoordinate>(renderedNode(node.get()));
  if (!given || given->depth.empty()) return {};
  std::vector<float> shares(points);
  for (size_t i = 0; i < points; i++) {
    const float depth = given->depth[std::min<size_t>(i, given->depth.size() - 1)];
    shares[i] = std::isfinite(depth) ? depth : 0;
  }
  return shares;
}

bool hasVertexAlpha(Node& geometry) {
  Node* node = renderedNode(&geometry);
  if (!node) return false;
  const FieldInfo* field = node->type().find("color");
  if (!field || field->type != FieldType::SFNode) return false;
  return nodeCast<nodes::ColorRGBA>(
             renderedNode(static_cast<NodeRef*>(node->storage(*field))->get())) != nullptr;
}

namespace {

// Builds the mesh of a node if it has the type that the function takes. Returns whether it has.
using TryBuild = bool (*)(Node* node, const MeshOptions& options, Mesh& mesh, Faults& faults);

template <class T, Mesh (*build)(const T&, const MeshOptions&, Faults&)>
bool tryBuild(Node* node, const MeshOptions& options, Mesh& mesh, Faults& faults) {
  auto* typed = nodeCast<T>(node);
  if (typed) mesh = build(*typed, options, faults);
  return typed != nullptr;
}

// The builders of all geometry nodes, in the order of the list.
#define XVRML_TRY_BUILD(name) tryBuild<nodes::name, build##name>,
constexpr TryBuild builders[] = {XVRML_GEOMETRY_NODES(XVRML_TRY_BUILD)};
#undef XVRML_TRY_BUILD

} // namespace

Mesh buildMesh(Node& geometry, const MeshOptions& options) {
  Mesh mesh;
  Node* node = renderedNode(&geometry);
  if (!node) return mesh;
  Faults faults;
  for (const TryBuild build : builders)
    if (build(node, options, mesh, faults)) break;
  generateTextureCoordinates(*node, options, mesh);
  placeInVolume(*node, options, mesh);
  thicken(mesh, options, faults);
  faults.report(*node, options.diagnostics, triangleLimitName(options));
  return mesh;
}

} // namespace xvrml
