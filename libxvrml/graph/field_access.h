// field_access.h: typed access to the fields of any node through its type's table. Used by the
// builder, the prototype expander, the writer and the comparison. [any thread that owns the node]
#pragma once

#include <algorithm>

#include "xvrml/node.h"
#include "xvrml/visit_storage.h"

namespace xvrml {

inline bool holdsNodes(const FieldInfo& field) {
  return holdsValue(field) && (field.type == FieldType::SFNode || field.type == FieldType::MFNode);
}

// Returns whether the lists of nodes of a type keep NULL, because the position of a node matters
// (Switch, LOD). In other lists NULL has no meaning.
inline bool keepsNull(const NodeType& type) { return type.is("selecting"); }

// Calls visit(NodeRef&, const FieldInfo&) for each node that the node's own fields hold, except
// NULL.
template <class Visitor> void forEachChild(Node& node, Visitor&& visit) {
  for (const FieldInfo& field : node.type().fields) {
    if (!holdsNodes(field)) continue;
    if (field.type == FieldType::SFNode) {
      NodeRef& child = *static_cast<NodeRef*>(node.storage(field));
      if (child) visit(child, field);
    } else {
      for (NodeRef& child : *static_cast<MFNode*>(node.storage(field))) {
        if (child) visit(child, field);
      }
    }
  }
}

constexpr uint64_t saturatingAdd(uint64_t a, uint64_t b) {
  return a + b < a ? ~uint64_t(0) : a + b;
}

} // namespace xvrml
