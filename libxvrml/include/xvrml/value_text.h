// value_text.h: field values from and to VRML97 text, for programs that get them from a person.
// [any thread]
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "xvrml/limits.h"
#include "xvrml/types.h"

namespace xvrml {

// The whole text as a value of the type, as a file would have it ("1 0 0", "TRUE", "[ 1, 2 ]"). Of
// nodes only NULL and [ ]. Nothing if it is none; problem then says what was found and what was
// expected.
std::optional<Value> parseValue(FieldType type, std::string_view text, std::string& problem,
                                const Limits& limits = {});

} // namespace xvrml
