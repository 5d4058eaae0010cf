// json_value.h: field values as X3D's JSON encoding writes them (ISO/IEC 19776-5). [any thread]
#pragma once

#include <string>
#include <string_view>

#include "xvrml/types.h"

namespace xvrml {

// Appends a text in quotes. Bytes that are not UTF-8 are taken for ISO 8859-1.
void writeJsonString(std::string& out, std::string_view text);
// Appends a value of any type except SFNode and MFNode: a number, a truth value, a string, or an
// array. The numbers of a list of tuples follow each other. Long arrays are broken into lines that
// begin with `indent` blanks.
void writeJsonValue(std::string& out, FieldType type, const void* storage, size_t indent);

} // namespace xvrml
