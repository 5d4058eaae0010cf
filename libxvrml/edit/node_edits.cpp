#include "edit/node_edits.h"

#include <algorithm>
#include <iterator>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "graph/field_access.h"
#include "graph/node_kinds.h"
#include "xvrml/walk.h"

namespace xvrml {
namespace {

bool contains(const Node& root, const Node& searched) {
  return !walk(std::vector<const Node*>{&root}, [&](const Node& node, auto& open) {
    appendChildren(node, open);
    return &node != &searched;
  });
}

void refuseLoop(const Node& node, const Node& parent) {
  if (contains(node, parent))
    throw EditError(fmt::format("this {} would become a part of itself", node.type().name));
}

// Sets the nodes of a field of the live world.
void setLive(LiveWorld& live, const Slot& slot, Value value) {
  if (!live.set(*slot.parent.live, slot.field->name, std::move(value)))
    throw EditError(fmt::format("the running world does not take the nodes of {}.{}",
                                slot.parent.live->type().name, slot.field->name));
}

// Puts a node into a list of the live world, or takes it out.
void insertLive(LiveWorld& live, const Slot& slot, const NodeRef& node) {
  if (!slot.field) return live.addRoot(node, slot.liveIndex);
  refuseLoop(*node, *slot.parent.live); // undo: Scripts may have moved it since
  MFNode list = *static_cast<const MFNode*>(slot.parent.live->storage(*slot.field));
  list.insert(list.begin() + std::ptrdiff_t(std::min(slot.liveIndex, list.size())), node);
  setLive(live, slot, std::move(list));
}

void eraseLive(LiveWorld& live, const Slot& slot, const NodeRef& node) {
  if (!slot.field) return live.removeRoot(*node, slot.liveIndex);
  MFNode list = *static_cast<const MFNode*>(slot.parent.live->storage(*slot.field));
  size_t index = slot.liveIndex;
  if (index >= list.size() || list[index] != node) // Scripts may have moved it
    index = size_t(std::find(list.begin(), list.end(), node) - list.begin());
  if (index < list.size()) list.erase(list.begin() + std::ptrdiff_t(index));
  setLive(live, slot, std::move(list));
}

} // namespace

NodeEdits::Named NodeEdits::namedIn(const Twin& root) {
  constexpr uint64_t bytesOfNode = 500;
  Named named;
  walk(std::vector<Node*>{root.live.get()}, [&](Node& node, std::vector<Node*>& open) {
    appendChildren(node, open);
    named.bytes += bytesOfNode;
    if (node.defName.empty()) return;
    if (Node* const own = file_.document().find(node.source)) {
      named.twins.push_back({NodeRef(&node), NodeRef(own)});
      named.bytes += 2 * sizeof(Twin); // in both functions of the edit
    }
  });
  return named;
}

// Gives a name that several nodes have to the last of them, in the order of the file.
void NodeEdits::giveToLast(Scope& scope, const std::string& name) {
  std::vector<Node*> roots = rootsOf(scope);
  std::reverse(roots.begin(), roots.end()); // the walk begins with the last one
  Node* last = nullptr;
  walk(std::move(roots), [&](Node& node, std::vector<Node*>& open) {
    if (node.defName == name && file_.opened().find(node.source)) last = &node;
    const auto own = std::ptrdiff_t(open.size());
    appendChildren(node, open);
    std::reverse(open.begin() + own, open.end());
  });
  if (last) scope.names[name] = NodeRef(last);
}

// Brings the names of the live world and of the document up to date with the nodes that stand in
// the file.
void NodeEdits::updateNames(const std::vector<Twin>& named) {
  const auto update = [&](Scope& scope, const NodeRef& node, bool stands) {
    const auto known = scope.names.find(node->defName);
    if (stands && known == scope.names.end())
      scope.names.emplace(node->defName, node);
    else if (!stands && known != scope.names.end() && known->second == node)
      scope.names.erase(known);
  };
  Document& document = file_.opened();
  Scope* const live = file_.liveScope();
  for (const Twin& one : named) {
    const std::string& name = one.document->defName;
    const bool stands = document.stands(*one.document);
    if (live) update(*live, one.live, stands);
    update(document.scope(), one.document, stands);
    if (!document.isRepeated(name)) continue;
    if (live) giveToLast(*live, name);
    giveToLast(document.scope(), name);
  }
}

void NodeEdits::setSingle(const Slot& slot, const Twin& node) {
  const FieldInfo& own = *slot.parent.document->type().find(slot.field->name);
  const Twin before{*static_cast<const NodeRef*>(slot.parent.live->storage(*slot.field)),
                    *static_cast<const NodeRef*>(slot.parent.document->storage(own))};
  Named named = namedIn(node);
  Named gone = namedIn(before);
  std::move(gone.twins.begin(), gone.twins.end(), std::back_inserter(named.twins));
  const auto put = [this, slot, &own, named = std::move(named.twins)](const Twin& twin) {
    if (twin.live) refuseLoop(*twin.live, *slot.parent.live);
    setLive(file_.live(), slot, twin.live);
    file_.opened().setNode(*slot.parent.document, own, twin.document);
    updateNames(named);
  };
  history_.perform(
      {[put, node] { put(node); }, [put, before] { put(before); }, nullptr, "", gone.bytes});
}

// Puts a node into a list, or takes it out, in both worlds.
void NodeEdits::changeList(const Slot& slot, const Twin& node, bool inserts) {
  Named named = namedIn(node);
  const auto change = [this, slot, node, named = std::move(named.twins)](bool puts) {
    Node* const parent = slot.parent.document.get();
    if (puts) {
      insertLive(file_.live(), slot, node.live);
      file_.opened().insert(parent, slot.field, slot.index, node.document);
    } else {
      eraseLive(file_.live(), slot, node.live);
      file_.opened().erase(parent, slot.field, slot.index);
    }
    updateNames(named);
  };
  history_.perform({[change, inserts] { change(inserts); }, [change, inserts] { change(!inserts); },
                    nullptr, "", named.bytes});
}

void NodeEdits::place(const Slot& slot, const Twin& node) {
  if (Document& document = file_.document();
      !document.admits(slot.parent.document.get(), *node.document))
    throw EditError(fmt::format("{} cannot stand there: nodes would be nested deeper than limit "
                                "nesting={}",
                                node.live->type().name, document.mostNested()));
  if (slot.isSingle()) {
    const bool replaces = file_.nodeAt(slot) != nullptr;
    setSingle(slot, node);
    if (replaces) dropRoutes();
    return;
  }
  changeList(slot, node, true);
}

Twin NodeEdits::take(const Slot& slot) {
  const Twin node = file_.twinOf(*file_.nodeAt(slot));
  if (slot.isSingle()) {
    setSingle(slot, {});
    return node;
  }
  changeList(slot, node, false);
  return node;
}

void NodeEdits::checkPlace(const Slot& slot, const Twin& twin) {
  const Node& node = *twin.live;
  const NodeType* const type = effectiveType(node);
  const std::string_view accepted =
      slot.field ? std::string_view(slot.field->nodeTypes) : std::string_view("child");
  if (type && !accepted.empty() && !typeAccepted(accepted, *type))
    throw EditError(slot.field ? fmt::format("{} cannot be in field {} of {}: expected {}",
                                             node.type().name, slot.field->name,
                                             slot.parent.live->type().name, accepted)
                               : fmt::format("{} cannot stand at the root of a file: expected a "
                                             "child node",
                                             node.type().name));
  if (!slot.parent.live) return;
  refuseLoop(node, *slot.parent.live);
  refuseLoop(*twin.document, *slot.parent.document); // Scripts may have changed the live world
}

void NodeEdits::nameFreshly(const Twin& root) {
  const std::vector<Twin> named = namedIn(root).twins;
  Document& document = file_.document();
  std::set<std::string, std::less<>> taken;
  for (const Twin& one : named) taken.insert(one.live->defName);
  for (const Twin& one : named) {
    if (!document.scope().names.contains(one.live->defName)) continue;
    one.live->defName = document.freshName(one.live->defName, taken);
    document.rename(*one.document, one.live->defName);
    taken.insert(one.live->defName);
  }
}

void NodeEdits::rename(const Twin& node, const std::string& name) {
  const auto give = [this, node](const std::string& from, const std::string& to) {
    file_.opened().rename(*node.document, to);
    Scope* const live = file_.liveScope();
    if (!live) return;
    auto& names = live->names;
    if (const auto found = names.find(from); found != names.end() && found->second == node.live)
      names.erase(found);
    node.live->defName = to;
    if (!to.empty()) names[to] = node.live;
  };
  history_.perform({[give, before = node.live->defName, name] { give(before, name); },
                    [give, before = node.live->defName, name] { give(name, before); }});
}

void NodeEdits::ensureName(const Twin& node) {
  if (node.live->defName.empty()) rename(node, file_.document().freshName(node.live->type().name));
}

void NodeEdits::dropRoutes() {
  const Document& document = file_.document();
  std::vector<Route>& routes = file_.document().scope().routes;
  std::vector<std::pair<size_t, Route>> gone;
  for (size_t i = 0; i < routes.size(); ++i)
    if (!document.stands(*routes[i].from) || !document.stands(*routes[i].to))
      gone.emplace_back(i, routes[i]);
  if (gone.empty()) return;
  history_.perform({[&routes, gone] {
                      for (size_t i = gone.size(); i-- > 0;)
                        routes.erase(routes.begin() + std::ptrdiff_t(gone[i].first));
                    },
                    [&routes, gone] {
                      for (const auto& [index, route] : gone)
                        routes.insert(routes.begin() + std::ptrdiff_t(index), route);
                    },
                    nullptr, "", 2 * sizeof(gone[0]) * gone.size()});
}

} // namespace xvrml
