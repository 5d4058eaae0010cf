// set_field.h: fields of a world that stands still. In a running world Browser::set() does it.
#pragma once

#include <string_view>

#include "xvrml/world.h"

namespace xvrml {

// Sets a field or exposedField of a node of a world that stands still, as if the file had the
// value: nodes in the body of a prototype's instance get it where their fields IS that one, and an
// Inline with another url is loaded again. Node::set() changes the node alone. Returns false, and
// changes nothing, if the node has no such field or the value is of another type. The value must
// not hold the node itself. What cannot be used of it is in world.diagnostics. [the thread that
// owns the world]
bool setField(World& world, Node& node, std::string_view field, Value value);

} // namespace xvrml
