// base64.h: Encodes bytes as text (RFC 4648, section 4), for data: URLs and JSON. Pure functions.
// [any thread]
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

// Appends the base64 text of the bytes.
inline void appendBase64(std::string_view bytes, std::string& text) {
  constexpr std::string_view digits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  text.reserve(text.size() + bytes.size() / 3 * 4 + 4);
  for (size_t i = 0; i < bytes.size(); i += 3) {
    const size_t count = bytes.size() - i < 3 ? bytes.size() - i : 3;
    uint32_t bits = 0;
    for (size_t k = 0; k < 3; ++k)
      bits = bits << 8 | (k < count ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (size_t k = 0; k < 4; ++k) text += k <= count ? digits[bits >> (18 - 6 * k) & 63] : '=';
  }
}

inline std::string base64Of(std::string_view bytes) {
  std::string text;
  appendBase64(bytes, text);
  return text;
}
