// classic_writer.cpp: the nodes of VRML97 and X3D ClassicVRML.
#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "edit/changed_value.h"
#include "edit/lines.h"
#include "edit/node_writer.h"
#include "graph/field_access.h"

namespace xvrml {
namespace {

class ClassicWriter : public NodeWriter {
 public:
  using NodeWriter::NodeWriter;

 private:
  void writeRoots(const DocumentText& file) override {
    writeNodeList({file, file.text.size(), "", ""}, file.layout.roots, document_.scope().roots, {});
    text_.copy(file, file.text.size());
    for (const Route* route : routesToAdd()) {
      if (!text_.out.empty() && text_.out.back() != '\n' && text_.out.back() != '\r')
        text_.out += feed_;
      text_.out += routeText(*route) + feed_;
    }
  }

  std::string routeText(const Route& route) const {
    return fmt::format("ROUTE {}.{} TO {}.{}", route.from->defName,
                       spelled(*route.from, route.fromField), route.to->defName,
                       spelled(*route.to, route.toField));
  }

  std::string useOf(const Node& node, const Holder&) const override {
    return "USE " + node.defName;
  }

  void keepUse(const DocumentText& text, const NodePlace& place) override {
    if (document_.nameInText(*place.node) == place.node->defName)
      return text_.copy(text, place.span.end);
    text_.copy(text, place.span.begin);
    text_.out += useOf(*place.node, {});
  }

  CommentedNode commented(std::string_view text, const TextSpan& node) const override {
    return commentedNode(text, node);
  }
  bool endsLine(std::string_view text, size_t at) const override {
    return xvrml::endsLine(text, at);
  }
  std::string indented(std::string_view text, std::string_view from,
                       std::string_view to) const override {
    return xvrml::indented(text, from, to);
  }

  void writeNodeText(const Node& node, const Holder*) override {
    const DocumentText& text = document_.textOf(node);
    const NodeText& place = document_.placeOf(node);
    begin(node);
    if (place.name.size() > 0) {
      text_.copy(text, place.name.begin);
      text_.replaceName(text, place.name, node);
    } else if (!node.defName.empty()) {
      text_.copy(text, place.whole.begin);
      text_.out += fmt::format("DEF {} ", node.defName);
    }
    const auto given = lastOf(place);
    for (const FieldText& field : place.fields)
      if (given.at(field.name) == &field && field.faithful)
        writeField(text, node, field);
      else
        keepNodes(text, field);
    std::vector<const FieldInfo*> absent;
    for (const FieldInfo& field : node.type().fields)
      if (holdsValue(field) && !given.contains(field.name)) absent.push_back(&field);
    addFields(text, node, place, absent);
    text_.copy(text, place.whole.end);
  }

  // Adds fields that the text does not have, before the closing brace: in lines of their own if
  // the brace stands in one.
  void addFields(const DocumentText& text, const Node& node, const NodeText& place,
                 const std::vector<const FieldInfo*>& fields) {
    const std::string_view all = text.text;
    const size_t brace = place.body.end - 1;
    const bool inLines = startsLine(all, brace);
    std::string indentation(indentationAt(text, brace));
    if (inLines) {
      const auto first =
          std::find_if(place.fields.begin(), place.fields.end(),
                       [&](const FieldText& field) { return startsLine(all, field.whole.begin); });
      indentation = first == place.fields.end()
                        ? deeper(indentation)
                        : std::string(indentationAt(text, first->whole.begin));
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
    if (!editedFrom(node, field)) return "";
    if (field.type == FieldType::SFNode)
      return this->node(static_cast<const NodeRef*>(node.storage(field))->get(), indentation, {});
    if (field.type == FieldType::MFNode)
      return inBrackets(*static_cast<const MFNode*>(node.storage(field)), indentation);
    return valueText(field.type, node.get(field), {indentation.size(), feed_});
  }

  // Returns a list with a line for each node.
  std::string inBrackets(const MFNode& children, const std::string& indentation) {
    const std::string inner = deeper(indentation);
    std::string out = "[";
    for (const NodeRef& child : children)
      out += feed_ + inner + nodeInLines(child.get(), inner, {});
    return out + feed_ + indentation + "]";
  }

  void writeField(const DocumentText& text, const Node& node, const FieldText& place) {
    const FieldInfo& field = *node.type().find(place.name);
    if (field.type == FieldType::SFNode) return writeChild(text, node, field, place);
    if (field.type == FieldType::MFNode) return writeChildren(text, node, field, place);
    const Value* const original = editedFrom(node, field);
    if (!original) return;
    text_.copy(text, place.value.begin);
    text_.out +=
        changedValue(std::string_view(text.text).substr(place.value.begin, place.value.size()),
                     field.type, *original, node.get(field), linesAt(text, place.whole.begin));
    text_.at = place.value.end;
  }

  void writeChild(const DocumentText& text, const Node& node, const FieldInfo& field,
                  const FieldText& place) {
    const Node* const child = static_cast<const NodeRef*>(node.storage(field))->get();
    const NodePlace* const own = place.nodes.empty() ? nullptr : &place.nodes.back();
    if (own && own->node == child) {
      text_.copy(text, own->span.begin);
      keep(text, *own, {});
    } else if (child) {
      text_.copy(text, place.value.begin);
      text_.out += this->node(child, indentationAt(text, place.whole.begin), {});
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
    const std::string indentation(indentationAt(text, place.whole.begin));
    if (place.nodes.empty() && children.empty()) return;
    text_.copy(text, place.value.begin);
    if (text.text[place.value.begin] == '[') {
      text_.copy(text, place.value.begin + 1);
      writeNodeList({text, place.value.end - 1, indentation, deeper(indentation)}, place.nodes,
                    children, {});
    } else if (children.size() == 1 && place.nodes.size() == 1 &&
               children[0].get() == place.nodes[0].node) {
      keep(text, place.nodes[0], {});
    } else {
      text_.out += children.empty() ? "[ ]" : inBrackets(children, indentation);
      text_.at = place.value.end;
    }
  }
};

} // namespace

std::unique_ptr<NodeWriter> makeClassicWriter(const Document& document, WritingPlan plan) {
  return std::make_unique<ClassicWriter>(document, std::move(plan));
}

} // namespace xvrml
