// x3d_element_nodes.cpp: nodes, the fields that their attributes give, and the fields that their
// child nodes stand in (containerField, ISO/IEC 19776-1 5.2).
#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "parse/x3d_elements.h"

namespace xvrml {
namespace {

// Returns whether an attribute of a node is none of its fields: the names and places of nodes, what
// HTML and style sheets use, and names with a prefix.
bool isNoField(std::string_view name) {
  constexpr std::string_view others[] = {"DEF", "USE", "containerField", "class", "id", "style"};
  return std::find(std::begin(others), std::end(others), name) != std::end(others) ||
         name.find(':') != name.npos || name == "xmlns";
}

bool equalsWithoutCase(std::string_view a, std::string_view b) {
  const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c; };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [&](char x, char y) { return lower(x) == lower(y); });
}

} // namespace

// Returns whether an SFNode field of an interface or instance has its node already. Reports it.
bool X3dElements::isSecondNode(const Name& element) {
  Frame& frame = top();
  if ((frame.kind != Kind::declaration && frame.kind != Kind::value) || frame.isList) return false;
  if (!std::exchange(frame.filled, true)) return false;
  locator_.error(element.at,
                 fmt::format("an SFNode holds one node: {} is left out", describe(element)));
  return true;
}

void X3dElements::openNode(const Name& element, Attributes attributes) {
  if (isSecondNode(element)) return skip(attributes);
  Name type = element;
  const bool instance = element.text == "ProtoInstance";
  const Attribute* const use = findAttribute(attributes, "USE");
  if (instance && !use && !nameOf(type, element, attributes, "name")) return skip(attributes);
  type.at = element.at;
  const Attribute* const container = findAttribute(attributes, "containerField");
  if (use) {
    const Name name{keep(trimmed(use->value)), use->at};
    if (checkName(name) && enterField(name, container, true)) sink_.useNode(name);
    return push(Kind::leaf, element);
  }
  Name def;
  const Attribute* const named = findAttribute(attributes, "DEF");
  if (named) def = {keep(trimmed(named->value)), named->at};
  const bool hasName = named && checkName(def);
  if (tooDeep(type, "nodes") || !enterField(type, container, false) ||
      !sink_.openNode(type, hasName ? &def : nullptr))
    return skip(attributes);
  ++depth_;
  push(Kind::node, type);
  top().hasProgram = sink_.declaresFields() && sink_.hasField("url"); // a Script
  for (const Attribute& attribute : attributes) {
    const std::string_view name = attribute.name.text;
    const bool field = !isNoField(name) || (name == "style" && sink_.hasField(name)); // FontStyle
    if (field && !(instance && name == "name")) readField(type, attribute);
  }
}

// Opens the field of the open node, if there is one, that takes a node. Returns false if there is
// no such field.
bool X3dElements::enterField(const Name& name, const Attribute* container, bool use) {
  Frame& frame = top();
  if (frame.kind != Kind::node) return true;
  const std::string_view usual = sink_.fieldFor(name.text, use);
  if (usual.empty()) return true; // useNode() or openNode() reports it
  const std::string_view given = container ? trimmed(container->value) : usual;
  const bool wrong = !sink_.hasField(given) && sink_.hasField(usual);
  const std::string_view field = wrong ? usual : given;
  if (wrong)
    locator_.warn(container->at,
                  fmt::format("{} has no field {}; {} is put into {}", frame.element.text,
                              describe(Name{given, nullptr}), describe(name), field));
  if (field == frame.nodesField && frame.isList) return true;
  leaveField();
  const Name opened{keep(field), wrong || !container ? name.at : container->at};
  const FieldTarget target = sink_.resumeField(opened);
  if (!target.known) return false;
  if (target.type != FieldType::SFNode && target.type != FieldType::MFNode) {
    locator_.error(opened.at, fmt::format("{} of {} holds no nodes: {} is left out",
                                          describe(opened), frame.element.text, describe(name)));
    sink_.closeField(false);
    return false;
  }
  frame.nodesField = opened.text;
  frame.isList = target.type == FieldType::MFNode;
  return true;
}

// Closes the field that child nodes of the open node were put into.
void X3dElements::leaveField() {
  Frame& frame = top();
  if (frame.kind != Kind::node || frame.nodesField.empty()) return;
  sink_.closeField(true);
  frame.nodesField = {};
}

// Reads an attribute that gives a field. Names in another case are HTML's.
void X3dElements::readField(const Name& type, const Attribute& attribute) {
  Name name{keep(attribute.name.text), attribute.name.at};
  locator_.setAnchor(name.at);
  if (!sink_.hasField(name.text)) {
    // A page's handlers of events, like onclick, are nothing to the world.
    if (name.text.starts_with("on") && name.text.size() > 3) return;
    if (const NodeType* known = sink_.typeNamed(type.text))
      for (const FieldInfo& field : known->fields)
        if (equalsWithoutCase(field.name, name.text)) name.text = field.name;
  }
  const FieldTarget target = sink_.openField(name);
  if (!target.known) return;
  if (target.type != FieldType::SFNode && target.type != FieldType::MFNode)
    return sink_.closeField(values_.read(target, attribute));
  if (const auto text = trimmed(attribute.value); !text.empty() && text != "NULL")
    locator_.error(attribute.at, fmt::format("the nodes of {} stand between the tags of {}, not in "
                                             "an attribute",
                                             describe(name), type.text));
  sink_.closeField(true);
}

// The text between the tags of a Script is one more program after those of its url (ISO/IEC 19776-1
// 4.3.13).
void X3dElements::appendSource(Frame& frame) {
  if (frame.source.empty() || !frame.good) return;
  locator_.setAnchor(frame.sourceAt);
  const FieldTarget target = sink_.resumeField({"url", frame.sourceAt});
  if (!target.known) return;
  frame.source.resize(trimmed(frame.source).size()); // its beginning has no blanks
  static_cast<MFString*>(target.storage)->push_back(std::move(frame.source));
  if (target.stringLines) target.stringLines->push_back(locator_.place(frame.sourceAt).line);
  sink_.closeField(true);
}

void X3dElements::closeNode(Frame& frame) {
  leaveField();
  if (frame.hasProgram) appendSource(frame);
  // Declarations of a node may follow its connections.
  for (const Connection& one : frame.connections) sink_.connect(one.field, one.interfaceName);
  --depth_;
  sink_.closeNode(true);
}

} // namespace xvrml
