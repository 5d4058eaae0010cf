// utf16.cpp: converts texts from UTF-16 to UTF-8 (ISO/IEC 10646, annexes Q and R).
#include "parse/utf16.h"

#include <cstdint>

namespace xvrml {
namespace {

constexpr std::string_view littleMark = "\xff\xfe", bigMark = "\xfe\xff";
constexpr uint32_t replacement = 0xfffd;

// Writes a character, which is at most 0x10ffff. Returns the place behind it.
char* append(char* to, uint32_t character) {
  const auto byte = [&](uint32_t value) { *to++ = static_cast<char>(value); };
  const auto continued = [&](int shift) { byte(0x80 | (character >> shift & 0x3f)); };
  if (character < 0x80) {
    byte(character);
  } else if (character < 0x800) {
    byte(0xc0 | character >> 6);
    continued(0);
  } else if (character < 0x10000) {
    byte(0xe0 | character >> 12);
    continued(6);
    continued(0);
  } else {
    byte(0xf0 | character >> 18);
    continued(12);
    continued(6);
    continued(0);
  }
  return to;
}

} // namespace

bool isUtf16Vrml(std::string_view bytes) {
  return bytes.substr(0, 4) == std::string_view("\xff\xfe#\0", 4) ||
         bytes.substr(0, 4) == std::string_view("\xfe\xff\0#", 4);
}

bool convertUtf16(std::string_view bytes, TextBuffer& out) {
  const int high = bytes.starts_with(bigMark) ? 0 : 1; // place of the high byte in a pair
  bytes.remove_prefix(littleMark.size());
  const size_t units = bytes.size() / 2;
  const auto unit = [&](size_t i) -> uint32_t {
    const auto at = [&](size_t k) {
      return uint32_t(static_cast<unsigned char>(bytes[2 * i + k]));
    };
    return at(size_t(high)) << 8 | at(size_t(1 - high));
  };
  constexpr size_t longest = 3; // bytes of UTF-8 for two bytes of UTF-16
  char* const begin = out.grow(longest * units);
  if (!begin) return false;
  char* to = begin;
  for (size_t i = 0; i < units; ++i) {
    const uint32_t first = unit(i);
    const bool surrogate = first >= 0xd800 && first < 0xe000;
    const uint32_t second = surrogate && first < 0xdc00 && i + 1 < units ? unit(i + 1) : 0;
    if (second >= 0xdc00 && second < 0xe000) {
      to = append(to, 0x10000 + ((first - 0xd800) << 10) + (second - 0xdc00));
      ++i;
    } else {
      to = append(to, surrogate ? replacement : first);
    }
  }
  out.keep(size_t(to - begin));
  out.fit();
  return true;
}

} // namespace xvrml
