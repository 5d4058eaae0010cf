// urn.h: EXTERNPROTOs whose urn: URL names a node type of this browser (ISO/IEC 14772-1 4.9.3, RFC
// 2141). Used by the loader, on its thread.
#pragma once

#include <string_view>

#include "xvrml/world.h"

namespace xvrml {

// Returns the prototype for "urn:anything:NAME", where NAME is a node type of this browser; null if
// the URL names none. The prototype's body is one such node, and its interface has all its fields.
// An exposedField has the access that the EXTERNPROTO declares. The node is in the file of the
// EXTERNPROTO.
ProtoPtr builtinPrototype(std::string_view url, const ProtoDeclaration& declaration);

} // namespace xvrml
