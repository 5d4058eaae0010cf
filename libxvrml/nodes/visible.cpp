// visible.cpp: looks up the field `visible` by type index. Code asks for every node of a world, so
// names are compared only once.
#include "nodes/visible.h"

#include "nodes/registry.h"

namespace xvrml {

bool isVisible(const Node& node) {
  static const std::vector<const FieldInfo*> byIndex = [] {
    std::vector<const FieldInfo*> all;
    for (const NodeType* type : nodes::builtinNodeTypes()) all.push_back(type->find("visible"));
    return all;
  }();
  const auto index = size_t(node.type().index); // that of prototypes and Scripts is beyond the end
  return index >= byIndex.size() || !byIndex[index] || byIndex[index]->type != FieldType::SFBool ||
         *static_cast<const SFBool*>(node.storage(*byIndex[index]));
}

} // namespace xvrml
