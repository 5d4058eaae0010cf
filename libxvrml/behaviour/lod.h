// lod.h: the part of LOD's behaviour that other groups do not have. grouping.cpp adds it to the
// table. [the browser's thread]
#pragma once

#include "xvrml/behaviour.h"

namespace xvrml {

std::unique_ptr<NodeState> beginLod(Events& events, Node& node);
void lookLod(Events& events, Node& node);

} // namespace xvrml
