// shapes.cpp: lists the shapes of a world and their triangles for programs.
#include <algorithm>

#include "geometry/half_space.h"
#include "geometry/sphere_facets.h"
#include "graph/inline_node.h"
#include "render/arrays.h"
#include "xvrml/renderer.h"

namespace xvrml {
namespace {

struct ShapeCollector : Renderer {
  std::vector<PlacedShape> shapes;

  Visit renderShape(nodes::Shape& /*node*/, const RenderState& /*state*/) override {
    return Visit::draw;
  }
  void draw(const DrawnShape& shape) override {
    PlacedShape& placed =
        shapes.emplace_back(PlacedShape{NodeRef(&shape.shape), NodeRef(&shape.geometry), {}});
    std::copy_n(shape.matrix(), 16, placed.matrix);
    placed.kept = shape.kept();
  }
};

// Copies a mesh. A sphere becomes triangles first, if they are wanted.
GeometryArrays copyOf(Mesh& mesh, int sphereSteps) {
  GeometryArrays arrays;
  arrays.radius = mesh.radius;
  if (sphereSteps > 1) facetSphere(mesh, uint32_t(sphereSteps));
  arrays.kind = GeometryArrays::Kind(mesh.kind);
  static_assert(int(GeometryArrays::Kind::sphere) == int(Mesh::Kind::sphere));
  arrays.points.assign(mesh.points.begin(), mesh.points.end());
  arrays.indices.assign(mesh.indices.begin(), mesh.indices.end());
  arrays.normals.assign(mesh.normals.begin(), mesh.normals.end());
  arrays.texCoords.assign(mesh.texCoords.begin(), mesh.texCoords.end());
  arrays.colors.assign(mesh.colors.begin(), mesh.colors.end());
  arrays.alphas.assign(mesh.alphas.begin(), mesh.alphas.end());
  arrays.solid = mesh.solid;
  arrays.ccw = mesh.ccw;
  return arrays;
}

} // namespace

NodeRef makeNode(const NodeType& type) {
  if (!type.create || type.name == "Script") return {};
  return makeStaticNode(type);
}

std::vector<PlacedShape> placedShapes(const World& world, const double* view) {
  ShapeCollector collector;
  render(world, collector, {.view = view});
  return std::move(collector.shapes);
}

GeometryArrays arraysOf(Node& geometry, std::span<const std::array<double, 4>> kept,
                        int sphereSteps, const Limits& limits) {
  Mesh whole =
      buildMesh(geometry, {.needTexCoords = true, .limits = &limits, .diagnostics = nullptr});
  if (kept.empty()) return copyOf(whole, sphereSteps);
  HalfSpaces halfSpaces;
  for (const auto& [a, b, c, d] : kept) halfSpaces.push_back({Vector(a, b, c), d});
  Mesh rest;
  switch (cut(whole, halfSpaces, limits.triangles, rest)) {
  case Cut::whole: return copyOf(whole, sphereSteps);
  case Cut::part: return copyOf(rest, sphereSteps);
  case Cut::nothing:
  case Cut::tooLarge: break;
  }
  return {};
}

GeometryArrays geometryArrays(Node& geometry, int sphereSteps, const Limits& limits) {
  return arraysOf(geometry, {}, sphereSteps, limits);
}

GeometryArrays geometryArrays(const PlacedShape& shape, int sphereSteps, const Limits& limits) {
  return arraysOf(*shape.geometry, shape.kept, sphereSteps, limits);
}

} // namespace xvrml
