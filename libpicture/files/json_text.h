// json_text.h: writes texts into the JSON that attributes of OpenEXR files hold. [any thread]
#pragma once

#include <string>
#include <string_view>

#include <fmt/format.h>

#include "printable.h"

namespace picture {

// Returns the text with U+FFFD for each byte that is not UTF-8, as names of a world may have them.
inline std::string asUtf8(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    const size_t length = printable_text::utf8Length(text);
    out += length > 0 ? text.substr(0, length) : "\xef\xbf\xbd";
    text.remove_prefix(length > 0 ? length : 1);
  }
  return out;
}

// Returns a text of UTF-8 in quotes.
inline std::string jsonText(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (static_cast<unsigned char>(c) < 0x20)
      out += fmt::format("\\u{:04x}", int(c));
    else
      out += c;
  }
  return out + '"';
}

} // namespace picture
