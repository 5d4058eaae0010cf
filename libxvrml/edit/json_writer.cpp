// json_writer.cpp: the nodes of X3D in JSON (ISO/IEC 19776-5). A node is an object with its type as
// its only member: {"Shape": {"@DEF": "S", "-geometry": {"Box": {}}}}. Commas are set when all has
// been written.
#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "edit/changed_value.h"
#include "edit/json_commas.h"
#include "edit/lines.h"
#include "edit/node_writer.h"
#include "graph/field_access.h"

namespace xvrml {
namespace {

bool isSpace(char c) { return isBlank(c) || c == '\n' || c == '\r'; }

// Returns where a string ends that begins at a byte, with its quotes.
size_t endOfString(std::string_view text, size_t begin) {
  size_t end = begin + 1;
  while (end < text.size() && text[end] != '"') end += text[end] == '\\' ? 2 : 1;
  return std::min(end + 1, text.size());
}

// How a file writes members and objects.
class JsonStyle {
 public:
  // Takes the style of the first member behind a byte.
  JsonStyle(std::string_view text, size_t begin) {
    const size_t name = std::min(text.find('"', begin), text.size());
    size_t end = begin = endOfString(text, name);
    while (end < text.size() && isBlank(text[end])) ++end;
    if (end == text.size() || text[end] != ':') return;
    ++end;
    while (end < text.size() && isBlank(text[end])) ++end;
    colon_ = text.substr(begin, end - begin);
  }

  std::string member(std::string_view name, std::string_view value) const {
    return fmt::format("{}{}{}", jsonString(name), colon_, value);
  }
  // Returns an object that stands for an element with these attributes.
  std::string
  element(std::string_view type,
          const std::vector<std::pair<std::string_view, std::string_view>>& values) const {
    std::string all;
    for (const auto& [name, value] : values)
      all += (all.empty() ? "" : ", ") + member(name, jsonString(value));
    return "{" + member(type, "{" + all + "}") + "}";
  }

 private:
  std::string colon_ = ": ";
};

// Returns the style of a node's first member or, if it has none, of its object.
JsonStyle styleIn(const DocumentText& text, const NodeText& place) {
  const bool isEmpty = text.text.find('"', place.body.begin) >= place.body.end;
  return {text.text, isEmpty ? place.whole.begin : place.body.begin};
}

// Returns where the name of a USE stands, with its quotes, in the object that begins at a byte:
// {"Type": {"@USE": "name"}}. Members of nodes within it are passed over.
size_t useIn(std::string_view text, size_t begin) {
  int depth = 0;
  for (size_t at = begin; at < text.size(); ++at) {
    const char c = text[at];
    if (c == '{' || c == '[') ++depth;
    if (c == '}' || c == ']') --depth;
    if (c != '"') continue;
    const size_t end = endOfString(text, at);
    const bool isUse = depth == 2 && text.substr(at, end - at) == "\"@USE\"";
    at = end;
    while (at < text.size() && isSpace(text[at])) ++at;
    if (isUse && at < text.size() && text[at] == ':') {
      do ++at;
      while (at < text.size() && isSpace(text[at]));
      return at;
    }
    --at;
  }
  return text.size();
}

// Returns whether a list, or no list, has nothing in it.
bool isEmptyList(std::string_view text, const TextSpan& list) {
  for (size_t at = list.begin + 1; at + 1 < list.end; ++at)
    if (!isSpace(text[at])) return false;
  return true;
}
// Returns the number of white-space characters before a byte.
size_t blanksBefore(const DocumentText& text, size_t at) {
  size_t begin = at;
  while (begin > 0 && isSpace(text.text[begin - 1])) --begin;
  return at - begin;
}

class JsonWriter : public NodeWriter {
 public:
  JsonWriter(const Document& document, WritingPlan plan)
      : NodeWriter(document, std::move(plan)), style_(document.file().text, 0) {}

 private:
  // Returns a text of a node, route or member with an indentation.
  using Make = std::function<std::string(std::string_view indentation)>;

