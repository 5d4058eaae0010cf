#include "edit/lines.h"

#include <algorithm>

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

bool endsXmlLine(std::string_view text, size_t at) {
  const size_t end = lineEnd(text, at);
  std::string_view rest = text.substr(at, end - at);
  const auto skipBlanks = [&] {
    while (!rest.empty() && isBlank(rest[0])) rest.remove_prefix(1);
  };
  skipBlanks();
  if (rest.starts_with("<!--")) {
    const size_t close = rest.find("-->");
    if (close == rest.npos) return false;
    rest.remove_prefix(close + 3);
    skipBlanks();
  }
  return rest.empty();
}

std::string_view lineFeedOf(std::string_view text) {
  const size_t end = lineEnd(text, 0);
  const std::string_view found = text.substr(end, nextLine(text, end) - end);
  return found.empty() ? "\n" : found;
}

namespace {

// Returns whether the byte `at` ends a line.
bool endsLineAt(std::string_view text, size_t at) {
  return text[at] == '\n' || (text[at] == '\r' && text.substr(at + 1, 1) != "\n");
}

// Follows the strings and comments of a text in ClassicVRML or JSON.
struct Strings {
  bool isInside = false; // the byte that was taken last belongs to a string
  bool isEscaped = false, inComment = false;

  void take(char c) {
    if (isInside) {
      isInside = isEscaped || c != '"';
      isEscaped = !isEscaped && c == '\\';
    } else if (c == '\n' || c == '\r') {
      inComment = false;
    } else if (!inComment) {
      isInside = c == '"';
      inComment = c == '#';
    }
  }
};

} // namespace

std::string withLineFeed(std::string_view text, std::string_view feed, bool isXml) {
  std::string out;
  out.reserve(text.size());
  Strings strings;
  for (size_t i = 0; i < text.size(); ++i) {
    if (!isXml) strings.take(text[i]);
    if (strings.isInside || (text[i] != '\n' && text[i] != '\r'))
      out += text[i];
    else if (endsLineAt(text, i))
      out += feed;
  }
  return out;
}

std::string indented(std::string_view text, std::string_view from, std::string_view to) {
  std::string out;
  Strings strings;
  for (size_t i = 0; i < text.size(); ++i) {
    out += text[i];
    strings.take(text[i]);
    if (!strings.isInside && endsLineAt(text, i) && text.substr(i + 1).starts_with(from)) {
      out += to;
      i += from.size();
    }
  }
  return out;
}

std::string indentedXml(std::string_view text, std::string_view from, std::string_view to) {
  std::string out;
  bool inTag = false;
  char quote = 0;     // around the value that the byte stands in
  size_t comment = 0; // where the comment ends that the byte stands in
  for (size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (!inTag && i >= comment && text.substr(i).starts_with("<![CDATA[")) {
      const size_t end = std::min(text.find("]]>", i), text.size());
      out += text.substr(i, end - i);
      i = end - 1;
      continue;
    }
    if (!inTag && i >= comment && text.substr(i).starts_with("<!--"))
      comment = std::min(text.find("-->", i + 4), text.size());
    out += c;
    if (i < comment) {
      // Quotes and brackets mean nothing.
    } else if (quote != 0) {
      if (c == quote) quote = 0;
    } else if (inTag) {
      if (c == '"' || c == '\'') quote = c;
      if (c == '>') inTag = false;
    } else if (c == '<') {
      inTag = true;
    }
    if (!endsLineAt(text, i) || quote != 0) continue;
    const std::string_view rest = text.substr(i + 1);
    const size_t word = rest.find_first_not_of(" \t");
    const bool isText = i >= comment && !inTag && word != rest.npos && rest[word] != '<';
    if (!isText && rest.starts_with(from)) {
      out += to;
      i += from.size();
    }
  }
  return out;
}

} // namespace xvrml
