// value_text.h: converts VRML97 text to field values, for programs that take values from a user,
// and describes ranges.
// [any thread]
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "xvrml/limits.h"
#include "xvrml/node.h"

namespace xvrml {

// Parses the whole text as a value of the type, written as in a file ("1 0 0", "TRUE", "[ 1, 2 ]").
// Node fields accept only NULL and [ ]. Returns nothing if the text is no such value; `problem`
// then says what was found and what was expected.
std::optional<Value> parseValue(FieldType type, std::string_view text, std::string& problem,
                                const Limits& limits = {});

// Returns the range of a field as the standard prints it: "[0,1]", "(0,inf) or -1", "(0,pi/2]".
std::string describe(const FieldRange& range);

} // namespace xvrml
