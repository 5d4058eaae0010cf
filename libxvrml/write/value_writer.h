// value_writer.h: field values as VRML97 text that reads back equal. Used by the writer. [any
// thread]
#pragma once

#include <string>

#include "xvrml/types.h"

namespace xvrml {

// Numbers in the shortest form that reads back equal; what VRML cannot spell (infinity, not a
// number) as the nearest it can.
void writeNumber(std::string& out, float number);
void writeNumber(std::string& out, double number);
void writeNumber(std::string& out, int32_t number);
void writeString(std::string& out, std::string_view text); // in quotes
// A value of any type but SFNode and MFNode. Lists break their lines, which begin with indent
// blanks.
void writeValue(std::string& out, FieldType type, const void* storage, size_t indent);

} // namespace xvrml