  std::string finished(std::string text) const override { return withCommas(text); }
  CommentedNode commented(std::string_view, const TextSpan& node) const override {
    return {node.begin, node.end, node.end, node}; // comments are members
  }
  bool endsLine(std::string_view text, size_t at) const override {
    return xvrml::endsLine(text, at);
  }
  std::string indented(std::string_view text, std::string_view from,
                       std::string_view to) const override {
    return xvrml::indented(text, from, to);
  }

  std::string routeText(const Route& route) const {
    return style_.element("ROUTE", {{"@fromNode", route.from->defName},
                                    {"@fromField", spelled(*route.from, route.fromField)},
                                    {"@toNode", route.to->defName},
                                    {"@toField", spelled(*route.to, route.toField)}});
  }

  std::string useOf(const Node& node, const Holder&) const override {
    const std::string_view type = node.type().name;
    if (nodeCast<ProtoInstance>(&node))
      return style_.element("ProtoInstance", {{"@name", type}, {"@USE", node.defName}});
    return style_.element(type, {{"@USE", node.defName}});
  }

  void keepUse(const DocumentText& text, const NodePlace& place) override {
    if (document_.nameInText(*place.node) != place.node->defName) {
      text_.copy(text, useIn(text.text, place.span.begin));
      text_.out += jsonString(place.node->defName);
      text_.at = endOfString(text.text, text_.at);
    }
    text_.copy(text, place.span.end);
  }

  void writeRoots(const DocumentText& file) override {
    const TextSpan& list = file.layout.sceneList;
    if (isEmptyList(file.text, list)) return fillScene(file);
    text_.copy(file, list.begin + 1);
    const std::string outer(indentationAt(file, list.begin));
    writeNodeList({file, list.end - 1, outer, deeper(outer)}, file.layout.roots,
                  document_.scope().roots, {});
    text_.copy(file, list.end - 1 - blanksBefore(file, list.end - 1));
    std::vector<Make> routes;
    for (const Route* route : routesToAdd())
      routes.push_back([this, route](std::string_view) { return routeText(*route); });
    append(file, list, routes);
  }

  // Writes the nodes and routes of a Scene that had none.
  void fillScene(const DocumentText& file) {
    const MFNode& roots = document_.scope().roots;
    if (roots.empty()) return;
    const auto nodes = [&](std::string_view indentation) {
      const std::string inner = deeper(indentation);
      std::string out = "[";
      for (const NodeRef& root : roots) out += feed_ + inner + node(root.get(), inner, {});
      for (const Route* route : routesToAdd()) out += feed_ + inner + routeText(*route);
      return out + feed_ + std::string(indentation) + "]";
    };
    const TextSpan& list = file.layout.sceneList;
    if (list.begin == 0)
      return append(file, file.layout.scene,
                    {[&](std::string_view in) { return style_.member("-children", nodes(in)); }});
    text_.copy(file, list.begin);
    addText("", nodes, indentationAt(file, list.begin));
    text_.at = list.end;
  }

  // Adds members to an object, or elements to a list, at their end: in lines of their own if the
  // closing brace or bracket begins one.
  void append(const DocumentText& text, const TextSpan& body, const std::vector<Make>& added) {
    if (added.empty()) return;
    const std::string_view all = text.text;
    const size_t close = body.end - 1;
    text_.copy(text, close - blanksBefore(text, close));
    if (startsLine(all, close)) {
      const std::string inner = innerOf(text, body);
      for (const Make& make : added) addText(feed_ + inner, make, inner);
    } else {
      const std::string inner(indentationAt(text, close));
      for (const Make& make : added)
        addText(text_.out.ends_with('{') || text_.out.ends_with('[') ? "" : " ", make, inner);
    }
  }
  // Nodes that are made use text_.out themselves.
  void addText(std::string_view before, const Make& make, std::string_view indentation) {
    const std::string made = make(indentation);
    text_.out.append(before).append(made);
  }
  // Returns the indentation of what an object or list has in lines of its own.
  std::string innerOf(const DocumentText& text, const TextSpan& body) const {
    size_t first = body.begin + (text.text[body.begin] == '[' ? 1 : 0);
    while (first + 1 < body.end && isSpace(text.text[first])) ++first;
    if (first + 1 < body.end && startsLine(text.text, first))
      return std::string(indentationAt(text, first));
    return deeper(indentationAt(text, body.end - 1));
  }

