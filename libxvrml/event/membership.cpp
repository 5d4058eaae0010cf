// membership.cpp: membership in a running world: adoption of nodes and scopes, parents, and the
// removal of nodes.
#include <algorithm>
#include <new>
#include <utility>

#include <fmt/format.h>

#include "event/engine.h"
#include "event/hierarchy.h"
#include "graph/field_access.h"
#include "graph/inline_node.h"
#include "graph/node_kinds.h"
#include "xvrml/walk.h"

namespace xvrml {

namespace {

// Adds or deletes the routes between the file of an Inline and the nodes that it imports from the
// content.
template <class Edit>
void eachImportedRoute(const Node& inlineNode, Diagnostics& diagnostics, const Edit& edit) {
  const auto* node = nodeCast<InlineNode>(&inlineNode);
  const std::shared_ptr<Exchange> importer = node ? node->importer.lock() : nullptr;
  if (!importer || !node->content) return;
  for (const ResolvedRoute& route : resolveImports(*importer, node, diagnostics)) edit(route);
}

void connectImports(Engine& engine, const Node& inlineNode) {
  eachImportedRoute(inlineNode, engine.diagnostics(), [&](const ResolvedRoute& route) {
    engine.addRoute(*route.from, route.out->name, *route.to, route.in->name);
  });
}

} // namespace

struct Engine::AdoptedNodes {
  std::vector<NodeRef> nodes; // in the order of the files
  std::vector<ProtoInstance*> instances;
  std::vector<const Scope*> scopes;
};

Live& Engine::makeLive(Node& node) {
  auto made = std::make_unique<Live>();
  made->engine = this;
  made->node = &node;
  made->slot = uint32_t(lives_.size());
  made->order = order_;
  lives_.push_back(made.get());
  ++order_;
  Live* const live = made.release();
  node.live = live;
  return *live;
}

Engine::~Engine() {
  // Links may hold the last reference to a node, so they are destroyed after all nodes have been
  // detached from the engine.
  for (Live* live : lives_) live->node->live = nullptr;
  for (Live* live : std::exchange(lives_, {})) delete live;
}

// Called when a node is about to be destroyed. Its children still exist.
void Engine::forget(LiveBase* base) noexcept {
  auto* live = static_cast<Live*>(base);
  Engine& engine = *live->engine;
  try {
    std::vector<Node*> children;
    childrenInHierarchy(*live->node, children);
    for (Node* child : children)
      if (child && child->live) engine.unlinkChild(*live->node, *child);
  } catch (const std::bad_alloc&) { // no node may keep it as a parent
    for (Live* other : engine.lives_) other->parents.removeAll(live->node);
    ++engine.structure_;
  }
  engine.ticking_.erase(live->order);
  engine.looking_.erase(live->order);
  if (engine.deforming_.erase(live->order) > 0) engine.figuresOutdated_ = true;
  engine.observer->forgotten(*live->node);
  if (auto* instance = nodeCast<ProtoInstance>(live->node)) engine.disconnectBody(*instance);
  if (auto* script = nodeCast<ScriptNode>(live->node); script && engine.scripts)
    engine.scripts->end(*script);
  engine.lives_[live->slot] = engine.lives_.back();
  engine.lives_[live->slot]->slot = live->slot;
  engine.lives_.pop_back();
  live->node->live = nullptr;
  std::unique_ptr<Participant> part = std::move(live->part);
  delete live;
  if (part) engine.destroyLater(std::move(part));
}

// Destroys a node's links. A link may hold the last reference to the next node, and so on along a
// chain of routes. The queue destroys them one after the other instead of recursively.
void Engine::destroyLater(std::unique_ptr<Participant> part) noexcept {
  try {
    pendingDestruction_.push_back(std::move(part));
  } catch (const std::bad_alloc&) { return; } // no memory for the queue: fall back to recursion
  if (std::exchange(destroying_, true)) return;
  while (!pendingDestruction_.empty()) {
    const std::unique_ptr<Participant> next = std::move(pendingDestruction_.back());
    pendingDestruction_.pop_back();
  }
  destroying_ = false;
}

Parents::~Parents() {
  if (hasList()) delete list();
}

void Parents::push_back(Node* parent) {
  if (!one_) {
    one_ = parent;
  } else if (hasList()) {
    list()->push_back(parent);
  } else {
    auto more = std::make_unique<std::vector<Node*>>(1, one_);
    more->push_back(parent);
    bits_ = reinterpret_cast<uintptr_t>(more.release()) | 1;
  }
}

void Parents::removeLast(const Node* parent) {
  if (!hasList()) {
    if (one_ == parent) one_ = nullptr;
    return;
  }
  const auto found = std::find(list()->rbegin(), list()->rend(), parent);
  if (found != list()->rend()) list()->erase(std::next(found).base());
}

void Parents::removeAll(const Node* parent) noexcept {
  if (hasList())
    std::erase(*list(), parent);
  else if (one_ == parent)
    one_ = nullptr;
}

void Engine::linkChild(Node& parent, Node& child) {
  liveOf(child)->parents.push_back(&parent);
  ++structure_;
}

void Engine::unlinkChild(Node& parent, Node& child) {
  ++structure_;
  liveOf(child)->parents.removeLast(&parent);
}

// Collects a node and its descendants, without recursion.
void Engine::collect(Node& first, AdoptedNodes& adopted) {
  std::vector<Node*> open{&first}, below;
  while (!open.empty()) {
    Node& node = *open.back();
    open.pop_back();
    if (node.live) continue;
    makeLive(node);
    adopted.nodes.emplace_back(&node);
    below.clear();
    if (const Scope* content = inlineScope(node)) adopted.scopes.push_back(content);
    if (auto* instance = nodeCast<ProtoInstance>(&node)) {
      adopted.instances.push_back(instance);
      adopted.scopes.push_back(&instance->body);
      for (size_t i = 1; i < instance->body.roots.size(); ++i)
        below.push_back(instance->body.roots[i].get());
      for (const IsConnection& c : instance->is) below.push_back(c.node.get());
    }
    if (node.type().index < 0 || node.type().expand)
      forEachChild(node, [&](NodeRef& child, const FieldInfo&) { below.push_back(child.get()); });
    childrenInHierarchy(node, below);
    std::reverse(below.begin(), below.end());
    for (Node* child : below)
      if (child && !child->live) open.push_back(child);
  }
}

void Engine::collectScope(const Scope& scope, AdoptedNodes& adopted) {
  for (const NodeRef& root : scope.roots)
    if (root) collect(*root, adopted);
  adopted.scopes.push_back(&scope);
}

// Adds the collected nodes: first parents, then links of prototype bodies, routes and behaviours.
// Each step needs the one before it for all nodes.
void Engine::complete(AdoptedNodes& adopted) {
  std::vector<Node*> below;
  for (size_t done = 0, scopes = 0;
       done < adopted.nodes.size() || scopes < adopted.scopes.size();) {
    for (; done < adopted.nodes.size(); ++done) {
      below.clear();
      childrenInHierarchy(*adopted.nodes[done], below);
      for (Node* child : below)
        if (child) linkChild(*adopted.nodes[done], *child);
    }
    // A route may hold nodes that nothing else holds.
    for (; scopes < adopted.scopes.size(); ++scopes) {
      for (const Route& route : adopted.scopes[scopes]->routes) {
        if (route.from) collect(*route.from, adopted);
        if (route.to) collect(*route.to, adopted);
      }
    }
  }
  for (ProtoInstance* instance : adopted.instances) connectBody(*instance);
  for (const Scope* scope : adopted.scopes)
    for (const Route& route : scope->routes)
      if (route.from && route.to) addRoute(*route.from, route.fromField, *route.to, route.toField);
  for (const NodeRef& node : adopted.nodes)
    if (node->type().index == nodes::Inline::typeIndex) connectImports(*this, *node);
  for (const NodeRef& node : adopted.nodes) {
    if (auto* script = nodeCast<ScriptNode>(node)) {
      if (!scripts) continue;
      scripts->begin(*script);
      scriptsToStart_ = true;
    } else if (const Behaviour* behaviour = behaviourOf(node->type());
               behaviour && behaviour->begin) {
      part(*node).state = behaviour->begin(*this, *node);
    }
  }
  addFigures(adopted.nodes);
}

void Engine::adoptScope(const Scope& scope, bool roots) {
  AdoptedNodes adopted;
  collectScope(scope, adopted);
  if (roots)
    for (const NodeRef& root : scope.roots)
      if (root) liveOf(*root)->root = true;
  complete(adopted);
  if (roots) observer->began(scope);
}

void Engine::adopt(Node& node) {
  if (node.live) return;
  AdoptedNodes adopted;
  collect(node, adopted);
  complete(adopted);
}

void Engine::contentLoaded(Node& inlineNode) {
  const Scope* content = inlineScope(inlineNode);
  if (!content || !inlineNode.live) return;
  adoptScope(*content, false);
  for (const NodeRef& root : content->roots)
    if (root) linkChild(inlineNode, *root);
  connectImports(*this, inlineNode);
}

// Routes hold their nodes, and those of the old content would keep it alive. An Inline that shares
// its content has no routes.
void Engine::contentUnloading(Node& inlineNode) {
  const Scope* content = inlineScope(inlineNode);
  if (!content || !inlineNode.live) return;
  eachImportedRoute(inlineNode, diagnostics_, [&](const ResolvedRoute& route) {
    deleteRoute(*route.from, route.out->name, *route.to, route.in->name);
  });
  for (const Route& route : content->routes)
    if (route.from && route.to) deleteRoute(*route.from, route.fromField, *route.to, route.toField);
  for (const NodeRef& root : content->roots)
    if (root && root->live) unlinkChild(inlineNode, *root);
}

void Engine::keepOnly(const std::vector<NodeRef>& kept) {
  SeenNodes marked;
  std::vector<Node*> first;
  for (const NodeRef& node : kept) first.push_back(node.get());
  walk(std::move(first), marked, [](Node& node, std::vector<Node*>& open) {
    if (!node.live) return;
    childrenInHierarchy(node, open);
    if (node.type().index < 0) appendChildren(node, open);
    if (const auto* instance = nodeCast<ProtoInstance>(&node)) {
      appendRoots(instance->body, open);
      for (const IsConnection& c : instance->is) open.push_back(c.node.get());
    }
    if (!liveOf(node)->part) return;
    for (const Link& link : liveOf(node)->part->links) {
      open.push_back(link.to.get());
      open.push_back(link.instance);
    }
  });
  queue_.clear();
  std::vector<NodeRef> others;
  for (Live* live : lives_) {
    live->root = false;
    live->changed = 0;
    if (!marked.contains(live->node)) others.emplace_back(live->node);
  }
  for (const NodeRef& node : others)
    if (node->live) forget(node->live);
  changes_.clear();
  ++structure_;
  if (scripts) scripts->finish();
}

void Engine::addRoot(Node& node) {
  adopt(node);
  liveOf(node)->root = true;
  rootsChanged();
}

void Engine::removeRoot(Node& node) {
  if (node.live) liveOf(node)->root = false;
  rootsChanged();
}

void Engine::rootsChanged() {
  ++structure_;
  figuresOutdated_ = figuresOutdated_ || !deforming_.empty();
  const bool known =
      std::any_of(changes_.begin(), changes_.end(), [](const FieldChange& c) { return !c.node; });
  if (!known) changes_.push_back({NodeRef(), nullptr});
}

// Returns whether a new child of `parent` would have `parent` as a descendant.
bool Engine::wouldCreateCycle(Node& parent, const Value& value) {
  SeenNodes above;
  walk(std::vector<Node*>{&parent}, above,
       [](Node& node, std::vector<Node*>& open) { holdersOf(node, open); });
  const auto inside = [&](const NodeRef& child) { return child && above.contains(child.get()); };
  if (const auto* one = std::get_if<NodeRef>(&value)) return inside(*one);
  const auto& many = std::get<MFNode>(value);
  return std::any_of(many.begin(), many.end(), inside);
}

bool Engine::store(Node& node, const FieldInfo& field, Value value) {
  if (!holdsValue(field) || value.index() != size_t(field.type)) return false;
  if (holdsNodes(field)) {
    const bool inHierarchy = node.type().index >= 0 && !node.type().expand;
    const auto refused = [&](const NodeRef& child) {
      const NodeType* type = child ? effectiveType(*child) : nullptr;
      if (!type || field.nodeTypes.empty() || typeAccepted(field.nodeTypes, *type)) return false;
      diagnostics_.warn(node.source, fmt::format("{} of {} takes {}, not {}", field.name,
                                                 node.type().name, field.nodeTypes, type->name));
      return true;
    };
    if (auto* one = std::get_if<NodeRef>(&value); one && refused(*one)) return false;
    const bool keeps = keepsNull(node.type()) || !inHierarchy;
    if (auto* many = std::get_if<MFNode>(&value))
      std::erase_if(*many, [&](const NodeRef& child) { return child ? refused(child) : !keeps; });
    if (inHierarchy && wouldCreateCycle(node, value)) {
      diagnostics_.warn(node.source, fmt::format("{} of {} would hold the node itself (4.4.4)",
                                                 field.name, node.type().name));
      return false;
    }
    const auto each = [](const Value& nodes, const auto& visit) {
      if (const auto* one = std::get_if<NodeRef>(&nodes); one && *one) visit(**one);
      if (const auto* many = std::get_if<MFNode>(&nodes))
        for (const NodeRef& child : *many)
          if (child) visit(*child);
    };
    each(value, [&](Node& child) { adopt(child); });
    const Value old = node.get(field);
    if (inHierarchy && node.live) {
      each(old, [&](Node& child) {
        if (child.live) unlinkChild(node, child);
      });
      each(value, [&](Node& child) { linkChild(node, child); });
    }
    node.set(field, std::move(value));
  } else {
    node.set(field, std::move(value));
  }
  if (auto* instance = nodeCast<ProtoInstance>(&node)) instance->give(field);
  mirror(node, field);
  changed(node, field);
  return true;
}

void Engine::changed(Node& node, const FieldInfo& field) {
  if (node.type().expand && node.live) outdated_.emplace_back(&node);
  if (field.change == Change::none || !node.live || node.type().index < 0) return;
  Live& live = *liveOf(node);
  figuresOutdated_ = figuresOutdated_ || !deforming_.empty();
  observer->changed(node, field);
  if (!reaches(node, field.change)) markReach(node, field, "it has been changed");
  const size_t index = size_t(&field - node.type().fields.data());
  if (index < 64) {
    if (live.changed >> index & 1) return;
    live.changed |= uint64_t(1) << index;
  }
  changes_.push_back({NodeRef(&node), &field});
}

FieldChanges Engine::takeChanges() {
  renewExpansions();
  moveFigures();
  for (const FieldChange& change : changes_)
    if (change.node && change.node->live) liveOf(*change.node)->changed = 0;
  return std::exchange(changes_, {});
}

} // namespace xvrml
