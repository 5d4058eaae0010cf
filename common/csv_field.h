// csv_field.h: Writes a text as a field of a table (CSV, RFC 4180). [any thread]
#pragma once

#include <string>
#include <string_view>

#include "printable.h"

// Returns a text between quotes. One that a spreadsheet would take for a formula gets an apostrophe
// before it, and numbers do not.
inline std::string csvField(std::string_view text) {
  const bool isNumbers = text.find_first_not_of("0123456789.eE+-, ") == text.npos;
  const bool isFormula =
      !text.empty() && (text[0] == '=' || text[0] == '@' || text[0] == '\t' || text[0] == '\r' ||
                        ((text[0] == '+' || text[0] == '-') && !(isNumbers && text.size() > 1)));
  std::string out = isFormula ? "\"'" : "\"";
  for (const char c : printable(text)) {
    if (c == '"') out += '"';
    out += c;
  }
  return out + '"';
}
