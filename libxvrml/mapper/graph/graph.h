// graph.h: the render graph: the drawn part of a world, reduced to a few kinds of items. Each item
// exists once, however many paths lead to it. The mapper builds it from the scene graph with a
// table of plan functions by node type. When the children of a node change, only that node is
// planned again. Bottom-up and top-down passes are plain loops over `order`, so nesting costs no
// stack.
#pragma once

#include <algorithm>
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
#include "xvrml/node_map.h"
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
  environmentLight,
  localFog,
  viewpoint,
  background,
  fog,
  navigationInfo,
  sensor,
  clipPlane
};
constexpr bool isBindable(Kind k) { return k >= Kind::viewpoint && k <= Kind::navigationInfo; }
constexpr bool isLight(Kind k) {
  return k >= Kind::directionalLight && k <= Kind::environmentLight;
}
// Lights and LocalFogs may be turned on and off, and hold for what is around them.
constexpr bool isSwitched(Kind k) { return isLight(k) || k == Kind::localFog; }

// The author's hint on a group: merge (ORTStatic) or instantiate (ORTInstance).
enum class Hint : uint8_t { none, merge, instantiate };

// The reason why an item has an object of its own at every place.
enum class ObjectReason : uint8_t {
  none,
  shared,     // the item is shared, and instances save memory
  wanted,     // the author asks for instances (ORTInstance)
  merged,     // the author merges the content (ORTStatic), which changes together
  clipped,    // ClipPlanes cut its content, which changes together
  transform,  // events move it
  children,   // events change its content
  appearance, // lines whose colour events change
  geometry    // lines whose geometry events change
};
constexpr bool isSplit(ObjectReason objectReason) { return objectReason > ObjectReason::shared; }

using ItemId = uint32_t;
inline constexpr int32_t none = -1;

// The children of an item. Most items have one or none, which take no memory of their own.
class Children {
 public:
  void operator=(const std::vector<ItemId>& items) {
    size_ = uint32_t(items.size());
    many_ = size_ > 1 ? std::make_unique<ItemId[]>(size_) : nullptr;
    std::copy(items.begin(), items.end(), begin());
  }
  size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  ItemId* begin() { return many_ ? many_.get() : &one_; }
  ItemId* end() { return begin() + size_; }
  const ItemId* begin() const { return many_ ? many_.get() : &one_; }
  const ItemId* end() const { return begin() + size_; }
  ItemId& operator[](size_t index) { return begin()[index]; }
  ItemId operator[](size_t index) const { return begin()[index]; }

 private:
  uint32_t size_ = 0;
  ItemId one_ = 0; // unused if `many_` is set
  std::unique_ptr<ItemId[]> many_;
};

struct Item {
  NodeRef node;      // the rendered node; a prototype instance's body node; null for the root
  Children children; // an LOD has one child per level, 0 for an empty level
  Kind kind = Kind::none;
  Hint hint = Hint::none;
  bool planned = false;
  bool isInline = false;     // an Inline's content begins here
  bool awaited = false;      // an Inline whose content is still to come
  bool on = true;            // for a light or a LocalFog: it is on
  bool scoped = false;       // for these: it holds only for what is below its parent group
  bool limitsLights = false; // lights below it shine at most on what is below it
  uint32_t name = 0;         // index into Graph::names; 0: none
  int32_t mesh = none;       // for a shape: index into Meshes
  uint32_t number = 0;       // for a shape: index into Graph::shapes, the value in the id channel

  // Computed by Graph::settle.
  uint32_t position = 0; // index into Graph::order
  // The range of Graph::parents. A parent that holds this item twice occurs twice.
  uint32_t firstParent = 0, parentCount = 0;

  // Computed by summarise.

  // Contains something that depends on its place: a light, bindable node, Billboard or LOD.
  bool placeDependent = false;
  bool lines = false; // contains lines or points; their width depends on the place
  bool draws = false; // contains, or may later contain, something to draw
  // Below an ORTStatic, or something above it has ClipPlanes: events on it cause no split.
  bool merged = false;
  bool clips = false;       // has ClipPlanes among its children
  bool clipped = false;     // below an item that clips, on some path: nothing of it is shared
  bool scopes = false;      // a light or a LocalFog below it holds only for what is below it
  bool holdsLights = false; // contains lights that shine beyond their parent group
  bool moves = false;       // events reach its matrix
  bool changes = false;     // events reach its children, or the content of a shape's own object
  bool recolored = false;   // for a shape: events reach its appearance field
  bool viaMesh = false;     // for a shape: drawn as an instance of its geometry's object
  ObjectReason objectReason = ObjectReason::none;
  uint64_t decisions = 0; // the decisions above packed into one word, as of the last summarise
  int32_t part = none;    // index into Objects of its own object
  uint64_t triangles = 0; // with all descendants expanded; saturating
  uint64_t shapes = 0;    // with all descendants expanded; saturating
  // Triangles, segments, points and spheres written where the item is expanded.
  uint64_t primitives = 0;
  uint64_t places = 0; // place-dependent items in the expansion; saturating
};

