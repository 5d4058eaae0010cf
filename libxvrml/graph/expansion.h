// expansion.h: the standard nodes that a node of a plug-in stands for (xvrml/node_plugin.h:
// expand). Kept in the node. Read by renderedNode() and by the event engine, which renews them when
// fields change. [the thread that owns the node]
#pragma once

#include "xvrml/node.h"

namespace xvrml {

// A new answer of the node's type; null if there is none, or if it holds the node itself.
NodeRef makeExpansion(Node& node);

// What the node stands for at present, made if it was not yet; null: nothing. Only for nodes whose
// type expands.
Node* expansionOf(Node& node);

// Nodes that a plug-in made, rather than took from a field: they have no place in a file.
inline bool isMadeByPlugin(const Node& node) {
  return !node.source.file && node.defName.empty() && node.type().index >= 0;
}

} // namespace xvrml
