// abstract_types.h: the abstract node types of ISO/IEC 19775-1 that a node has, as Scripts of X3D
// know them (ISO/IEC 19777-1, X3DConstants). They follow from the roles of .node files. Pure
// functions. [any thread]
#pragma once

#include "xvrml/node.h"

namespace xvrml {

// Returns the names of the abstract types, the most general one, X3DNode, first.
MFString abstractTypesOf(const NodeType& type);
// Returns the abstract type that a role of .node files is; empty: X3D has none for it.
std::string_view abstractTypeOfRole(std::string_view role);

} // namespace xvrml
