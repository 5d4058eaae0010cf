// base64.h: Encodes bytes as text and back (RFC 4648, section 4), for data: URLs and JSON. Pure
// functions. [any thread]
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

// Returns the six bits of a base64 digit; 64 if it is none.
inline uint32_t valueOfBase64(char c) {
  return c >= 'A' && c <= 'Z'   ? uint32_t(c - 'A')
         : c >= 'a' && c <= 'z' ? uint32_t(c - 'a') + 26
         : c >= '0' && c <= '9' ? uint32_t(c - '0') + 52
         : c == '+'             ? 62
         : c == '/'             ? 63
                                : 64;
}

// Appends the bytes of a base64 text, which must be complete: groups of four characters, the last
// one filled with "=". Returns false if it is not; then some bytes may have been appended.
inline bool appendBytesOfBase64(std::string_view text, std::string& bytes) {
  if (text.size() % 4 != 0) return false;
  const size_t filled = text.ends_with("==") ? 2 : text.ends_with('=') ? 1 : 0;
  bytes.reserve(bytes.size() + text.size() / 4 * 3);
  for (size_t i = 0; i < text.size(); i += 4) {
    const size_t digits = i + 4 == text.size() ? 4 - filled : 4;
    uint32_t bits = 0;
    for (size_t k = 0; k < 4; ++k) {
      const uint32_t digit = k < digits ? valueOfBase64(text[i + k]) : 0;
      if (digit > 63) return false;
      bits = bits << 6 | digit;
    }
    for (size_t k = 0; k + 1 < digits; ++k) bytes += char(bits >> (16 - 8 * k) & 255);
  }
  return true;
}
