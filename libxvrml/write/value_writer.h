// value_writer.h: writes field values as text of VRML97 and X3D that reads back equal. Used by the
// writer. [any thread]
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
// Does the same for the attributes of XML (ISO/IEC 19776-1 clause 5): lists have no brackets, and
// booleans are in small letters. A single string stays as it is. The characters that XML
// reserves are left to the caller.
void writeXmlValue(std::string& out, FieldType type, const void* storage, size_t indent);

} // namespace xvrml
