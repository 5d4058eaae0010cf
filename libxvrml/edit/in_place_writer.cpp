#include "edit/in_place_writer.h"

#include <algorithm>
#include <unordered_set>
#include <utility>

#include <fmt/format.h>

#include "base/lexer.h"
#include "base/x3d.h"
#include "edit/changed_value.h"
#include "edit/lines.h"
#include "edit/list_steps.h"
#include "graph/field_access.h"
#include "write/value_writer.h"

namespace xvrml {
namespace {

using Kind = ListStep::Kind;

// A list of nodes in a text: its places, and the bytes between which they stand.
struct ListText {
  const DocumentText& text;
  const std::vector<NodePlace>& places;
  size_t end;
  std::string outer; // the indentation of the line that ends the list
  std::string inner; // that of the nodes
};

std::string deeper(std::string_view indentation) {
  return std::string(indentation) + (indentation.ends_with('\t') ? "\t" : "  ");
}

// Returns whether a USE names this node.
bool namesNode(std::string_view use, const std::string& name) {
  return use.size() > name.size() && use.ends_with(name) &&
         isVrmlSpace(use[use.size() - name.size() - 1]);
}

uint64_t placeKey(uint32_t line, uint32_t column) { return uint64_t(line) << 32 | column; }

// The text is copied from `at_` on wherever nothing has been edited.
class InPlaceWriter {
 public:
  explicit InPlaceWriter(const Document& document)
      : document_(document), feed_(lineFeedOf(document.file().text)) {
    for (const Route& route : document.scope().routes)
      routes_.emplace(placeKey(route.source.line, route.source.column), &route);
  }

  std::string file() {
    const DocumentText& file = document_.file();
    writeList({file, file.layout.roots, file.text.size(), "", ""}, document_.scope().roots);
    copy(file, file.text.size());
    for (const Route& route : document_.scope().routes)
      if (route.source.line == 0) addRoute(route);
    return std::move(out_);
  }

  // Returns the text of a node with this indentation, or its USE if it has been written already.
  std::string node(const Node* node, std::string_view indentation) {
    if (!node) return "NULL";
    if (written_.contains(node)) return "USE " + node->defName;
    const std::string& text = document_.textOf(*node).text;
    const size_t begin = document_.placeOf(*node).whole.begin;
    std::string outer = std::exchange(out_, {});
    const size_t at = std::exchange(at_, begin);
    writeNode(*node);
    const std::string own = std::exchange(out_, std::move(outer));
    at_ = at;
    return indented(own, indentationAt(text, begin), indentation);
  }

 private:
  std::string_view spelled(const Node& node, std::string_view field) const {
    const FileVersion& version = document_.world().head.version;
    return version.isX3d() && node.type().index >= 0
               ? x3dName(node.type().name, field, version.major)
               : field;
  }

  void raw(const DocumentText& text, size_t end) {
    if (end <= at_) return;
    out_.append(text.text, at_, end - at_);
    at_ = end;
  }

  // Copies the text up to a byte, but for routes that have been edited.
  void copy(const DocumentText& text, size_t end) {
    const std::vector<RouteText>& routes = text.layout.routes;
    auto route =
        std::lower_bound(routes.begin(), routes.end(), at_,
                         [](const RouteText& one, size_t at) { return one.whole.begin < at; });
    for (; route != routes.end() && route->whole.begin < end; ++route)
      if (route->valid) copyRoute(text, *route);
    raw(text, end);
  }

  void copyRoute(const DocumentText& text, const RouteText& place) {
    const auto found = routes_.find(placeKey(place.line, place.column));
    if (found == routes_.end()) return remove(text, place.whole);
    replaceName(text, place.from, *found->second->from);
    replaceName(text, place.to, *found->second->to);
  }

  void replaceName(const DocumentText& text, const TextSpan& span, const Node& node) {
    if (text.text.compare(span.begin, span.size(), node.defName) == 0) return;
    raw(text, span.begin);
    out_ += node.defName;
    at_ = span.end;
  }

  void addRoute(const Route& route) {
    if (!out_.empty() && out_.back() != '\n' && out_.back() != '\r') out_ += feed_;
    out_ += fmt::format("ROUTE {}.{} TO {}.{}{}", route.from->defName,
                        spelled(*route.from, route.fromField), route.to->defName,
                        spelled(*route.to, route.toField), feed_);
  }

  // Leaves a part of the text out, with its line if nothing else stands in it.
  void remove(const DocumentText& text, const TextSpan& span) {
    const std::string_view all = text.text;
    size_t begin = span.begin, end = span.end;
    while (end < all.size() && (isBlank(all[end]) || all[end] == ',')) ++end;
    if (startsLine(all, begin) && end == lineEnd(all, end) && lineBegin(all, begin) >= at_) {
      copy(text, lineBegin(all, begin));
      at_ = nextLine(all, end);
      return;
    }
    while (begin > at_ && isBlank(all[begin - 1])) --begin;
    copy(text, begin);
    at_ = span.end;
  }

