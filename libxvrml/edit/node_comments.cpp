#include "edit/node_comments.h"

#include "edit/lines.h"

namespace xvrml {
namespace {

std::string_view withoutBlanks(std::string_view line) {
  while (!line.empty() && isBlank(line.front())) line.remove_prefix(1);
  while (!line.empty() && isBlank(line.back())) line.remove_suffix(1);
  return line;
}

// Returns the end of the line before the one that begins at a byte. There must be one.
size_t endBefore(std::string_view text, size_t begin) {
  size_t end = begin - 1;
  if (end > 0 && text[end] == '\n' && text[end - 1] == '\r') --end;
  return end;
}

// isComment: tells whether a line is nothing but a comment.
size_t beginOfComments(std::string_view text, size_t node, bool (*isComment)(std::string_view)) {
  size_t begin = lineBegin(text, node);
  while (begin > 0) {
    const size_t end = endBefore(text, begin), above = lineBegin(text, end);
    if (!isComment(withoutBlanks(text.substr(above, end - above)))) break;
    if (above == 0) return node; // the header, and what follows it
    begin = above;
  }
  return begin < lineBegin(text, node) ? begin : node;
}

bool isClassicComment(std::string_view line) { return line.starts_with('#'); }
bool isXmlComment(std::string_view line) {
  return line.starts_with("<!--") && line.find("-->") == line.size() - 3;
}

CommentedNode commented(std::string_view text, const TextSpan& node, std::string_view mark,
                        bool (*isComment)(std::string_view)) {
  CommentedNode found{node.begin, node.end, node.end, node};
  found.begin = beginOfComments(text, node.begin, isComment);
  size_t at = node.end;
  while (at < text.size() && (isBlank(text[at]) || text[at] == ',')) ++at;
  if (text.substr(at).starts_with(mark)) {
    found.comment = at;
    found.end = lineEnd(text, at);
  }
  return found;
}

} // namespace

CommentedNode commentedNode(std::string_view text, const TextSpan& node) {
  if (!startsLine(text, node.begin) || !endsLine(text, node.end))
    return {node.begin, node.end, node.end, node};
  return commented(text, node, "#", isClassicComment);
}

CommentedNode commentedXmlNode(std::string_view text, const TextSpan& node) {
  if (!startsLine(text, node.begin) || !endsXmlLine(text, node.end))
    return {node.begin, node.end, node.end, node};
  return commented(text, node, "<!--", isXmlComment);
}

std::string withComments(std::string_view text, const CommentedNode& node, std::string made,
                         std::string_view indentation, std::string_view feed) {
  std::string out;
  for (size_t at = node.begin; at < lineBegin(text, node.node.begin);) {
    const size_t end = lineEnd(text, at);
    out.append(withoutBlanks(text.substr(at, end - at))).append(feed).append(indentation);
    at = nextLine(text, end);
  }
  out += made;
  if (node.comment < node.end)
    out.append(" ").append(text.substr(node.comment, node.end - node.comment));
  return out;
}

} // namespace xvrml
