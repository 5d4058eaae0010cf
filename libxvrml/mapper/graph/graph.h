// graph.h: the render graph: what of a world is drawn, as few kinds of items, each once however
// often it is reached. Made by the mapper from the scene graph through a table of plans by node
// type; a node whose children change is planned again, and nothing else. Bottom-up and top-down
// passes are plain loops over `order`: depth costs no stack.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

#include "geometry/matrix.h"
#include "mapper/graph/cost.h"
#include "mapper/meshes.h"
#include "mapper/ration.h"
#include "xvrml/node.h"
#include "xvrml/world.h"

namespace xvrml::mapper {

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

// What an author wants of a group: ORTStatic, ORTInstance.
enum class Hint : uint8_t { none, merge, instantiate };

// Why an item has an object of its own wherever it is reached.
enum class Own : uint8_t {
  none,
  shared,     // instances save memory
  wanted,     // ORTInstance
  merged,     // ORTStatic: what is below changes together
  transform,  // events move it
  children,   // events change what is in it
  appearance, // lines whose colour events change
  geometry    // lines whose geometry events change
};
constexpr bool isSplit(Own own) { return own > Own::shared; }

using ItemId = uint32_t;
inline constexpr int32_t none = -1;

struct Item {
  NodeRef node; // what is rendered; an instance's body node for a prototype; null for the root
  std::unique_ptr<Matrix> matrix; // null: identity
  std::vector<ItemId> children;   // of an LOD one a level, 0 for an empty one
  Kind kind = Kind::none;
  Hint hint = Hint::none;
  bool planned = false;
  bool isInline = false; // an Inline's content begins here
  bool awaited = false;  // an Inline whose content is still to come
  bool on = true;        // a light that shines
  uint32_t name = 0;     // in Graph::names; 0: none
  int32_t mesh = none;   // shape: in Meshes
  uint32_t number = 0;   // shape: in Graph::shapes, what the id channel shows

  // Made by Graph::settle.
  uint32_t position = 0; // in Graph::order
  uint32_t firstParent = 0,
           parentCount = 0; // in Graph::parents; a parent that holds it twice stands there twice

  // Made by summarise.
  bool placed = false; // holds something whose meaning depends on its place: lights, bindables,
                       // billboards, LODs
  bool lines = false;  // holds lines or points: their width depends on the place
  bool draws = false;  // holds, or may come to hold, something to draw
  bool merged = false; // below an ORTStatic: what events reach does not matter
  bool scopesLight = false; // a DirectionalLight among its children
  bool moves = false;       // events reach its matrix
  bool changes = false;     // events reach its children, or what a shape's own object holds
  bool recolored = false;   // shape: events reach its appearance field
  bool viaMesh = false;     // shape: an instance of its geometry's object
  Own own = Own::none;
  uint64_t decisions = 0; // all of these in a word, as they last were
  int32_t part = none;    // of Objects: the object of its own
  uint64_t triangles = 0; // with everything below expanded, saturating
  uint64_t shapes = 0;    // likewise
  uint64_t primitives =
      0; // triangles, segments, points, spheres that are written where it is written out
  uint64_t places = 0; // items with `placed` when expanded, saturating
};

// What a plan says about one node.
struct Plan {
  Kind kind = Kind::none;
  Hint hint = Hint::none;
  bool isInline = false;
  bool awaited = false; // an Inline whose content is still to come
  bool keepEmpty =
      false;      // children are kept at their index even if nothing is drawn for them (LOD)
  bool on = true; // of a light
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
// By node type index; null: nothing is drawn for the node. A plug-in's node type joins with
// setPlan.
PlanFunction planOf(const NodeType& type);
void setPlan(const NodeType& type, PlanFunction plan);

class Graph {
 public:
  explicit Graph(World& world);

  // The item of a rendered node; 0: it has none.
  ItemId find(const Node* node) const;
  // Its children are to be read again by the next settle().
  void plan(ItemId item);
  // As plan(root) if the roots of the world are others than before.
  bool planRoots();
  // Only the matrix; false if the node has none that can change alone.
  bool readMatrix(ItemId item);
  void readLight(ItemId item);
  // Plans what is to be planned and what is new, drops what is not reached any more, orders.
  void settle();
  const std::vector<ItemId>& dropped() const {
    return dropped_;
  } // by the last settle(); empty items until the next one
  const std::vector<ItemId>& replanned() const {
    return replanned_;
  } // by the last settle(); those that are still there

  Matrix matrixOf(const Item& item) const { return item.matrix ? *item.matrix : Matrix(); }
  Matrix below(const Matrix& outside, const Item& item) const {
    return item.matrix ? compose(outside, *item.matrix) : outside;
  }
  uint32_t nameId(const std::string& name);
  // Returns for each number of a shape its DEF name, else that of the nearest group above its first
  // place, else "Shape".
  std::vector<std::string> shapeNames() const;

  std::vector<Item> items;     // items[0] is the empty item, items[root] holds the world
  std::vector<ItemId> order;   // children before parents, in the order of the file; the root last
  std::vector<ItemId> parents; // see Item::firstParent
  std::vector<std::string> names; // [0] is ""
  std::vector<ItemId>
      shapes; // by number, [0] is none; 0: the shape has gone and its number is free
  static constexpr ItemId root = 1;
  Meshes meshes;

 private:
  ItemId itemFor(Node* written);
  ItemId newItem();
  void planItem(ItemId id);
  void sortItems();
  void linkParents();
  void drop(ItemId id);
  void numberShapes();

  PlanContext context_;
  Ration ration_;
  std::unordered_map<const Node*, ItemId> known_;
  std::unordered_map<std::string, uint32_t> nameIds_;
  std::vector<ItemId> pending_, free_, dropped_, replanned_;
  std::vector<uint32_t> freeNumbers_; // of shapes
  std::vector<NodeRef> roots_;
};

// Fills in what events reach, triangles, placed, own ... of all items. See summary.cpp for the
// rules. Returns the items for which a decision is another than before, new ones included.
std::vector<ItemId> summarise(Graph& graph, Diagnostics& diagnostics);
// Triangles and shapes alone: geometry that events reach may have other numbers of them.
void recount(Graph& graph);

} // namespace xvrml::mapper