// The result of a plan function for one node.
struct Plan {
  Kind kind = Kind::none;
  Hint hint = Hint::none;
  bool isInline = false;
  bool awaited = false;        // an Inline whose content is still to come
  bool keepEmpty = false;      // children keep their index even if nothing is drawn for them (LOD)
  bool on = true;              // for a light or a LocalFog: it is on
  bool scoped = false;         // for these: it holds only for what is below its parent group
  bool limitsLights = false;   // lights below it shine at most on what is below it
  std::vector<Node*> children; // as in the file: may contain prototype instances and nulls

  void add(const MFNode& nodes) {
    for (const NodeRef& n : nodes) children.push_back(n.get());
  }
};

struct PlanContext {
  World& world;
};

using PlanFunction = void (*)(PlanContext& context, Node& node, Plan& plan);
// Returns the plan function of a node type; null if nothing is drawn for the type. The table of
// plans.cpp has them. Types of plug-ins have none: what their nodes expand to is planned instead
// (renderedNode() in xvrml/world.h).
PlanFunction planOf(const NodeType& type);

class Graph {
 public:
  explicit Graph(World& world);

  // Returns the item of a rendered node; 0 if it has none.
  ItemId find(const Node* node) const;
  // Marks an item so that the next settle() reads its children again.
  void plan(ItemId item);
  // Calls plan(root) if the roots of the world have changed. Returns whether they have.
  bool planRoots();
  // Returns whether a node that has changed, or one of the roots (null), is to be planned later,
  // because something new at or below it has a large mesh that a job builds. Begins these jobs.
  bool awaits(Node* changed);
  void readSwitch(ItemId item); // reads whether a light or a LocalFog is on
  // Plans marked and new items, drops unreachable ones and computes the order.
  void settle();
  // Items dropped by the last settle(); their slots stay empty until the next one.
  const std::vector<ItemId>& dropped() const { return dropped_; }
  // Items planned again by the last settle() and still reachable.
  const std::vector<ItemId>& replanned() const { return replanned_; }

  // Returns the matrix of an item, which is that of its node: it is computed when it is
  // needed, because a million matrices take more memory than time.
  static Matrix matrixOf(const Item& item);
  static Matrix below(const Matrix& outside, const Item& item);
  uint32_t nameId(const std::string& name);
  // Returns the name of each shape number: the DEF name of the shape, else of the nearest group
  // above its first place, else "Shape".
  std::vector<std::string> shapeNames() const;

  std::vector<Item> items;        // items[0] is the empty item, items[root] holds the world
  std::vector<ItemId> order;      // children before parents, in file order; the root is last
  std::vector<ItemId> parents;    // ranges of it are given by Item::firstParent and parentCount
  std::vector<std::string> names; // [0] is ""
  std::vector<ItemId> shapes; // by number; [0] is none; 0: the shape is gone and its number is free
  bool clips = false;         // some item clips; computed by summarise
  static constexpr ItemId root = 1;
  Meshes meshes;

 private:
  Plan planFor(Node& node);
  ItemId itemFor(Node* written);
  ItemId newItem();
  void planItem(ItemId id);
  void sortItems();
  void linkParents();
  void drop(ItemId id);
  void numberShapes();

  PlanContext context_;
  Quota quota_;
  NodeMap<ItemId> known_;
  std::unordered_map<std::string, uint32_t> nameIds_;
  std::vector<ItemId> pending_, free_, dropped_, replanned_;
  // Free shape numbers, and those that became free in this update. A new shape must not take one of
  // the latter: it would seem to have moved from the place of the old one.
  std::vector<uint32_t> freeNumbers_, freedNumbers_;
  std::vector<NodeRef> roots_;
};

// Computes the summary fields of all items: what events reach, counts, place dependence, own
// objects. The rules are in summary.cpp. Returns the items with a changed decision, including new
// items.
std::vector<ItemId> summarise(Graph& graph, Diagnostics& diagnostics);
// Recomputes only the triangle and shape counts, because geometry that events reach may have new
// ones.
void recount(Graph& graph);

} // namespace xvrml::mapper
