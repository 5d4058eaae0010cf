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
#include "edit/text_copier.h"
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

// The text is copied wherever nothing has been edited.
class InPlaceWriter {
 public:
  // lifted: prototypes that stand before all nodes.
  explicit InPlaceWriter(const Document& document, std::vector<const PrototypeText*> lifted = {})
      : document_(document), feed_(lineFeedOf(document.file().text)), text_(document, lifted),
        lifted_(std::move(lifted)) {}

  std::string file() {
    const DocumentText& file = document_.file();
    if (!lifted_.empty()) text_.copy(file, beginOfRoots());
    for (const PrototypeText* one : lifted_)
      text_.out += file.text.substr(one->whole.begin, one->whole.size()) + feed_;
    writeList({file, file.layout.roots, file.text.size(), "", ""}, document_.scope().roots);
    text_.copy(file, file.text.size());
    for (const Route* route : text_.postponed) addRoute(*route);
    for (const Route& route : document_.scope().routes)
      if (route.source.line == 0) addRoute(route);
    return std::move(text_.out);
  }

  // Returns the prototypes that must be lifted, because instances have been written before them:
  // those that were missing, and those before them, which they may use.
  std::vector<const PrototypeText*> missing() const {
    std::vector<const PrototypeText*> all;
    const std::vector<PrototypeText>& prototypes = document_.file().layout.prototypes;
    for (const PrototypeText& one : prototypes)
      if (&one <= last_ && one.whole.begin >= beginOfRoots()) all.push_back(&one);
    return all;
  }

  // Returns the text of a node with this indentation, or its USE if it has been written already.
  std::string node(const Node* node, std::string_view indentation) {
    if (!node) return "NULL";
    if (text_.written.contains(node)) return "USE " + node->defName;
    const std::string& text = document_.textOf(*node).text;
    const size_t begin = document_.placeOf(*node).whole.begin;
    std::string outer = std::exchange(text_.out, {});
    const size_t at = std::exchange(text_.at, begin);
    writeNode(*node);
    const std::string own = std::exchange(text_.out, std::move(outer));
    text_.at = at;
    return indented(own, indentationAt(text, begin), indentation);
  }

 private:
  // Returns where the first root stands, with its line if it begins one.
  size_t beginOfRoots() const {
    const DocumentText& file = document_.file();
    if (file.layout.roots.empty()) return file.text.size();
    const size_t begin = file.layout.roots.front().span.begin;
    return startsLine(file.text, begin) ? lineBegin(file.text, begin) : begin;
  }

  std::string_view spelled(const Node& node, std::string_view field) const {
    const FileVersion& version = document_.world().head.version;
    return version.isX3d() && node.type().index >= 0
               ? x3dName(node.type().name, field, version.major)
               : field;
  }

  void addRoute(const Route& route) {
    if (!text_.out.empty() && text_.out.back() != '\n' && text_.out.back() != '\r')
      text_.out += feed_;
    text_.out += fmt::format("ROUTE {}.{} TO {}.{}{}", route.from->defName,
                             spelled(*route.from, route.fromField), route.to->defName,
                             spelled(*route.to, route.toField), feed_);
  }

  // Writes a node at its place in its text.
  void writeNode(const Node& node) {
    const DocumentText& text = document_.textOf(node);
    const NodeText& place = document_.placeOf(node);
    text_.written.insert(&node);
    if (const auto* instance = nodeCast<ProtoInstance>(&node))
      last_ = std::max(last_, text_.missingFor(*instance));
    if (place.name.size() > 0) {
      text_.copy(text, place.name.begin);
      text_.replaceName(text, place.name, node);
    } else if (!node.defName.empty()) {
      text_.copy(text, place.whole.begin);
      text_.out += fmt::format("DEF {} ", node.defName);
    }
    std::unordered_map<std::string_view, const FieldText*> given; // the last one of a name counts
    for (const FieldText& field : place.fields) given[field.name] = &field;
    for (const FieldText& field : place.fields)
      if (given[field.name] == &field && field.faithful)
        writeField(text, node, field);
      else // its text stays as it is
        for (const NodePlace& one : field.nodes) markWritten(one.node);
    std::vector<const FieldInfo*> absent;
    for (const FieldInfo& field : node.type().fields)
      if (holdsValue(field) && !given.contains(field.name)) absent.push_back(&field);
    addFields(text, node, place, absent);
    text_.copy(text, place.whole.end);
  }

  // Notes that a node has been written with all that its text has.
  void markWritten(const Node* node) {
    if (!node || !document_.hasText(*node) || !text_.written.insert(node).second) return;
    for (const FieldText& field : document_.placeOf(*node).fields)
      for (const NodePlace& one : field.nodes) markWritten(one.node);
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
    while (at > text_.at && isBlank(all[at - 1])) --at;
    text_.copy(text, at);
    text_.out += added;
    if (!inLines && at == brace) text_.out += ' ';
  }

