// printable.h: text by strangers (names, titles and strings of a world, of a recording, of another machine) for a terminal, which
// would obey the control characters in it. Used by every program before it writes such text. Stateless; any thread.
#pragma once

#include <algorithm>
#include <cstdio>
#include <string>
#include <string_view>

namespace printable_text {

// Returns the length of the UTF-8 character at the beginning of text, 1 to 4; 0: there is none (overlong, half a pair, cut,
// alone).
inline size_t utf8Length(std::string_view text) {
  const auto byte = [&](size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u; };
  const unsigned first = byte(0);
  size_t length = 0;
  if (first < 0x80)
    length = 1;
  else if (first >= 0xc2 && first < 0xf5)
    length = first < 0xe0 ? 2 : first < 0xf0 ? 3 : 4;
  for (size_t i = 1; i < length; ++i)
    if ((byte(i) & 0xc0) != 0x80) return 0;
  if (first == 0xe0 && byte(1) < 0xa0) return 0;  // overlong
  if (first == 0xed && byte(1) >= 0xa0) return 0; // half a pair
  if (first == 0xf0 && byte(1) < 0x90) return 0;  // overlong
  if (first == 0xf4 && byte(1) >= 0x90) return 0; // beyond the last one
  return length;
}

// Returns the length of the control character at the beginning of text: C0 (but the line feed and the tab), DEL, C1 in UTF-8.
inline size_t controlLength(std::string_view text) {
  const auto byte = [&](size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u; };
  if ((byte(0) < 0x20 && byte(0) != '\n' && byte(0) != '\t') || byte(0) == 0x7f) return 1;
  return byte(0) == 0xc2 && byte(1) >= 0x80 && byte(1) < 0xa0 ? 2 : 0;
}

// Returns 3 if text begins with a character that turns the direction of what follows (U+202A to U+202E, U+2066 to U+2069; Unicode
// Standard Annex 9), else 0: it could make a message read otherwise than it is.
inline size_t directionLength(std::string_view text) {
  const auto byte = [&](size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u; };
  if (byte(0) != 0xe2) return 0;
  const bool embedding = byte(1) == 0x80 && byte(2) >= 0xaa && byte(2) <= 0xae;
  const bool isolate = byte(1) == 0x81 && byte(2) >= 0xa6 && byte(2) <= 0xa9;
  return embedding || isolate ? 3 : 0;
}

} // namespace printable_text

// Returns text in which control characters, characters that turn the direction of text, and bytes that are no UTF-8 are shown as
// \x1b. Lines stay lines.
inline std::string printable(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  while (!text.empty()) {
    const size_t control = std::max(printable_text::controlLength(text), printable_text::directionLength(text));
    const size_t length = control ? 0 : printable_text::utf8Length(text);
    const size_t hidden = control ? control : length ? 0 : 1;
    for (size_t i = 0; i < hidden; ++i) {
      char code[8];
      std::snprintf(code, sizeof code, "\\x%02x", static_cast<unsigned char>(text[i]));
      out += code;
    }
    out += text.substr(0, length);
    text.remove_prefix(hidden + length);
  }
  return out;
}

// Returns text that is JSON with the control characters in its strings as \u009b: JSON itself asks that of those below 0x20 only.
inline std::string printableJson(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  while (!text.empty()) {
    const size_t control = printable_text::controlLength(text);
    if (control) {
      char code[8];
      std::snprintf(code, sizeof code, "\\u%04x", static_cast<unsigned char>(text[control - 1]));
      out += code;
    }
    out += text.substr(0, control ? 0 : 1);
    text.remove_prefix(control ? control : 1);
  }
  return out;
}
