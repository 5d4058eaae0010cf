// registry.h: adds node types to the registry that nodeTypes() and findNodeType() read.
#pragma once

#include <span>

#include "xvrml/node.h"

namespace xvrml {

// Appends types to the registry; the index of each must be its position there. Returns false, and
// adds nothing, if an index does not fit or a name is taken. The types must live for ever.  [any
// thread]
bool addNodeTypes(std::span<const NodeType* const> types);

namespace nodes {
// The types of all .node files, in the order of their numbers. Written by nodegen.
std::span<const NodeType* const> builtinNodeTypes();
} // namespace nodes

} // namespace xvrml
