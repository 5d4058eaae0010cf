// registry.h: adds node types to the registry that nodeTypes() and findNodeType() read.
#pragma once

#include <span>

#include "xvrml/node.h"

namespace xvrml {

// Appends types to the registry; the index of each must be its position there. Returns false, and
// adds nothing, if an index does not fit or a name is taken. The types must live for ever.  [any
// thread]
bool addNodeTypes(std::span<const NodeType* const> types);

// Returns the name of the field that holds a node of this type in the XML encoding of X3D, where
// the file does not say it (containerField, ISO/IEC 19776-1): "geometry" for a Box. It is that of
// the type or of the nearest abstract type that has one, otherwise "children".  [any thread]
std::string_view containerOf(const NodeType& type);

namespace nodes {
// The nodes and abstract types whose description names a container. Written by nodegen.
struct Container {
  std::string_view type, field;
};
std::span<const Container> containers();

// The types of all .node files, in the order of their numbers. Written by nodegen.
std::span<const NodeType* const> builtinNodeTypes();
} // namespace nodes

} // namespace xvrml
