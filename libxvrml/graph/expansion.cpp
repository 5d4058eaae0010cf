// expansion.cpp: calls `expand` of plug-ins, and rejects expansions that contain their own node.
#include "graph/expansion.h"

#include <unordered_set>

#include "graph/field_access.h"

namespace xvrml {
namespace {

// Returns whether `node` is a descendant of `top`. Only nodes made by the plug-in are searched,
// because a field's own nodes cannot hold their owner.
bool holds(Node& top, const Node& node) {
  std::unordered_set<const Node*> seen{&top};
  std::vector<Node*> open{&top};
  while (!open.empty()) {
    Node& next = *open.back();
    open.pop_back();
    if (&next == &node) return true;
    if (!isMadeByPlugin(next)) continue;
    forEachChild(next, [&](NodeRef& child, const FieldInfo&) {
      if (seen.insert(child.get()).second) open.push_back(child.get());
    });
  }
  return false;
}

} // namespace

NodeRef makeExpansion(Node& node) {
  if (!node.type().expand) return {};
  const NodeRef keep(&node); // protects the node from what the plug-in does with references
  NodeRef made;
  try {
    made = node.type().expand(node);
  } catch (...) { return {}; } // if the plug-in throws, nothing is drawn
  return made && !holds(*made, node) ? made : NodeRef();
}

Node* expansionOf(Node& node) {
  NodeRef* place = node.expansion();
  if (!place) return nullptr;
  if (!*place) *place = makeExpansion(node);
  return place->get();
}

} // namespace xvrml
