// lines.h: lines of a text of VRML97 or XML and their indentation. [any thread]
#pragma once

#include <string>
#include <string_view>

namespace xvrml {

inline bool isBlank(char c) { return c == ' ' || c == '\t'; }

// Returns where the line begins that holds the byte `at`, and where it ends: at its line feed or
// carriage return, or at the end of the text.
inline size_t lineBegin(std::string_view text, size_t at) {
  while (at > 0 && text[at - 1] != '\n' && text[at - 1] != '\r') --at;
  return at;
}
inline size_t lineEnd(std::string_view text, size_t at) {
  while (at < text.size() && text[at] != '\n' && text[at] != '\r') ++at;
  return at;
}
// Returns where the line behind begins, given the end of a line.
inline size_t nextLine(std::string_view text, size_t end) {
  if (end < text.size() && text[end] == '\r') ++end;
  if (end < text.size() && text[end] == '\n') ++end;
  return end;
}
// Returns the blanks at the beginning of the line that holds the byte `at`.
std::string_view indentationAt(std::string_view text, size_t at);
// Returns whether nothing but blanks stands before the byte `at` in its line.
bool startsLine(std::string_view text, size_t at);
// Return whether nothing but blanks and commas, and perhaps a comment, stands behind the byte `at`
// in its line.
bool endsLine(std::string_view text, size_t at);
bool endsXmlLine(std::string_view text, size_t at);
// Returns the end of lines that the text uses: that of its first line; "\n" for a single line.
std::string_view lineFeedOf(std::string_view text);
// Returns a text whose lines end with `feed`. isXml: those within strings do so, too, because an
// XML reader takes all ends of lines as the same (XML 1.0, 2.11); else strings stay as they are.
std::string withLineFeed(std::string_view text, std::string_view feed, bool isXml);
// Return the text of a node with another indentation: lines that begin with `from` begin with `to`
// instead. The first line, and lines within strings, values and texts, stay.
std::string indented(std::string_view text, std::string_view from, std::string_view to);
std::string indentedXml(std::string_view text, std::string_view from, std::string_view to);

} // namespace xvrml
