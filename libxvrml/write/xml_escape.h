// xml_escape.h: text as XML writes it. [any thread]
#pragma once

#include <string>
#include <string_view>

namespace xvrml {

// Appends text as the value of an attribute in these quotes, or as character data. Bytes that are
// not UTF-8 are taken for ISO 8859-1, and characters that XML 1.0 cannot hold become U+FFFD.
void escapeXml(std::string& out, std::string_view text, std::string_view quotes = "'");

} // namespace xvrml
