// node_kinds.cpp: follows prototype instances to the type of their first node.
#include "graph/node_kinds.h"

#include <algorithm>

#include "base/x3d.h"
#include "graph/field_access.h"
#include "nodes/registry.h"
#include "xvrml/nodes.h"

namespace xvrml {

const Node* firstNode(const ProtoDeclaration* declaration) {
  if (declaration->isExtern) declaration = declaration->resolved.get();
  return declaration && !declaration->body.roots.empty() ? declaration->body.roots[0].get()
                                                         : nullptr;
}

const NodeType* effectiveType(const Node& node) {
  if (node.type().index >= 0) return &node.type();
  const Node* current = &node;
  // Follows instances of instances. Each prototype is declared before the next one uses it, which
  // bounds their number.
  while (const auto* instance = nodeCast<ProtoInstance>(current)) {
    current = firstNode(instance->declaration.get());
    if (!current) return nullptr;
  }
  return &current->type();
}

bool typeAccepted(std::string_view nodeTypes, const NodeType& type) {
  while (!nodeTypes.empty()) {
    const size_t end = std::min(nodeTypes.find(' '), nodeTypes.size());
    const std::string_view name = nodeTypes.substr(0, end);
    if (!name.empty() && (type.name == name || type.is(name))) return true;
    nodeTypes.remove_prefix(std::min(end + 1, nodeTypes.size()));
  }
  return false;
}

std::string_view usualField(const NodeType& parent, const NodeType* child,
                            const FileVersion& version) {
  std::string_view usual = child ? containerOf(*child) : "children";
  // In X3D 4 the parts of a MetadataSet need not say that they are its value.
  if (usual == "metadata" && version.major >= 4 && parent.index == nodes::MetadataSet::typeIndex)
    usual = "value";
  const auto takes = [&](const FieldInfo& field) {
    return holdsNodes(field) &&
           (!child || field.nodeTypes.empty() || typeAccepted(field.nodeTypes, *child));
  };
  const bool respelled = version.isX3d() && parent.index >= 0;
  const FieldInfo* const field = parent.find(respelled ? ownName(parent.name, usual) : usual);
  if (field && takes(*field)) return usual;
  auto first = std::find_if(parent.fields.begin(), parent.fields.end(), takes);
  if (first == parent.fields.end() && !field)
    first = std::find_if(parent.fields.begin(), parent.fields.end(), holdsNodes);
  return first == parent.fields.end() ? usual : std::string_view(first->name);
}

} // namespace xvrml
