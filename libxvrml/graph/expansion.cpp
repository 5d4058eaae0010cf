// expansion.cpp: calls `expand` of plug-ins, and rejects expansions that contain their own node.
#include "graph/expansion.h"

#include "xvrml/walk.h"

namespace xvrml {
namespace {

// Returns whether `node` is a descendant of `top`. Only nodes made by the plug-in are searched,
// because a field's own nodes cannot hold their owner.
bool holds(Node& top, const Node& node) {
  return !walk(std::vector<Node*>{&top}, [&](Node& next, std::vector<Node*>& open) {
    if (isMadeByPlugin(next)) appendChildren(next, open);
    return &next != &node;
  });
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
