// node_kinds.h: checks which nodes a field accepts (the node types that the standard prints beside
// each SFNode and MFNode field). [any thread that owns the nodes]
#pragma once

#include <string_view>

#include "xvrml/world.h"

namespace xvrml {

// Returns the first node of a prototype's body, which stands for an instance (4.8.3); null if it is
// not known.
const Node* firstNode(const ProtoDeclaration* declaration);
// Returns the type that decides where a node is allowed. For a prototype instance it is the type of
// the first node in its body (4.8.3). Null if it is not known (EXTERNPROTO not loaded).
const NodeType* effectiveType(const Node& node);
// Returns whether a type is one of a field's nodeTypes.
bool typeAccepted(std::string_view nodeTypes, const NodeType& type);
// Returns the field of a node that holds a node of the type `child` where a file of XML does not
// say which (containerField, ISO/IEC 19776-1 5.2), as the file or our table spells it. child: null
// if it is not known. The child's own containerField counts, then the first field that takes it.
// Where none does, it is a field that a message can name.
std::string_view usualField(const NodeType& parent, const NodeType* child,
                            const FileVersion& version);

} // namespace xvrml
