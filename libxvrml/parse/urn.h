// urn.h: EXTERNPROTOs that name a node of this browser (ISO/IEC 14772-1 4.9.3, RFC 2141). Used by
// the loader, on its thread.
#pragma once

#include <string_view>

#include "xvrml/world.h"

namespace xvrml {

// "urn:anything:NAME", NAME being a node type of this browser: a prototype whose body is one such
// node, with all its fields as its interface; accesses as the EXTERNPROTO declares them where an
// exposedField allows it. Null if the URL names none.
ProtoPtr builtinPrototype(std::string_view url, const NodeType& wanted);

} // namespace xvrml
