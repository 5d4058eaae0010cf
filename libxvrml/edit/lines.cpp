#include "edit/lines.h"

namespace xvrml {

std::string_view indentationAt(std::string_view text, size_t at) {
  const size_t begin = lineBegin(text, at);
  size_t end = begin;
  while (end < text.size() && isBlank(text[end])) ++end;
  return text.substr(begin, end - begin);
}

bool startsLine(std::string_view text, size_t at) {
  while (at > 0 && isBlank(text[at - 1])) --at;
  return at == 0 || text[at - 1] == '\n' || text[at - 1] == '\r';
}

bool endsLine(std::string_view text, size_t at) {
  while (at < text.size() && (isBlank(text[at]) || text[at] == ',')) ++at;
  return at == text.size() || text[at] == '\n' || text[at] == '\r' || text[at] == '#';
}

std::string_view lineFeedOf(std::string_view text) {
  const size_t end = lineEnd(text, 0);
  const std::string_view found = text.substr(end, nextLine(text, end) - end);
  return found.empty() ? "\n" : found;
}

std::string indented(std::string_view text, std::string_view from, std::string_view to) {
  std::string out;
  bool inString = false, inComment = false;
  for (size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    out += c;
    if (inString) {
      if (c == '\\' && i + 1 < text.size())
        out += text[++i];
      else if (c == '"')
        inString = false;
      continue;
    }
    const bool ends = c == '\n' || (c == '\r' && text.substr(i + 1, 1) != "\n");
    if (ends) {
      inComment = false;
      if (text.substr(i + 1).starts_with(from)) {
        out += to;
        i += from.size();
      }
    } else if (!inComment) {
      inString = c == '"';
      inComment = c == '#';
    }
  }
  return out;
}

} // namespace xvrml