  // Writes a node at its place in its text.
  void writeNode(const Node& node) {
    const DocumentText& text = document_.textOf(node);
    const NodeText& place = document_.placeOf(node);
    written_.insert(&node);
    if (place.name.size() > 0) {
      copy(text, place.name.begin);
      replaceName(text, place.name, node);
    } else if (!node.defName.empty()) {
      copy(text, place.whole.begin);
      out_ += fmt::format("DEF {} ", node.defName);
    }
    std::unordered_map<std::string_view, const FieldText*> given; // the last one of a name counts
    for (const FieldText& field : place.fields) given[field.name] = &field;
    for (const FieldText& field : place.fields)
      if (given[field.name] == &field) writeField(text, node, field);
    std::vector<const FieldInfo*> absent;
    for (const FieldInfo& field : node.type().fields)
      if (holdsValue(field) && !given.contains(field.name)) absent.push_back(&field);
    addFields(text, node, place, absent);
    copy(text, place.whole.end);
  }

  // Adds fields that the text does not have, before the closing brace: in lines of their own if
  // the brace stands in one.
  void addFields(const DocumentText& text, const Node& node, const NodeText& place,
                 const std::vector<const FieldInfo*>& fields) {
    const std::string_view all = text.text;
    const size_t brace = place.body.end - 1;
    const bool inLines = startsLine(all, brace);
    std::string indentation(indentationAt(all, brace));
    if (inLines) {
      const auto first =
          std::find_if(place.fields.begin(), place.fields.end(),
                       [&](const FieldText& field) { return startsLine(all, field.whole.begin); });
      indentation = first == place.fields.end()
                        ? deeper(indentation)
                        : std::string(indentationAt(all, first->whole.begin));
    }
    std::string added;
    for (const FieldInfo* field : fields) {
      const std::string value = addedValue(node, *field, indentation);
      if (value.empty()) continue;
      const std::string whole = fmt::format("{} {}", spelled(node, field->name), value);
      added += inLines ? indentation + whole + feed_ : " " + whole;
    }
    if (added.empty()) return;
    size_t at = brace;
    while (at > at_ && isBlank(all[at - 1])) --at;
    copy(text, at);
    out_ += added;
    if (!inLines && at == brace) out_ += ' ';
  }

  // Returns the value of a field that the text does not have; empty if the field still has that of
  // its type.
  std::string addedValue(const Node& node, const FieldInfo& field, const std::string& indentation) {
    if (field.type == FieldType::SFNode) {
      const auto& child = *static_cast<const NodeRef*>(node.storage(field));
      return child ? this->node(child.get(), indentation) : "";
    }
    if (field.type == FieldType::MFNode) {
      const auto& children = *static_cast<const MFNode*>(node.storage(field));
      return children.empty() ? "" : inBrackets(children, indentation);
    }
    const Value* const original = document_.originalOf(node, field);
    if (!original || *original == node.get(field)) return "";
    std::string value;
    writeValue(value, field.type, node.storage(field), indentation.size());
    return value;
  }

  // Returns a list with a line for each node.
  std::string inBrackets(const MFNode& children, const std::string& indentation) {
    const std::string inner = deeper(indentation);
    std::string out = "[";
    for (const NodeRef& child : children) out += feed_ + inner + node(child.get(), inner);
    return out + feed_ + indentation + "]";
  }

  void writeField(const DocumentText& text, const Node& node, const FieldText& place) {
    const FieldInfo& field = *node.type().find(place.name);
    if (field.type == FieldType::SFNode) return writeChild(text, node, field, place);
    if (field.type == FieldType::MFNode) return writeChildren(text, node, field, place);
    const Value* const original = document_.originalOf(node, field);
    if (!original || *original == node.get(field)) return;
    copy(text, place.value.begin);
    out_ += changedValue(std::string_view(text.text).substr(place.value.begin, place.value.size()),
                         field.type, *original, node.get(field),
                         indentationAt(text.text, place.whole.begin).size());
    at_ = place.value.end;
  }

  void writeChild(const DocumentText& text, const Node& node, const FieldInfo& field,
                  const FieldText& place) {
    const Node* const child = static_cast<const NodeRef*>(node.storage(field))->get();
    const NodePlace* const own = place.nodes.empty() ? nullptr : &place.nodes.back();
    if (own && own->node == child) {
      copy(text, own->span.begin);
      keep(text, *own);
    } else if (child) {
      copy(text, place.value.begin);
      out_ += this->node(child, indentationAt(text.text, place.whole.begin));
      at_ = place.value.end;
    } else if (own) {
      remove(text, place.whole);
    }
  }

