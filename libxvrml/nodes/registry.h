// registry.h: how node types get into the registry that nodeTypes() and findNodeType() read.
#pragma once

#include <span>

#include "xvrml/node.h"

namespace xvrml {

// Adds types whose index is their place behind those there are. False, and nothing added, if an
// index does not fit or a name is taken. The types must live for ever.  [any thread]
bool addNodeTypes(std::span<const NodeType* const> types);

namespace nodes {
// Written by nodegen: the types of all .node files, in their order.
std::span<const NodeType* const> builtinNodeTypes();
} // namespace nodes

} // namespace xvrml
