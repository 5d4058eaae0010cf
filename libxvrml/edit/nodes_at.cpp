#include "edit/nodes_at.h"

#include <algorithm>
#include <numeric>

#include "edit/lines.h"

namespace xvrml {
namespace {

constexpr size_t nowhere = ~size_t(0);

bool isContinuationByte(char c) { return (static_cast<unsigned char>(c) & 0xc0) == 0x80; }

// Returns where the places stand in the text; `nowhere` for those that it does not have. The order
// is that of their lines and columns, so that the text is read once.
std::vector<size_t> offsetsOf(std::string_view text, std::span<const SourcePosition> places,
                              const std::vector<size_t>& order) {
  std::vector<size_t> offsets(places.size(), nowhere);
  size_t at = 0; // the byte of this line and column
  size_t end = lineEnd(text, 0);
  uint32_t line = 1, column = 1;
  for (const size_t i : order) {
    const SourcePosition& place = places[i];
    if (place.line == 0) continue;
    for (; line < place.line && at < text.size(); ++line) {
      at = nextLine(text, end);
      end = lineEnd(text, at);
      column = 1;
    }
    for (; column < place.column && at < end; ++column) do
        ++at;
      while (at < end && isContinuationByte(text[at]));
    if (line == place.line) offsets[i] = at; // the end of the line for columns behind it
  }
  return offsets;
}

// Returns the texts of the nodes that stand in the file, in its order: outer ones first.
std::vector<const NodeText*> textsOf(const Document& document) {
  std::vector<const NodeText*> texts;
  for (const NodeText& text : document.file().layout.nodes)
    if (document.stands(*text.node)) texts.push_back(&text);
  std::sort(texts.begin(), texts.end(), [](const NodeText* a, const NodeText* b) {
    return a->whole.begin != b->whole.begin ? a->whole.begin < b->whole.begin
                                            : a->whole.end > b->whole.end;
  });
  return texts;
}

} // namespace

std::vector<const Node*> nodesAt(const Document& document, std::span<const SourcePosition> places) {
  std::vector<const Node*> nodes(places.size());
  std::vector<size_t> order(places.size());
  std::iota(order.begin(), order.end(), size_t(0));
  std::sort(order.begin(), order.end(), [places](size_t a, size_t b) {
    return placeKey(places[a].line, places[a].column) < placeKey(places[b].line, places[b].column);
  });
  const std::vector<size_t> offsets = offsetsOf(document.file().text, places, order);
  const std::vector<const NodeText*> texts = textsOf(document);
  std::vector<const NodeText*> open; // the nodes around the place, outer ones first
  size_t next = 0;
  for (const size_t i : order) {
    const size_t offset = offsets[i];
    if (offset == nowhere) continue;
    const auto closeBefore = [&open](size_t at) {
      while (!open.empty() && open.back()->whole.end <= at) open.pop_back();
    };
    for (; next < texts.size() && texts[next]->whole.begin <= offset; ++next) {
      closeBefore(texts[next]->whole.begin);
      open.push_back(texts[next]);
    }
    closeBefore(offset);
    if (!open.empty()) nodes[i] = open.back()->node.get();
  }
  return nodes;
}

} // namespace xvrml
