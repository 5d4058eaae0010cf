// world.cpp: what a loaded world can be asked, and its end. See xvrml/world.h.
#include "xvrml/world.h"

#include "base/budget.h"
#include "graph/expansion.h"
#include "graph/field_access.h"

namespace xvrml {

Node* renderedNode(Node* node) {
  constexpr int deepest = 32; // plug-ins whose nodes stand for nodes of plug-ins
  for (int expanded = 0; node;) {
    if (node->type().expand) {
      node = ++expanded < deepest ? expansionOf(*node) : nullptr;
    } else if (auto* instance = dynamic_cast<ProtoInstance*>(node)) {
      node = instance->body.roots.empty() ? nullptr : instance->body.roots[0].get();
    } else {
      break;
    }
  }
  return node;
}

// A Script's field may hold a node that contains the Script: such owners of themselves are let go
// by hand.
World::~World() {
  forgetBudget(*this);
  for (const NodeRef& node : cyclic) {
    for (const FieldInfo& field : node->type().fields) {
      if (!holdsNodes(field)) continue;
      visitStorage(field.type, node->storage(field), [](auto& value) { value = {}; });
    }
  }
}

} // namespace xvrml
