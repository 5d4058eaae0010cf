// declaration.h: adds the declaration of a field to the text of a node. Internal; any thread.
#pragma once

#include <string>
#include <string_view>

#include "xvrml/file_head.h"
#include "xvrml/types.h"

namespace xvrml {

// Returns the text of a node, as writeNode() gives it, with an exposedField behind what it has.
std::string withDeclaration(std::string text, const FileVersion& version, std::string_view field,
                            const Value& value);

} // namespace xvrml
