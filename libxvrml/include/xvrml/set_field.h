// set_field.h: sets fields of a world that does not run. In a running world use Browser::set().
#pragma once

#include <string_view>

#include "xvrml/world.h"

namespace xvrml {

// Sets a field or exposedField of a node, with the same effect as if the file had the value: nodes
// in the body of a prototype instance get it through IS connections, and an Inline with another url
// is loaded again. Node::set() changes the node alone. Returns false, and changes nothing, if the
// node has no such field or the value is of another type. The value must not hold the node itself.
// Parts of the value that cannot be used are reported in world.diagnostics. The world must not be
// running. [the thread that owns the world]
bool setField(World& world, Node& node, std::string_view field, Value value);

} // namespace xvrml
