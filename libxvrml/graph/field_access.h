// field_access.h: typed access to the fields of any node through its type's table. Used by the
// builder, the prototype expander, the writer and the comparison. [any thread that owns the node]
#pragma once

#include <algorithm>

#include "xvrml/node.h"

namespace xvrml {

// Calls visit with a typed reference to the storage of a field of this type.
template <class Visitor>
decltype(auto) visitStorage(FieldType type, void* storage, Visitor&& visit) {
  switch (type) {
  case FieldType::SFBool: return visit(*static_cast<SFBool*>(storage));
  case FieldType::SFColor: return visit(*static_cast<SFColor*>(storage));
  case FieldType::SFFloat: return visit(*static_cast<SFFloat*>(storage));
  case FieldType::SFImage: return visit(*static_cast<SFImage*>(storage));
  case FieldType::SFInt32: return visit(*static_cast<SFInt32*>(storage));
  case FieldType::SFNode: return visit(*static_cast<SFNode*>(storage));
  case FieldType::SFRotation: return visit(*static_cast<SFRotation*>(storage));
  case FieldType::SFString: return visit(*static_cast<SFString*>(storage));
  case FieldType::SFTime: return visit(*static_cast<SFTime*>(storage));
  case FieldType::SFVec2f: return visit(*static_cast<SFVec2f*>(storage));
  case FieldType::SFVec3f: return visit(*static_cast<SFVec3f*>(storage));
  case FieldType::MFColor: return visit(*static_cast<MFColor*>(storage));
  case FieldType::MFFloat: return visit(*static_cast<MFFloat*>(storage));
  case FieldType::MFInt32: return visit(*static_cast<MFInt32*>(storage));
  case FieldType::MFNode: return visit(*static_cast<MFNode*>(storage));
  case FieldType::MFRotation: return visit(*static_cast<MFRotation*>(storage));
  case FieldType::MFString: return visit(*static_cast<MFString*>(storage));
  case FieldType::MFTime: return visit(*static_cast<MFTime*>(storage));
  case FieldType::MFVec2f: return visit(*static_cast<MFVec2f*>(storage));
  case FieldType::MFVec3f: break;
  }
  return visit(*static_cast<MFVec3f*>(storage));
}

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
