// inline_node.h: how nodes are made while a world is loaded: Inline nodes carry what they loaded,
// Scripts a table of their own. Used by the builder, the prototype instancer and the loader.
#pragma once

#include "base/budget.h"
#include "xvrml/nodes.h"
#include "xvrml/world.h"

namespace xvrml {

struct InlineNode : nodes::Inline {
  using nodes::Inline::Inline;
  std::shared_ptr<const Scope> content; // null until it is loaded
  Share share; // of the world's budget: content that a running world has loaded
};

// A node of a type of the registry other than Script.
NodeRef makeStaticNode(const NodeType& type);
// The table of a Script that has declared nothing of its own yet.
std::shared_ptr<NodeType> scriptType(const NodeType& script);
// Appends a field, exposedField or event to a run-time table; returns it with its offset set.
const FieldInfo& addField(NodeType& type, FieldInfo field);

} // namespace xvrml
