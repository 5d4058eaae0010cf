#include "libpicture/files/read_note.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <string_view>

namespace picture {

namespace {

constexpr size_t most = 65536; // bytes of a file that are read; writers put comments before pixels

// Returns a number of `count` bytes, the highest one first.
size_t numberAt(std::string_view bytes, size_t at, size_t count) {
  size_t value = 0;
  for (size_t i = 0; i < count; ++i) value = value << 8 | uint8_t(bytes[at + i]);
  return value;
}

// Returns the text with the keyword "Comment" (PNG 1.2, 4.2.3.1).
std::string_view commentOfPng(std::string_view bytes) {
  constexpr std::string_view keyword("Comment\0", 8);
  for (size_t at = 8; at + 8 <= bytes.size();) {
    const size_t length = numberAt(bytes, at, 4);
    if (length > bytes.size() - at - 8) return {};
    const std::string_view data = bytes.substr(at + 8, length);
    if (bytes.substr(at + 4, 4) == "tEXt" && data.starts_with(keyword))
      return data.substr(keyword.size());
    at += length + 12;
  }
  return {};
}

// Returns the first comment before the pixels (ITU-T T.81, B.2.4.5).
std::string_view commentOfJpeg(std::string_view bytes) {
  constexpr uint8_t comment = 0xfe, scan = 0xda;
  for (size_t at = 2; at + 4 <= bytes.size();) {
    const auto marker = uint8_t(bytes[at + 1]);
    const size_t length = numberAt(bytes, at + 2, 2);
    if (bytes[at] != '\xff' || marker == scan || length < 2 || length > bytes.size() - at - 2)
      return {};
    if (marker == comment) return bytes.substr(at + 4, length - 2);
    at += length + 2;
  }
  return {};
}

// Returns the attribute "comments" (OpenEXR File Layout, "Attribute Layout").
std::string_view commentOfExr(std::string_view bytes) {
  constexpr std::string_view head("comments\0string\0", 16);
  const size_t found = bytes.find(head), at = found + head.size();
  if (found == bytes.npos || at + 4 > bytes.size()) return {};
  size_t length = 0;
  for (size_t i = 4; i-- > 0;) length = length << 8 | uint8_t(bytes[at + i]);
  return length > bytes.size() - at - 4 ? std::string_view() : bytes.substr(at + 4, length);
}

// Returns the first line of a head of text that is a comment, as writers of this project place it.
std::string_view commentOfText(std::string_view bytes) {
  constexpr std::string_view begin = "\n# ";
  const size_t found = bytes.find(begin), at = found + begin.size();
  const size_t end = found == bytes.npos ? bytes.npos : bytes.find('\n', at);
  return end == bytes.npos ? std::string_view() : bytes.substr(at, end - at);
}

std::string lineOf(std::string_view comment) {
  std::string line(comment);
  std::replace_if(
      line.begin(), line.end(), [](char c) { return c < ' ' || c > '~'; }, ' ');
  return line;
}

} // namespace

std::string readNote(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string bytes(most, '\0');
  file.read(bytes.data(), std::streamsize(bytes.size()));
  bytes.resize(size_t(file.gcount()));
  if (bytes.starts_with("\x89PNG\r\n\x1a\n")) return lineOf(commentOfPng(bytes));
  if (bytes.starts_with("\xff\xd8")) return lineOf(commentOfJpeg(bytes));
  if (bytes.starts_with("\x76\x2f\x31\x01")) return lineOf(commentOfExr(bytes));
  if (bytes.starts_with("P6\n# ") || bytes.starts_with("#?")) return lineOf(commentOfText(bytes));
  return "";
}

} // namespace picture
