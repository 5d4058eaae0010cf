// expansion.h: the expansion of a node: the standard nodes that a plug-in's node
// (xvrml/node_plugin.h) and a ParticleSystem stand for. It is stored in the node. renderedNode()
// and the event engine read it, and the engine renews it when fields change. [the thread that owns
// the node]
#pragma once

#include "xvrml/node.h"

namespace xvrml {

// Makes a new expansion. Returns null if the type has none, or if the expansion holds the node
// itself.
NodeRef makeExpansion(Node& node);

// Returns the stored expansion, which is made on the first call; null if there is none. Only for
// nodes whose type has `expand`.
Node* expansionOf(Node& node);

// Returns whether a plug-in made the node instead of taking it from a field. Such a node has no
// place in a file.
inline bool isMadeByPlugin(const Node& node) {
  return !node.source.file && node.defName.empty() && node.type().index >= 0;
}

} // namespace xvrml