  // Returns the value of a field that the text does not have; empty if it has not been edited.
  std::string addedValue(const Node& node, const FieldInfo& field, const std::string& indentation) {
    const Value* const original = document_.originalOf(node, field);
    if (!original || *original == node.get(field)) return "";
    if (field.type == FieldType::SFNode)
      return this->node(static_cast<const NodeRef*>(node.storage(field))->get(), indentation);
    if (field.type == FieldType::MFNode)
      return inBrackets(*static_cast<const MFNode*>(node.storage(field)), indentation);
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
    text_.copy(text, place.value.begin);
    text_.out += changedValue(
        std::string_view(text.text).substr(place.value.begin, place.value.size()), field.type,
        *original, node.get(field), indentationAt(text.text, place.whole.begin).size());
    text_.at = place.value.end;
  }

  void writeChild(const DocumentText& text, const Node& node, const FieldInfo& field,
                  const FieldText& place) {
    const Node* const child = static_cast<const NodeRef*>(node.storage(field))->get();
    const NodePlace* const own = place.nodes.empty() ? nullptr : &place.nodes.back();
    if (own && own->node == child) {
      text_.copy(text, own->span.begin);
      keep(text, *own);
    } else if (child) {
      text_.copy(text, place.value.begin);
      text_.out += this->node(child, indentationAt(text.text, place.whole.begin));
      text_.at = place.value.end;
    } else if (own && place.declared) {
      text_.copy(text, place.value.begin);
      text_.out += "NULL";
      text_.at = place.value.end;
    } else if (own) {
      text_.remove(text, place.whole);
    }
  }

  void writeChildren(const DocumentText& text, const Node& node, const FieldInfo& field,
                     const FieldText& place) {
    const auto& children = *static_cast<const MFNode*>(node.storage(field));
    const std::string indentation(indentationAt(text.text, place.whole.begin));
    if (place.nodes.empty() && children.empty()) return;
    text_.copy(text, place.value.begin);
    if (text.text[place.value.begin] == '[') {
      text_.copy(text, place.value.begin + 1);
      writeList({text, place.nodes, place.value.end - 1, indentation, deeper(indentation)},
                children);
    } else if (children.size() == 1 && place.nodes.size() == 1 &&
               children[0].get() == place.nodes[0].node) {
      keep(text, place.nodes[0]);
    } else {
      text_.out += children.empty() ? "[ ]" : inBrackets(children, indentation);
      text_.at = place.value.end;
    }
  }

  // Writes what stays at its place in a field or list.
  void keep(const DocumentText& text, const NodePlace& place) {
    const std::string own = text.text.substr(place.span.begin, place.span.size());
    if (place.node && !place.isUse && !text_.written.contains(place.node))
      return writeNode(*place.node);
    const bool stays = !place.node || (place.isUse && text_.written.contains(place.node) &&
                                       namesNode(own, place.node->defName));
    text_.out += stays ? own : node(place.node, indentationAt(text.text, place.span.begin));
    text_.at = place.span.end;
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
      case Kind::remove: text_.remove(list.text, place->span); break;
      case Kind::replace:
        text_.copy(list.text, place->span.begin);
        text_.out += node(step.node, indentationAt(all, place->span.begin));
        text_.at = place->span.end;
        begun = true;
        break;
      case Kind::keep:
        text_.copy(list.text, place->span.begin);
        text_.out += std::exchange(waiting, {});
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
    const size_t end = lineEnd(list.text.text, text_.at);
    if (endsLine(list.text.text, text_.at) && end <= list.end) {
      text_.copy(list.text, end);
      text_.out += feed_ + list.inner + node;
    } else {
      text_.out += " " + node;
    }
  }

  // Fills a list that is empty in the text. nodes: each with the beginning of the next line.
  void fill(const ListText& list, std::string nodes) {
    nodes.resize(nodes.size() - list.inner.size() - feed_.size());
    const std::string_view all = list.text.text;
    if (list.end == all.size()) { // the roots of a file
      text_.copy(list.text, list.end);
      if (!text_.out.empty() && text_.out.back() != '\n' && text_.out.back() != '\r')
        text_.out += feed_;
      text_.out += nodes + feed_;
    } else if (startsLine(all, list.end)) { // a bracket in a line of its own
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

  const Document& document_;
  const std::string feed_;
  TextCopier text_;
  const std::vector<const PrototypeText*> lifted_;
  const PrototypeText* last_ = nullptr; // the last prototype of the file that was missing
};

} // namespace

std::string writeInPlace(const Document& document) {
  InPlaceWriter writer(document);
  std::string text = writer.file();
  const std::vector<const PrototypeText*> missing = writer.missing();
  return missing.empty() ? text : InPlaceWriter(document, missing).file();
}

std::string writeNode(const Document& document, const Node& node) {
  return InPlaceWriter(document).node(&node, "");
}

} // namespace xvrml
