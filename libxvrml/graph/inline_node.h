// inline_node.h: makes nodes while a world is loaded. Inline nodes store their content, nodes that
// declare fields have a type of their own. Used by the builder, the prototype expander and the
// loader.
#pragma once

#include "base/budget.h"
#include "graph/exchange.h"
#include "xvrml/nodes.h"
#include "xvrml/world.h"

namespace xvrml {

struct InlineNode : nodes::Inline {
  using nodes::Inline::Inline;
  std::shared_ptr<const Scope> content; // null until it is loaded
  bool tried = false;                   // its urls were tried; without content they cannot be read
  std::shared_ptr<Exchange> exchange;   // what the file of the content shares; null: nothing
  std::weak_ptr<Exchange> importer;     // what this node's own file imports from the content
  Share share; // reservation of the world's budget for content that a running world has loaded
};

// Returns the node if it is an Inline that can have content, else null. A program may also have
// made a bare nodes::Inline.
template <> inline InlineNode* nodeCast<InlineNode>(Node* node) {
  return dynamic_cast<InlineNode*>(nodeCast<nodes::Inline>(node));
}

// Makes a node of a registered type other than Script.
NodeRef makeStaticNode(const NodeType& type);
// Makes a node of the same type as a static node; it shares the type that this one has of its own.
NodeRef makeLike(const Node& staticNode);
// Returns a type for one node of a registered type that is `declaring`. Fields can be added to it.
std::shared_ptr<NodeType> makeOwnType(const NodeType& type);
// Appends a field, exposedField or event to a run-time type. Returns it with its offset set.
const FieldInfo& addField(NodeType& type, FieldInfo field);
// Returns where a Script or a DeclaringNode keeps the values of the fields that it declares.
std::vector<Value>& declaredValues(Node& node);

} // namespace xvrml
