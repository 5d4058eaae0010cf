// node_kinds.h: which nodes a field takes (the node types that the standard prints beside each
// SFNode and MFNode field). [any thread that owns the nodes]
#pragma once

#include <string_view>

#include "xvrml/world.h"

namespace xvrml {

// Returns the node that an instance of a prototype stands for: the first of its body (4.8.3); null
// if it is not known.
const Node* firstNode(const ProtoDeclaration* declaration);
// The type that decides where a node may stand: a prototype instance stands for the first node of
// its body (4.8.3). Null if not known (EXTERNPROTO not loaded).
const NodeType* effectiveType(const Node& node);
// Does a type suit a field's nodeTypes?
bool typeAccepted(std::string_view nodeTypes, const NodeType& type);
} // namespace xvrml
