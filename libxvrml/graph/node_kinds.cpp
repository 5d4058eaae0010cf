// node_kinds.cpp: follows prototype instances to the type of their first node.
#include "graph/node_kinds.h"

#include <algorithm>

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

} // namespace xvrml
