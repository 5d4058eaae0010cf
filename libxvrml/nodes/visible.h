// visible.h: the field `visible` of groups and Shapes (X3DBoundedObject, ISO/IEC 19775-1:2023
// 10.3.1), for code that walks what is drawn. [any thread that owns the nodes]
#pragma once

#include "xvrml/node.h"

namespace xvrml {

// Returns false if the node has a field `visible` that is FALSE.
bool isVisible(const Node& node);

} // namespace xvrml
