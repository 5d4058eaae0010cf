// value_writer.h: writes field values as VRML97 text that reads back equal. Used by the writer.
// [any thread]
#pragma once

#include <string>

#include "xvrml/types.h"

namespace xvrml {

// Append a number in the shortest form that reads back equal. Infinity and not-a-number, which VRML
// cannot express, become the nearest number that it can.
void writeNumber(std::string& out, float number);
void writeNumber(std::string& out, double number);
void writeNumber(std::string& out, int32_t number);
void writeString(std::string& out, std::string_view text); // in quotes
// Appends a value of any type except SFNode and MFNode. Long lists are broken into lines that begin
// with `indent` blanks.
void writeValue(std::string& out, FieldType type, const void* storage, size_t indent);

} // namespace xvrml
