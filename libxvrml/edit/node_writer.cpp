#include "edit/node_writer.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "base/lexer.h"
#include "base/x3d.h"
#include "edit/lines.h"
#include "parse/parser.h"
#include "xvrml/edit.h"

namespace xvrml {

using Kind = ListStep::Kind;

NodeWriter::NodeWriter(const Document& document, WritingPlan plan)
    : document_(document), feed_(lineFeedOf(document.file().text)), text_(document, plan.lifted),
      plan_(std::move(plan)) {}

std::string NodeWriter::file() {
  const DocumentText& file = document_.file();
  unchanged_.emplace(document_);
  text_.out.reserve(file.text.size());
  if (!plan_.lifted.empty()) {
    text_.copy(file, beginOfRoots());
    const bool inLines = startsLine(file.text, text_.at) && text_.at < file.text.size();
    const std::string indentation(inLines ? indentationAt(file, text_.at) : "");
    for (const PrototypeText* one : plan_.lifted)
      text_.out += indentation + file.text.substr(one->whole.begin, one->whole.size()) + feed_;
  }
  writeRoots(file);
  text_.copy(file, file.text.size());
  return finished(std::move(text_.out));
}

WritingPlan NodeWriter::missing() const {
  WritingPlan plan;
  plan.commented = leavesComments_;
  const std::vector<PrototypeText>& prototypes = document_.file().layout.prototypes;
  for (const PrototypeText& one : prototypes)
    if (&one <= last_ && one.whole.begin >= beginOfRoots()) plan.lifted.push_back(&one);
  return plan;
}

// Returns where the first root stands, with its line if it begins one.
size_t NodeWriter::beginOfRoots() const {
  const DocumentText& file = document_.file();
  if (file.layout.roots.empty()) return file.text.size();
  const size_t begin = file.layout.roots.front().span.begin;
  return startsLine(file.text, begin) ? lineBegin(file.text, begin) : begin;
}

std::string NodeWriter::node(const Node* node, std::string_view indentation, const Holder& holder) {
  if (!node) return "NULL";
  if (text_.written.contains(node)) return useOf(*node, holder);
  const DocumentText& text = document_.textOf(*node);
  const size_t begin = document_.placeOf(*node).whole.begin;
  const std::string_view from = indentationAt(text, begin);
  std::string outer = std::exchange(text_.out, {});
  const size_t at = std::exchange(text_.at, begin);
  writeNode(*node, &holder);
  const std::string own = std::exchange(text_.out, std::move(outer));
  text_.at = at;
  return indented(own, from, indentation);
}

// Edits may nest nodes deeper than any file does.
void NodeWriter::writeNode(const Node& node, const Holder* holder) {
  if (depth_ == Parser::maximumNesting)
    throw EditError(
        fmt::format("nodes stand in each other more than {} times, which no file can say",
                    Parser::maximumNesting));
  ++depth_;
  writeNodeText(node, holder);
  --depth_;
}

std::string NodeWriter::nodeInLines(const Node* node, std::string_view indentation,
                                    const Holder& holder) {
  if (!node || text_.written.contains(node) || !document_.isOwn(*node))
    return this->node(node, indentation, holder);
  const std::string_view text = document_.textOf(*node).text;
  const CommentedNode own = commented(text, document_.placeOf(*node).whole);
  std::string made = this->node(node, indentation, holder);
  if (!own.hasComments()) return made;
  if (plan_.commented.contains(node)) return withComments(text, own, made, indentation, feed_);
  leavesComments_.insert(node);
  return made;
}

// Returns whether the node of a place takes its comments along, or is nowhere any more.
bool NodeWriter::isGone(const NodePlace& place) const {
  return place.node && !place.isUse &&
         (plan_.commented.contains(place.node) || !document_.stands(*place.node));
}

// Notes whether the prototype of an instance has not been written yet.
void NodeWriter::noteInstance(const Node& node) {
  if (document_.file().layout.prototypes.empty()) return;
  if (const auto* instance = nodeCast<ProtoInstance>(&node))
    last_ = std::max(last_, text_.missingFor(*instance));
}

void NodeWriter::keepNodes(const DocumentText& text, const FieldText& field) {
  for (const NodePlace& one : field.nodes) {
    text_.copy(text, one.span.begin);
    keep(text, one, {});
  }
}

std::string_view NodeWriter::indentationAt(const DocumentText& text, size_t at) const {
  const std::string_view all = text.text;
  if (lineText_ != &text || at < lineAt_) {
    line_ = lineBegin(all, at);
  } else {
    size_t begin = at; // where the line begins, if that is behind the last place
    while (begin > lineAt_ && all[begin - 1] != '\n' && all[begin - 1] != '\r') --begin;
    if (begin > lineAt_) line_ = begin;
  }
  lineText_ = &text;
  lineAt_ = at;
  size_t end = line_;
  while (end < all.size() && isBlank(all[end])) ++end;
  return all.substr(line_, end - line_);
}

std::vector<const Route*> NodeWriter::routesToAdd() const {
  std::vector<const Route*> routes;
  for (const Route& route : document_.scope().routes)
    if (!text_.copied.contains(&route)) routes.push_back(&route);
  return routes;
}

std::unordered_map<std::string_view, const FieldText*> NodeWriter::lastOf(const NodeText& place) {
  std::unordered_map<std::string_view, const FieldText*> last;
  for (const FieldText& field : place.fields) last[field.name] = &field;
  return last;
}

// Returns whether two values are equal. Numbers of a file that are NaN are equal to themselves.
static bool areSameValues(FieldType type, const Value& a, const Value& b) {
  if (a == b) return true;
  const ValueWords first(type, a), second(type, b);
  if (first.size() == 0 || first.size() != second.size()) return false; // nodes have no words
  for (size_t i = 0; i < first.size(); ++i)
    if (first.bytes(i) != second.bytes(i)) return false;
  return true;
}

const Value* NodeWriter::editedFrom(const Node& node, const FieldInfo& field) const {
  const Value* const original = document_.originalOf(node, field);
  return original && !areSameValues(field.type, *original, node.get(field)) ? original : nullptr;
}

std::string_view NodeWriter::spelled(const Node& node, std::string_view field) const {
  const FileVersion& version = document_.world().head.version;
  return version.isX3d() && node.type().index >= 0 ? x3dName(node.type().name, field, version.major)
                                                   : field;
}

std::string NodeWriter::deeper(std::string_view indentation) {
  return std::string(indentation) + (indentation.ends_with('\t') ? "\t" : "  ");
}

MFNode NodeWriter::nodesOf(const Node& node, const FieldInfo& field) {
  if (field.type == FieldType::MFNode) return *static_cast<const MFNode*>(node.storage(field));
  const NodeRef& child = *static_cast<const NodeRef*>(node.storage(field));
  return child ? MFNode{child} : MFNode();
}

std::vector<ListItem> NodeWriter::itemsOf(const DocumentText& text,
                                          const std::vector<NodePlace>& places, const MFNode& nodes,
                                          const Holder& holder) {
  std::vector<ListItem> items;
  const auto addKept = [&](const NodePlace& place) {
    items.push_back(
        {Kind::keep, place.span, [this, &text, holder, place] { keep(text, place, holder); }, {}});
  };
  // Nodes that the world has not taken stay where they are.
  std::vector<NodePlace> taken, others;
  std::partition_copy(places.begin(), places.end(), std::back_inserter(taken),
                      std::back_inserter(others), [](const NodePlace& one) { return one.taken; });
  auto other = others.begin();
  for (const ListStep& step : listSteps(taken, nodes)) {
    if (step.place)
      for (; other != others.end() && other->span.begin < step.place->span.begin; ++other)
        addKept(*other);
    if (step.kind == Kind::keep) {
      addKept(*step.place);
      continue;
    }
    ListItem& item = items.emplace_back();
    item.kind = step.kind;
    if (step.place) {
      item.span = item.outer = step.place->span;
      if (isGone(*step.place)) {
        const CommentedNode gone = commented(text.text, item.span);
        item.outer = {gone.begin, gone.end};
      }
    }
    item.make = [this, holder, fresh = step.node](std::string_view indentation, bool inLines) {
      return inLines ? nodeInLines(fresh, indentation, holder) : node(fresh, indentation, holder);
    };
  }
  std::for_each(other, others.end(), addKept);
  return items;
}

void NodeWriter::keep(const DocumentText& text, const NodePlace& place, const Holder& holder) {
  const bool isWritten = place.node && text_.written.contains(place.node);
  if (!place.node || (place.isUse && !place.taken && !isWritten))
    text_.copy(text, place.span.end);
  else if (place.isUse == isWritten)
    place.isUse ? keepUse(text, place) : writeStanding(text, *place.node);
  else
    text_.out += node(place.node, indentationAt(text, place.span.begin), holder);
  text_.at = place.span.end;
}

// Writes a node where it stands in the text: as one piece if nothing in it has been edited. The
// routes in it need to know that its nodes are written.
void NodeWriter::writeStanding(const DocumentText& text, const Node& node) {
  const std::span<const NodeText> all =
      unchanged_ ? unchanged_->within(node) : std::span<const NodeText>();
  if (all.empty()) return writeNode(node, nullptr);
  for (const NodeText& one : all) text_.written.insert(one.node.get());
  text_.copy(text, all.back().whole.end);
  for (const NodeText& one : all) noteInstance(*one.node);
}

const ListItem* NodeWriter::inLine(std::string_view text, const std::vector<ListItem>& items) {
  const auto found = std::find_if(items.begin(), items.end(), [&](const ListItem& item) {
    return item.hasPlace() && startsLine(text, item.span.begin);
  });
  return found == items.end() ? nullptr : &*found;
}

void NodeWriter::writeNodeList(const ListText& list, const std::vector<NodePlace>& places,
                               const MFNode& nodes, const Holder& holder) {
  auto next = nodes.begin();
  const bool isSame =
      std::all_of(places.begin(), places.end(),
                  [&](const NodePlace& place) {
                    return !place.taken || (next != nodes.end() && (next++)->get() == place.node);
                  }) &&
      next == nodes.end();
  if (!isSame) return writeList(list, itemsOf(list.text, places, nodes, holder));
  for (const NodePlace& place : places) {
    text_.copy(list.text, place.span.begin);
    keep(list.text, place, holder);
  }
}

void NodeWriter::writeList(ListText list, const std::vector<ListItem>& items) {
  const std::string_view all = list.text.text;
  const ListItem* const first = inLine(all, items);
  if (first) list.inner = indentationAt(list.text, first->span.begin);
  const bool hasPlaces =
      std::any_of(items.begin(), items.end(), [](const ListItem& item) { return item.hasPlace(); });
  std::string waiting; // nodes to insert before the next place that is kept, or into an empty list
  bool begun = false;  // a node has been written
  for (const ListItem& item : items) {
    switch (item.kind) {
    case Kind::remove: text_.remove(list.text, item.outer); break;
    case Kind::replace: {
      const std::string indentation(indentationAt(list.text, item.span.begin));
      const bool inLines = startsLine(all, item.span.begin) && endsLine(all, item.span.end);
      text_.copy(list.text, item.outer.begin); // with the routes before the node
      if (item.outer.begin < item.span.begin) text_.out += indentation;
      const std::string made = item.make(indentation, inLines);
      text_.out += made;
      text_.at = item.outer.end;
      begun = true;
      break;
    }
    case Kind::keep:
      if (!waiting.empty()) insertBefore(list, item.span, std::exchange(waiting, {}));
      text_.copy(list.text, item.span.begin);
      item.copy();
      begun = true;
      break;
    case Kind::before:
    case Kind::behind:
      if (begun && item.kind == Kind::behind) {
        insertBehind(list, item);
      } else {
        const bool inLines = first || !hasPlaces || item.kind == Kind::behind;
        waiting += item.make(list.inner, inLines) + (inLines ? feed_ + list.inner : " ");
      }
      break;
    }
  }
  if (!waiting.empty()) fill(list, waiting);
}

// Inserts nodes before one that stays, and before the comments of that one. nodes: each with the
// beginning of the next line, or with a blank.
void NodeWriter::insertBefore(const ListText& list, const TextSpan& node, std::string nodes) {
  const CommentedNode next = commented(list.text.text, node);
  text_.copy(list.text, next.begin);
  if (next.begin < node.begin) { // lines of comments, which have their own indentation
    nodes.resize(nodes.size() - list.inner.size());
    text_.out += list.inner;
  }
  text_.out += nodes;
}

// Inserts a node behind the one that has been written: in the next line if nothing but a comment
// follows in this one.
void NodeWriter::insertBehind(const ListText& list, const ListItem& item) {
  const std::string_view all = list.text.text;
  const size_t end = endsLine(all, text_.at) ? lineEnd(all, text_.at) : all.size() + 1;
  const bool inLines = end <= list.end;
  const std::string node = item.make(list.inner, inLines);
  if (inLines) text_.copy(list.text, end);
  text_.out += (inLines ? feed_ + list.inner : " ") + node;
}

// Fills a list that is empty in the text. nodes: each with the beginning of the next line.
void NodeWriter::fill(const ListText& list, std::string nodes) {
  nodes.resize(nodes.size() - list.inner.size() - feed_.size());
  const std::string_view all = list.text.text;
  if (list.end == all.size()) { // the roots of a file
    text_.copy(list.text, list.end);
    if (!text_.out.empty() && text_.out.back() != '\n' && text_.out.back() != '\r')
      text_.out += feed_;
    text_.out += nodes + feed_;
  } else if (startsLine(all, list.end)) { // a bracket or end tag in a line of its own
    text_.copy(list.text, lineBegin(all, list.end));
    text_.out += list.inner + nodes + feed_;
  } else { // what could not be read stays
    size_t rest = list.end;
    while (rest > text_.at && isVrmlSpace(all[rest - 1])) --rest;
    text_.copy(list.text, rest);
    text_.out += feed_ + list.inner + nodes + feed_ + list.outer;
    text_.at = list.end;
  }
}

} // namespace xvrml
