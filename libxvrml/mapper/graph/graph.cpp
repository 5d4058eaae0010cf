// graph.cpp: builds and updates the render graph. A work list holds the items that still have to be
// planned. A walk with an explicit stack then computes the order for the passes.
#include "mapper/graph/graph.h"

#include <algorithm>
#include <functional>

#include "geometry/edited.h"
#include "geometry/node_matrix.h"
#include "mapper/shading/appearance.h"
#include "nodes/visible.h"
#include "xvrml/nodes.h"
#include "xvrml/walk.h"

namespace xvrml::mapper {

Graph::Graph(World& world) : meshes(world), context_{world}, quota_(world, "nodes") {
  followEdits(world);
  items.resize(2);
  items[0].planned = true;
  names.emplace_back();
  shapes.push_back(0);
  planRoots();
  plan(root);
  settle();
}

ItemId Graph::find(const Node* node) const {
  const ItemId* known = known_.find(node);
  return known ? *known : 0;
}

void Graph::plan(ItemId item) {
  if (item == 0) return;
  items[item].planned = false;
  pending_.push_back(item);
}

bool Graph::planRoots() {
  const std::vector<NodeRef>& now = context_.world.scope.roots;
  if (roots_ == now) return false;
  roots_ = now;
  plan(root);
  return true;
}

Matrix Graph::matrixOf(const Item& item) {
  return item.node ? xvrml::matrixOf(*item.node) : Matrix();
}

Matrix Graph::below(const Matrix& outside, const Item& item) {
  if (!item.node || !hasMatrix(*item.node)) return outside;
  const Matrix matrix = matrixOf(item);
  return matrix == Matrix() ? outside : compose(outside, matrix);
}

Plan Graph::planFor(Node& node) {
  Plan plan;
  if (const PlanFunction function = planOf(node.type())) function(context_, node, plan);
  return plan;
}

// Geometry may be used by several Shapes, so their textures are collected first.
bool Graph::awaits(Node* changed) {
  if (!changed && roots_ == context_.world.scope.roots) return false;
  std::unordered_map<Node*, TextureNeed> found;
  std::vector<Node*> first{changed};
  if (!changed)
    for (const NodeRef& root : context_.world.scope.roots)
      first.push_back(renderedNode(root.get()));
  walk(first, [&](Node& node, std::vector<Node*>& open) {
    if (&node != changed && find(&node) != 0) return; // its changes are told of separately
    if (node.type().index == nodes::ClipPlane::typeIndex || !isVisible(node)) return;
    const Plan plan = planFor(node);
    for (Node* child : plan.children) open.push_back(renderedNode(child));
    if (plan.kind != Kind::shape) return;
    const auto& shape = static_cast<nodes::Shape&>(node);
    Node* const geometry = renderedNode(shape.geometry.get());
    if (!isSlowToBuild(*geometry)) return;
    TextureNeed& need = found[geometry];
    need = std::max(need, textureNeed(shape.appearance.get()));
  });
  bool any = false;
  for (const auto& [geometry, need] : found) any |= meshes.awaits(*geometry, need);
  return any;
}

void Graph::readSwitch(ItemId id) {
  Item& item = items[id];
  const Plan plan = planFor(*item.node);
  item.on = plan.on;
  item.scoped = plan.scoped;
}

ItemId Graph::newItem() {
  if (free_.empty()) {
    items.emplace_back();
    return ItemId(items.size() - 1);
  }
  const ItemId id = free_.back();
  free_.pop_back();
  return id;
}

// Returns the item of a node as written in the file; 0 if such nodes are never drawn.
ItemId Graph::itemFor(Node* written) {
  Node* node = renderedNode(written);
  if (!node || !planOf(node->type())) return 0;
  const auto [known, fresh] = known_.insert(node, 0);
  if (!fresh) return *known;
  if (!quota_.take(bytesOfItem, node->source)) return 0;
  const ItemId id = *known = newItem();
  items[id].node = NodeRef(node);
  items[id].name = nameId(node->defName.empty() ? written->defName : node->defName);
  pending_.push_back(id);
  return id;
}

void Graph::planItem(ItemId id) {
  Plan plan;
  if (id == root) {
    plan.kind = Kind::group;
    plan.add(context_.world.scope.roots);
  } else {
    Node& node = *items[id].node;
    if (isVisible(node)) plan = planFor(node);
  }
  std::vector<ItemId> children;
  children.reserve(plan.children.size());
  for (Node* written : plan.children)
    if (const ItemId child = itemFor(written); child != 0 || plan.keepEmpty)
      children.push_back(child); // this may reallocate `items`
  Item& item = items[id];
  item.planned = true;
  item.kind = plan.kind;
  item.hint = plan.hint;
  item.isInline = plan.isInline;
  item.awaited = plan.awaited;
  item.on = plan.on;
  item.scoped = plan.scoped;
  item.limitsLights = plan.limitsLights;
  item.children = children;
  int32_t mesh = none;
  if (auto* shape = nodeCast<nodes::Shape>(item.node); shape && item.kind == Kind::shape)
    mesh = meshes.add(*renderedNode(shape->geometry.get()), textureNeed(shape->appearance.get()));
  if (item.mesh != none) meshes.drop(item.mesh);
  item.mesh = mesh;
}

void Graph::settle() {
  for (const ItemId id : dropped_) free_.push_back(id);
  dropped_.clear();
  replanned_.clear();
  while (!pending_.empty()) {
    const ItemId id = pending_.back();
    pending_.pop_back();
    if (items[id].planned) continue;
    planItem(id);
    replanned_.push_back(id);
  }
  sortItems();
  linkParents();
  numberShapes();
  std::erase_if(replanned_, [&](ItemId id) { return !items[id].planned; });
}

// Walks from the root, children in their order. An edge to an item that is still open would close a
// cycle; it is removed.
void Graph::sortItems() {
  enum : uint8_t { unseen, open, done };
  struct Open {
    ItemId item;
    uint32_t next;
  };
  std::vector<uint8_t> state(items.size(), unseen);
  std::vector<Open> stack{{root, 0}};
  order.clear();
  state[root] = open;
  while (!stack.empty()) {
    Open& top = stack.back();
    Item& item = items[top.item];
    if (top.next == item.children.size()) {
      item.position = uint32_t(order.size());
      order.push_back(top.item);
      state[top.item] = done;
      stack.pop_back();
      continue;
    }
    ItemId& child = item.children[top.next++];
    if (child == 0 || state[child] == done) continue;
    if (state[child] == unseen) {
      state[child] = open;
      stack.push_back({child, 0});
      continue;
    }
    const Node& node = *items[child].node;
    context_.world.diagnostics.warn(node.source, "a " + node.type().name +
                                                     " node that contains itself is drawn once");
    child = 0;
  }
  for (ItemId id = root + 1; id < items.size(); ++id)
    if (state[id] == unseen && items[id].node) drop(id);
}

void Graph::drop(ItemId id) {
  Item& item = items[id];
  known_.erase(item.node.get());
  quota_.give(bytesOfItem);
  if (item.mesh != none) meshes.drop(item.mesh);
  if (item.number != 0) {
    shapes[item.number] = 0;
    freedNumbers_.push_back(item.number);
  }
  const int32_t part = item.part; // Objects removes it later
  item = Item();
  item.part = part;
  dropped_.push_back(id);
}

void Graph::linkParents() {
  for (const ItemId id : order) items[id].parentCount = 0;
  size_t links = 0;
  for (const ItemId id : order)
    for (const ItemId child : items[id].children)
      if (child != 0) {
        ++items[child].parentCount;
        ++links;
      }
  parents.resize(links);
  uint32_t first = 0;
  for (const ItemId id : order) {
    items[id].firstParent = first;
    first += items[id].parentCount;
    items[id].parentCount = 0;
  }
  for (const ItemId id : order)
    for (const ItemId child : items[id].children)
      if (child != 0) parents[items[child].firstParent + items[child].parentCount++] = id;
}

// A shape keeps its number for its lifetime. New shapes are numbered in file order and take numbers
// that were free before this update first.
void Graph::numberShapes() {
  std::sort(freeNumbers_.begin(), freeNumbers_.end(), std::greater<>());
  for (const ItemId id : order) {
    Item& item = items[id];
    if (item.kind != Kind::shape || item.number != 0) continue;
    if (freeNumbers_.empty()) {
      item.number = uint32_t(shapes.size());
      shapes.push_back(id);
    } else {
      item.number = freeNumbers_.back();
      freeNumbers_.pop_back();
      shapes[item.number] = id;
    }
  }
  freeNumbers_.insert(freeNumbers_.end(), freedNumbers_.begin(), freedNumbers_.end());
  freedNumbers_.clear();
}

std::vector<std::string> Graph::shapeNames() const {
  std::vector<uint32_t> nearest(items.size(), 0); // parents come after children in `order`
  for (size_t i = order.size(); i-- > 0;) {
    const Item& item = items[order[i]];
    uint32_t& name = nearest[order[i]];
    if (item.name != 0) name = item.name;
    for (size_t c = item.children.size(); c-- > 0;) nearest[item.children[c]] = name;
  }
  std::vector<std::string> out(shapes.size());
  for (size_t number = 1; number < shapes.size(); ++number)
    if (shapes[number] != 0)
      out[number] = nearest[shapes[number]] != 0 ? names[nearest[shapes[number]]] : "Shape";
  return out;
}

uint32_t Graph::nameId(const std::string& name) {
  if (name.empty()) return 0;
  const auto [it, fresh] = nameIds_.try_emplace(name, uint32_t(names.size()));
  if (fresh) names.push_back(name);
  return it->second;
}

} // namespace xvrml::mapper
