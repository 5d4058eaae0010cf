// shapes.cpp: lists the shapes of a world and their triangles for programs. The walk uses an
// explicit stack, so nesting costs no C++ stack.
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "behaviour/viewer/descend.h"
#include "event/hierarchy.h"
#include "geometry/clip_planes.h"
#include "geometry/mesh.h"
#include "geometry/sphere_facets.h"
#include "graph/inline_node.h"
#include "nodes/visible.h"
#include "xvrml/build.h"

namespace xvrml {
namespace {

constexpr size_t maximumVisits = 4'000'000;

// Appends the children of a node that the viewer sees.
void appendVisibleChildren(Node& node, const Matrix& toWorld, const Matrix& view,
                           std::vector<Node*>& parts) {
  if (const auto* lod = nodeCast<nodes::LOD>(&node)) {
    if (!lod->level.empty()) parts.push_back(lod->level[levelFor(*lod, toWorld, view)].get());
  } else if (const auto* choice = nodeCast<nodes::Switch>(&node)) {
    if (choice->whichChoice >= 0 && size_t(choice->whichChoice) < choice->choice.size())
      parts.push_back(choice->choice[size_t(choice->whichChoice)].get());
  } else if (const auto* collision = nodeCast<nodes::Collision>(&node)) {
    for (const NodeRef& child : collision->children) parts.push_back(child.get());
  } else if (const auto* layer = nodeCast<nodes::CADLayer>(&node)) {
    appendShownChildren(*layer, parts);
  } else {
    childrenInHierarchy(node, parts);
  }
}

// A half-space of world coordinates in those of a shape.
std::array<double, 4> keptInside(const HalfSpace& halfSpace, const Matrix& toWorld) {
  const HalfSpace local = inside(halfSpace, toWorld);
  return {local.normal.x, local.normal.y, local.normal.z, local.offset};
}

// Appends what the ClipPlanes among the children leave, in world coordinates. toWorld: matrix of
// the children.
void appendHalfSpaces(const std::vector<Node*>& children, const Matrix& toWorld, HalfSpaces& kept) {
  Matrix toLocal;
  if (!invert(toWorld, toLocal)) return;
  size_t planes = kept.size();
  forEachHalfSpace(children, planes,
                   [&](const HalfSpace& left) { kept.push_back(inside(left, toLocal)); });
}

} // namespace

NodeRef makeNode(const NodeType& type) {
  if (!type.create || type.name == "Script") return {};
  return makeStaticNode(type);
}

std::vector<PlacedShape> placedShapes(const World& world, const double* view) {
  constexpr uint32_t none = ~0u;
  struct Visit {
    Node* node;
    uint32_t parent; // index into `ancestors`
  };
  const Matrix viewer = view ? fromArray(view) : Matrix();
  std::vector<PlacedShape> shapes;
  std::vector<Visit> open;
  std::vector<Matrix> ancestors; // world matrices from a root down to the current node
  std::vector<Node*> path;       // the nodes of `ancestors`
  std::vector<HalfSpaces> kept;  // what ClipPlanes leave below them, in world coordinates
  std::vector<Node*> parts;
  const auto& roots = world.scope.roots;
  for (size_t i = roots.size(); i-- > 0;)
    if (roots[i]) open.push_back({roots[i].get(), none});
  HalfSpaces ofRoots;
  for (const NodeRef& root : roots) parts.push_back(root.get());
  appendHalfSpaces(parts, Matrix(), ofRoots);
  for (size_t visits = 0; !open.empty(); ++visits) {
    if (visits == maximumVisits)
      throw std::length_error("the world has more than 4,000,000 nodes where they are drawn");
    const Visit visit = open.back();
    open.pop_back();
    ancestors.resize(visit.parent + 1); // none + 1 is 0
    path.resize(visit.parent + 1);
    kept.resize(visit.parent + 1);
    const HalfSpaces& above = visit.parent == none ? ofRoots : kept[visit.parent];
    const Matrix outside = visit.parent == none ? Matrix() : ancestors[visit.parent];
    if (!isVisible(*visit.node)) continue;
    // A program may have made a node that contains itself; it is skipped.
    if (std::find(path.begin(), path.end(), visit.node) != path.end()) continue;
    if (auto* shape = nodeCast<nodes::Shape>(visit.node)) {
      Node* geometry = renderedNode(shape->geometry.get());
      if (!geometry) continue;
      shapes.push_back({NodeRef(shape), NodeRef(geometry), {}});
      toArray(outside, shapes.back().matrix);
      for (const HalfSpace& halfSpace : above)
        shapes.back().kept.push_back(keptInside(halfSpace, outside));
      continue;
    }
    Matrix inner;
    if (!innerMatrix(*visit.node, outside, viewer, inner) || !finite(inner)) continue;
    parts.clear();
    appendVisibleChildren(*visit.node, outside, viewer, parts);
    const auto index = uint32_t(ancestors.size());
    HalfSpaces below = above;
    appendHalfSpaces(parts, inner, below);
    ancestors.push_back(inner);
    path.push_back(visit.node);
    kept.push_back(std::move(below));
    for (size_t i = parts.size(); i-- > 0;)
      if (parts[i]) open.push_back({parts[i], index});
  }
  return shapes;
}

static GeometryArrays arraysOf(const Mesh& mesh, int sphereSteps) {
  if (mesh.kind == Mesh::Kind::sphere && sphereSteps > 1) {
    Mesh facets = sphereFacets(mesh.radius, uint32_t(sphereSteps));
    facets.solid = mesh.solid;
    GeometryArrays arrays = arraysOf(facets, 0);
    arrays.radius = mesh.radius;
    return arrays;
  }
  GeometryArrays arrays;
  arrays.kind = GeometryArrays::Kind(mesh.kind);
  static_assert(int(GeometryArrays::Kind::sphere) == int(Mesh::Kind::sphere));
  arrays.points.assign(mesh.points.begin(), mesh.points.end());
  arrays.indices.assign(mesh.indices.begin(), mesh.indices.end());
  arrays.normals.assign(mesh.normals.begin(), mesh.normals.end());
  arrays.texCoords.assign(mesh.texCoords.begin(), mesh.texCoords.end());
  arrays.colors.assign(mesh.colors.begin(), mesh.colors.end());
  arrays.solid = mesh.solid;
  arrays.ccw = mesh.ccw;
  arrays.radius = mesh.radius;
  return arrays;
}

static Mesh wholeMesh(Node& geometry, const Limits& limits) {
  return buildMesh(geometry, {.needTexCoords = true, .limits = &limits, .diagnostics = nullptr});
}

GeometryArrays geometryArrays(Node& geometry, int sphereSteps, const Limits& limits) {
  return arraysOf(wholeMesh(geometry, limits), sphereSteps);
}

GeometryArrays geometryArrays(const PlacedShape& shape, int sphereSteps, const Limits& limits) {
  const Mesh whole = wholeMesh(*shape.geometry, limits);
  HalfSpaces kept;
  for (const auto& [a, b, c, d] : shape.kept) kept.push_back({Vector(a, b, c), d});
  Mesh rest;
  switch (cut(whole, kept, limits.triangles, rest)) {
  case Cut::whole: return arraysOf(whole, sphereSteps);
  case Cut::part: return arraysOf(rest, sphereSteps);
  case Cut::nothing:
  case Cut::tooLarge: break;
  }
  return {};
}

} // namespace xvrml
