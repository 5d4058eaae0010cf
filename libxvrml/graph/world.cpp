// world.cpp: renderedNode(), and the destruction of a World.
#include "xvrml/world.h"

#include "base/budget.h"
#include "graph/exchange.h"
#include "graph/expansion.h"
#include "graph/field_access.h"

namespace xvrml {

Node* renderedNode(Node* node) {
  constexpr int deepest = 32; // limit for plug-in nodes that expand to plug-in nodes
  for (int expanded = 0; node;) {
    if (node->type().expand) {
      node = ++expanded < deepest ? expansionOf(*node) : nullptr;
    } else if (auto* instance = nodeCast<ProtoInstance>(node)) {
      node = instance->body.roots.empty() ? nullptr : instance->body.roots[0].get();
    } else {
      break;
    }
  }
  return node;
}

// Clears the fields of nodes that may own themselves: a Script's field may hold a node that
// contains the Script.
World::~World() {
  forgetBudget(*this);
  forgetExchange(*this);
  for (const NodeRef& node : cyclic) {
    for (const FieldInfo& field : node->type().fields) {
      if (!holdsNodes(field)) continue;
      visitStorage(field.type, node->storage(field), [](auto& value) { value = {}; });
    }
  }
}

} // namespace xvrml
