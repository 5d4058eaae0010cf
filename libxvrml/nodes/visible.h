// visible.h: the field `visible` of groups and Shapes (X3DBoundedObject, ISO/IEC 19775-1:2023
// 10.3.1), for code that walks what is drawn. [any thread that owns the nodes]
#pragma once

#include "xvrml/nodes.h"

namespace xvrml {

// Returns false if the node has a field `visible` that is FALSE.
bool isVisible(const Node& node);
// Returns the child that a Switch has chosen; null: none. A whichChoice below 0 or beyond the last
// choice chooses none (ISO/IEC 14772-1 6.46).
inline Node* chosenChild(const nodes::Switch& node) {
  const bool exists = node.whichChoice >= 0 && size_t(node.whichChoice) < node.choice.size();
  return exists ? node.choice[size_t(node.whichChoice)].get() : nullptr;
}
// Returns whether a CADLayer shows its child with this index (ISO/IEC 19775-1 32.4.3).
inline bool showsChild(const nodes::CADLayer& layer, size_t child) {
  return child >= layer.visible.size() || layer.visible[child];
}

} // namespace xvrml
