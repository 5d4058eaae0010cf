// node_list.h: what --list-nodes prints: every node type with its standard, fields and defaults.
// Pure functions.
#pragma once

#include <string>

#include "xvrml/world.h"

namespace vv {

// world may be null: then only the node types are listed.
std::string listNodes(const xvrml::World* world, bool json);

} // namespace vv