  // A part of a node, which is written where it stands in the text.
  struct Part {
    size_t begin;
    std::function<void()> write;
  };

  void writeNodeText(const Node& node, const Holder* holder) override {
    const DocumentText& text = document_.textOf(node);
    const NodeText& place = document_.placeOf(node);
    begin(node);
    const JsonStyle style = styleIn(text, place);
    std::vector<Part> parts;
    if (place.name.begin > 0)
      parts.push_back({place.name.begin, [&] {
                         text_.copy(text, place.name.begin);
                         text_.replaceName(text, place.name, node);
                       }});
    else if (!node.defName.empty())
      addName(text, place, node, style);
    if (holder && holder->field && place.container.begin > 0)
      parts.push_back({place.container.begin, [&] {
                         text_.copy(text, place.container.begin);
                         text_.out += spelled(*holder->parent, holder->field->name);
                         text_.at = place.container.end;
                       }});
    const auto given = lastOf(place);
    for (const FieldText& field : place.fields)
      parts.push_back({field.whole.begin, [&, this] {
                         if (given.at(field.name) == &field && field.faithful)
                           writeField(text, node, field);
                         else
                           keepNodes(text, field);
                       }});
    std::vector<Make> members, values; // fields that the text does not have
    for (const FieldInfo& field : node.type().fields) {
      if (!holdsValue(field) || given.contains(field.name) || !editedFrom(node, field)) continue;
      if (nodeCast<ProtoInstance>(&node))
        values.push_back(
            [&, this](std::string_view in) { return fieldValue(node, field, in, style); });
      else
        members.push_back(
            [&, this](std::string_view in) { return addedField(node, field, in, style); });
    }
    if (!values.empty() && place.values.begin > 0) {
      if (text.text[place.values.begin] != '[')
        parts.insert(parts.begin(), {place.values.begin, [&] {
                                       text_.copy(text, place.values.begin);
                                       text_.out += '[';
                                     }});
      parts.push_back({place.values.end - 1, [&] { appendValues(text, place.values, values); }});
    }
    if (!values.empty() && place.values.begin == 0)
      members.push_back([&](std::string_view in) {
        const std::string inner = deeper(in);
        std::string out;
        for (const Make& make : values) out += feed_ + inner + make(inner);
        return style.member("fieldValue", "[" + out + feed_ + std::string(in) + "]");
      });
    std::stable_sort(parts.begin(), parts.end(),
                     [](const Part& a, const Part& b) { return a.begin < b.begin; });
    for (const Part& part : parts) part.write();
    append(text, place.body, members);
    text_.copy(text, place.whole.end);
  }

  // Gives a node a name, before its first member.
  void addName(const DocumentText& text, const NodeText& place, const Node& node,
               const JsonStyle& style) {
    size_t first = place.body.begin;
    while (isSpace(text.text[first])) ++first;
    const bool isEmpty = text.text[first] == '}';
    text_.copy(text, isEmpty ? place.body.begin : first);
    text_.out += style.member("@DEF", jsonString(node.defName));
    if (!isEmpty)
      text_.out +=
          startsLine(text.text, first) ? feed_ + std::string(indentationAt(text, first)) : " ";
  }

  // Adds to the fieldValues of an instance, which may be a single one without brackets.
  void appendValues(const DocumentText& text, const TextSpan& span,
                    const std::vector<Make>& values) {
    if (text.text[span.begin] == '[') return append(text, span, values);
    text_.copy(text, span.end);
    const std::string indentation(indentationAt(text, span.begin));
    for (const Make& make : values) addText(" ", make, indentation);
    text_.out += "]";
  }

  // Returns a list with a line for each node.
  std::string inBrackets(const MFNode& nodes, std::string_view indentation, const Holder& holder) {
    if (nodes.empty()) return "[]";
    const std::string inner = deeper(indentation);
    std::string out = "[";
    for (const NodeRef& one : nodes) out += feed_ + inner + node(one.get(), inner, holder);
    return out + feed_ + std::string(indentation) + "]";
  }