  void writeChildren(const DocumentText& text, const Node& node, const FieldInfo& field,
                     const FieldText& place) {
    const auto& children = *static_cast<const MFNode*>(node.storage(field));
    const std::string indentation(indentationAt(text.text, place.whole.begin));
    copy(text, place.value.begin);
    if (text.text[place.value.begin] == '[') {
      copy(text, place.value.begin + 1);
      writeList({text, place.nodes, place.value.end - 1, indentation, deeper(indentation)},
                children);
    } else if (children.size() == 1 && place.nodes.size() == 1 &&
               children[0].get() == place.nodes[0].node) {
      keep(text, place.nodes[0]);
    } else {
      out_ += children.empty() ? "[ ]" : inBrackets(children, indentation);
      at_ = place.value.end;
    }
  }

  // Writes what stays at its place in a field or list.
  void keep(const DocumentText& text, const NodePlace& place) {
    const std::string own = text.text.substr(place.span.begin, place.span.size());
    if (place.node && !place.isUse && !written_.contains(place.node)) return writeNode(*place.node);
    const bool stays = !place.node || (place.isUse && written_.contains(place.node) &&
                                       namesNode(own, place.node->defName));
    out_ += stays ? own : node(place.node, indentationAt(text.text, place.span.begin));
    at_ = place.span.end;
  }

  void writeList(ListText list, const MFNode& nodes) {
    const std::string_view all = list.text.text;
    const auto inLine =
        std::find_if(list.places.begin(), list.places.end(),
                     [&](const NodePlace& place) { return startsLine(all, place.span.begin); });
    if (inLine != list.places.end()) list.inner = indentationAt(all, inLine->span.begin);
    const std::vector<ListStep> steps = listSteps(list.places, nodes);
    std::string waiting; // nodes to insert before the next place that is kept
    bool begun = false;  // a node has been written
    for (const ListStep& step : steps) {
      const NodePlace* const place = step.kind == Kind::insert ? nullptr : &list.places[step.place];
      switch (step.kind) {
      case Kind::remove: remove(list.text, place->span); break;
      case Kind::replace:
        copy(list.text, place->span.begin);
        out_ += node(step.node, indentationAt(all, place->span.begin));
        at_ = place->span.end;
        begun = true;
        break;
      case Kind::keep:
        copy(list.text, place->span.begin);
        out_ += std::exchange(waiting, {});
        keep(list.text, *place);
        begun = true;
        break;
      case Kind::insert:
        if (begun)
          insertBehind(list, node(step.node, list.inner));
        else if (inLine != list.places.end() || list.places.empty())
          waiting += node(step.node, list.inner) + feed_ + list.inner;
        else
          waiting += node(step.node, list.inner) + " ";
        break;
      }
    }
    if (!waiting.empty()) fill(list, waiting);
  }

  // Inserts a node behind the one that has been written: in the next line if nothing but a comment
  // follows in this one.
  void insertBehind(const ListText& list, const std::string& node) {
    const size_t end = lineEnd(list.text.text, at_);
    if (endsLine(list.text.text, at_) && end <= list.end) {
      copy(list.text, end);
      out_ += feed_ + list.inner + node;
    } else {
      out_ += " " + node;
    }
  }

  // Fills a list that is empty in the text. nodes: each with the beginning of the next line.
  void fill(const ListText& list, std::string nodes) {
    nodes.resize(nodes.size() - list.inner.size() - feed_.size());
    const std::string_view all = list.text.text;
    if (list.end == all.size()) { // the roots of a file
      copy(list.text, list.end);
      if (!out_.empty() && out_.back() != '\n' && out_.back() != '\r') out_ += feed_;
      out_ += nodes + feed_;
    } else if (startsLine(all, list.end)) { // a bracket in a line of its own
      copy(list.text, lineBegin(all, list.end));
      out_ += list.inner + nodes + feed_;
    } else {
      out_ += feed_ + list.inner + nodes + feed_ + list.outer;
      at_ = list.end;
    }
  }

  const Document& document_;
  const std::string feed_;
  std::unordered_map<uint64_t, const Route*> routes_; // by their places in the file
  std::unordered_set<const Node*> written_;
  std::string out_;
  size_t at_ = 0; // the first byte of the present text that has not been copied
};

} // namespace

std::string writeInPlace(const Document& document) { return InPlaceWriter(document).file(); }

std::string writeNode(const Document& document, const Node& node) {
  return InPlaceWriter(document).node(&node, "");
}

} // namespace xvrml
