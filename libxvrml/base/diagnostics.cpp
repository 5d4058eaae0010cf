// diagnostics.cpp: collects and prints messages. A Diagnostics object belongs to the thread that
// loads its world.
#include "xvrml/diagnostics.h"

#include <string_view>
#include <utility>

namespace xvrml {
namespace {

std::string_view severityName(Severity severity) {
  switch (severity) {
  case Severity::note: return "note";
  case Severity::warning: return "warning";
  case Severity::error: break;
  }
  return "error";
}

// Returns blanks up to the character `column` (from 1). Tabs stay tabs, and UTF-8 continuation
// bytes take no room, so that the caret stands below its character on a terminal.
std::string caretIndent(std::string_view line, size_t column) {
  std::string indent;
  for (const char c : line) {
    if ((static_cast<unsigned char>(c) & 0xc0) == 0x80) continue;
    if (indent.size() + 1 >= column) break;
    indent += c == '\t' ? '\t' : ' ';
  }
  return indent;
}

// Makes text from a file safe for a terminal: each control character (C0 except the tab, DEL, C1 in
// UTF-8) becomes a question mark, and a line feed a blank.
std::string printable(std::string_view text) {
  std::string result;
  result.reserve(text.size());
  for (size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    const bool c1 =
        byte == 0xc2 && i + 1 < text.size() && static_cast<unsigned char>(text[i + 1]) < 0xa0;
    const bool control = (byte < 0x20 && byte != '\t') || byte == 0x7f || c1;
    result += byte == '\n' ? ' ' : control ? '?' : text[i];
    i += c1;
  }
  return result;
}

Diagnostic at(Severity severity, const SourcePosition& where, std::string message) {
  return {severity,           where.file ? *where.file : std::string(),
          where.line,         where.column,
          std::move(message), {}};
}

} // namespace

std::string Diagnostic::text() const {
  std::string result = printable(file);
  if (line > 0) {
    if (!result.empty()) result += ':';
    result += std::to_string(line);
    if (column > 0) result += ':' + std::to_string(column);
  }
  if (!result.empty()) result += ": ";
  result += severityName(severity);
  result += ": " + printable(message);
  if (sourceLine.empty()) return result;
  result += '\n' + printable(sourceLine);
  const size_t place = caret > 0 ? caret : column; // a long line is shown in part
  if (place > 0 && place <= sourceLine.size() + 1)
    result += '\n' + caretIndent(sourceLine, place) + '^';
  return result;
}

// Errors have their own share of the list, which other messages cannot use up.
void Diagnostics::add(Diagnostic diagnostic) {
  const bool kept = keeps(diagnostic.severity);
  if (diagnostic.severity == Severity::error) ++errors_;
  if (diagnostic.severity == Severity::warning) ++warnings_;
  if (kept)
    list_.push_back(std::move(diagnostic));
  else
    ++dropped_;
}

void Diagnostics::warn(const SourcePosition& where, std::string message) {
  add(at(Severity::warning, where, std::move(message)));
}

void Diagnostics::error(const SourcePosition& where, std::string message) {
  add(at(Severity::error, where, std::move(message)));
}

} // namespace xvrml