  std::string addedField(const Node& node, const FieldInfo& field, std::string_view indentation,
                         const JsonStyle& style) {
    const std::string name(spelled(node, field.name));
    if (!holdsNodes(field))
      return style.member("@" + name,
                          jsonText(field.type, node.get(field), {indentation.size(), feed_}));
    const MFNode nodes = nodesOf(node, field);
    return style.member("-" + name, field.type == FieldType::SFNode && !nodes.empty()
                                        ? this->node(nodes[0].get(), indentation, {&node, &field})
                                        : inBrackets(nodes, indentation, {&node, &field}));
  }

  std::string fieldValue(const Node& node, const FieldInfo& field, std::string_view indentation,
                         const JsonStyle& style) {
    const std::string value =
        holdsNodes(field)
            ? style.member("-children", inBrackets(nodesOf(node, field), indentation, {}))
            : style.member("@value",
                           jsonText(field.type, node.get(field), {indentation.size(), feed_}));
    return "{" + style.member("@name", jsonString(field.name)) + ", " + value + "}";
  }

  void writeField(const DocumentText& text, const Node& node, const FieldText& place) {
    const FieldInfo& field = *node.type().find(place.name);
    const bool isOwn = place.form == FieldForm::statement; // a member of the node's object
    if (holdsNodes(field) && isOwn && field.type == FieldType::SFNode)
      return writeChild(text, node, field, place);
    if (holdsNodes(field))
      return writeNodes(text, node, field, place, isOwn ? Holder{&node, &field} : Holder());
    const Value* const original = editedFrom(node, field);
    if (!original) return;
    const ValueLines lines = linesAt(text, place.whole.begin);
    if (place.value.begin == 0)
      return append(text, {place.whole.begin + 1, place.whole.end}, {[&](std::string_view) {
                      return JsonStyle(text.text, place.whole.begin)
                          .member("@value", jsonText(field.type, node.get(field), lines));
                    }});
    text_.copy(text, place.value.begin);
    text_.out +=
        changedJson(std::string_view(text.text).substr(place.value.begin, place.value.size()),
                    field.type, *original, node.get(field), lines);
    text_.at = place.value.end;
  }

  void writeChild(const DocumentText& text, const Node& node, const FieldInfo& field,
                  const FieldText& place) {
    const Node* const child = static_cast<const NodeRef*>(node.storage(field))->get();
    const NodePlace* const own = place.nodes.empty() ? nullptr : &place.nodes.back();
    const TextSpan span = own ? own->span : place.value;
    if (own && own->node == child) {
      text_.copy(text, span.begin);
      keep(text, *own, {});
    } else if (child) {
      text_.copy(text, span.begin);
      const std::string made =
          this->node(child, indentationAt(text, place.whole.begin), {&node, &field});
      text_.out += made;
      text_.at = span.end;
    } else if (own) {
      text_.remove(text, place.whole);
    }
  }

  void writeNodes(const DocumentText& text, const Node& node, const FieldInfo& field,
                  const FieldText& place, const Holder& holder) {
    const MFNode nodes = nodesOf(node, field);
    const std::string indentation(indentationAt(text, place.whole.begin));
    if (place.nodes.empty() && nodes.empty()) return;
    if (place.value.begin == 0)
      return append(text, {place.whole.begin + 1, place.whole.end}, {[&](std::string_view in) {
                      return JsonStyle(text.text, place.whole.begin)
                          .member("-children", inBrackets(nodes, in, holder));
                    }});
    text_.copy(text, place.value.begin);
    if (text.text[place.value.begin] == '[') {
      text_.copy(text, place.value.begin + 1);
      writeNodeList({text, place.value.end - 1, indentation, deeper(indentation)}, place.nodes,
                    nodes, holder);
    } else if (nodes.size() == 1 && place.nodes.size() == 1 &&
               nodes[0].get() == place.nodes[0].node) {
      keep(text, place.nodes[0], {});
    } else {
      text_.out += inBrackets(nodes, indentation, holder);
      text_.at = place.value.end;
    }
  }

  const JsonStyle style_;
};

} // namespace

std::unique_ptr<NodeWriter> makeJsonWriter(const Document& document, WritingPlan plan) {
  return std::make_unique<JsonWriter>(document, std::move(plan));
}

} // namespace xvrml
