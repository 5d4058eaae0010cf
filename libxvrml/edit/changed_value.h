// changed_value.h: the text of a value that has been changed, with as little of the old text
// changed as possible: comments, separators and numbers that stay are kept. [any thread]
#pragma once

#include <string>
#include <string_view>

#include "edit/value_words.h"
#include "xvrml/types.h"

namespace xvrml {

// Returns the text of the value `after` in the place of `text`, which is what a file of VRML97 has
// for `before`. Both have the type, which is not of nodes.
std::string changedValue(std::string_view text, FieldType type, const Value& before,
                         const Value& after, const ValueLines& lines);
// Does the same for the value of an attribute of XML, which stands in these quotes. Values with
// entities are written anew.
std::string changedAttribute(std::string_view text, FieldType type, const Value& before,
                             const Value& after, const ValueLines& lines, char quote);
// Does the same for a value of JSON. Commas between the elements of lists may be missing
// (json_commas.h).
std::string changedJson(std::string_view text, FieldType type, const Value& before,
                        const Value& after, const ValueLines& lines);
// Return the text of a value in VRML97, and in JSON.
std::string valueText(FieldType type, const Value& value, const ValueLines& lines);
std::string jsonText(FieldType type, const Value& value, const ValueLines& lines);
// Returns the text of a string of JSON, with its quotes.
std::string jsonString(std::string_view text);
// Returns the text of a value as an attribute of XML in these quotes has it.
std::string attributeText(FieldType type, const Value& value, const ValueLines& lines, char quote);

} // namespace xvrml
