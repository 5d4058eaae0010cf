// json_text.h: writes texts into the JSON that attributes of OpenEXR files hold. [any thread]
#pragma once

#include <string>
#include <string_view>

#include <fmt/format.h>

namespace picture {

// Returns a text in quotes. Bytes that are not UTF-8 stay as they are, as names of the world may
// have them.
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
