// graph.h: the render graph: what of a world is drawn, as few kinds of items, each once however often it is reached.
// Made by the mapper at its construction from the scene graph through a table of plans by node type; constant afterwards.
// Items stand in postorder (children before parents), so bottom-up passes are plain loops and depth costs no stack.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <unordered_map>
#include <vector>

#include "geometry/matrix.h"
#include "openrt/meshes.h"
#include "xvrml/node.h"
#include "xvrml/world.h"

namespace xvrml::mapping {

enum class Kind : uint8_t {
  none,
  group,
  shape,
  billboard,
  lod,
  directionalLight,
  localLight,
  viewpoint,
  background,
  fog,
  navigationInfo
};
constexpr bool isBindable(Kind k) { return k >= Kind::viewpoint; }
constexpr bool isLight(Kind k) { return k == Kind::directionalLight || k == Kind::localLight; }

using ItemId = uint32_t;
inline constexpr int32_t none = -1;

struct Item {
  Node* node = nullptr; // what is rendered; an instance's body node for a prototype; null for the root
  Kind kind = Kind::none;
  bool isInline = false;    // an Inline's content begins here
  bool placed = false;      // holds something whose meaning depends on its place: lights, bindables, billboards, LODs
  bool lines = false;       // holds lines or points: their width depends on the place
  bool shared = false;      // becomes an object of its own that is instantiated wherever it is reached
  bool scopesLight = false; // a DirectionalLight among its children
  int32_t matrix = none;    // in Graph::matrices
  uint32_t firstChild = 0, childCount = 0; // in Graph::children
  uint32_t name = 0;                       // in Graph::names; 0: none
  int32_t mesh = none;                     // shape: in Meshes
  uint64_t triangles = 0;                  // with everything below expanded, saturating
  uint64_t primitives = 0;                 // triangles, segments, points, spheres
  uint64_t shapes = 0;
  uint64_t places = 0; // items with `placed` when expanded, saturating
};

// What a plan says about one node.
struct Plan {
  Kind kind = Kind::none;
  bool isInline = false;
  bool keepEmpty = false; // children are kept at their index even if nothing is drawn for them (LOD)
  bool moves = false;     // matrix is meant
  Matrix matrix;
  std::vector<Node*> children; // as in the file: prototype instances allowed, null allowed

  void add(const MFNode& nodes) {
    for (const NodeRef& n : nodes) children.push_back(n.get());
  }
};

struct PlanContext {
  World& world;
};

using PlanFunction = void (*)(PlanContext& context, Node& node, Plan& plan);
// By node type index; null: nothing is drawn for the node. A plug-in's node type joins with setPlan.
PlanFunction planOf(const NodeType& type);
void setPlan(const NodeType& type, PlanFunction plan);

struct Graph {
  std::vector<Item> items; // items[0] is the empty item
  std::vector<ItemId> children;
  std::vector<Matrix> matrices;
  std::vector<std::string> names; // [0] is ""
  ItemId root = 0;
  Meshes meshes;

  explicit Graph(World& world);
  const ItemId* begin(const Item& item) const { return children.data() + item.firstChild; }
  Matrix matrixOf(const Item& item) const { return item.matrix == none ? Matrix() : matrices[size_t(item.matrix)]; }
  uint32_t nameId(const std::string& name);

 private:
  std::unordered_map<std::string, uint32_t> nameIds_;
};

// Fills in triangles, placed, lines, shared ... once the meshes are known. See summary.cpp for the rules of sharing.
void summarise(Graph& graph, Diagnostics& diagnostics);

inline uint64_t addSaturating(uint64_t a, uint64_t b) {
  return a > std::numeric_limits<uint64_t>::max() - b ? std::numeric_limits<uint64_t>::max() : a + b;
}
inline uint64_t multiplySaturating(uint64_t a, uint64_t b) {
  return b != 0 && a > std::numeric_limits<uint64_t>::max() / b ? std::numeric_limits<uint64_t>::max() : a * b;
}

} // namespace xvrml::mapping
