#include "parse/xml_recorder.h"

#include <utility>

#include "graph/field_access.h"

namespace xvrml {

// Returns where the value of an attribute of the innermost element stands; empty if it has none.
TextSpan XmlRecorder::valueOf(std::string_view attribute) const {
  const XmlAttribute* const found = layout_.xml.find(element(), attribute);
  return found ? layout_.xml.trimmedValue(*found) : TextSpan();
}

NodeText XmlRecorder::begunNode(const Name&, const Name* def) {
  NodeText text;
  text.whole.begin = element().begin;
  if (def) text.name = valueOf("DEF");
  return text;
}

void XmlRecorder::useNode(const Name& name) {
  // A reference to no node is left as it is.
  if (const Node* const node = builder_.named(name.text); node && isRecording())
    add({{element().begin, 0}, node, true});
  builder_.useNode(name);
}

// Returns the field that the innermost element gives: a field or fieldValue.
FieldText XmlRecorder::begunElement(std::string name) const {
  FieldText field;
  field.name = std::move(name);
  field.form = FieldForm::element;
  field.whole.begin = element().begin;
  if (const XmlAttribute* const value = layout_.xml.find(element(), "value"))
    field.value = value->value;
  return field;
}

FieldTarget XmlRecorder::openField(const Name& name) {
  const FieldTarget target = builder_.openField(name);
  if (!target.known || !isRecording()) return target;
  const FieldInfo& info = builder_.innermostField();
  const std::string& known = info.name;
  if (element().begin != innermost().text.whole.begin) {
    beginField(begunElement(known));
  } else if (!holdsNodes(info)) { // an attribute of nodes has no value
    const XmlAttribute* const attribute =
        layout_.xml.attributeAt(element(), layout_.xml.offset(name.at));
    if (!attribute) return target; // the document type gives it
    // The last one of a name counts.
    forgetFields([&](const FieldText& one) {
      return one.form == FieldForm::attribute && one.name == known;
    });
    FieldText field;
    field.name = known;
    field.form = FieldForm::attribute;
    field.whole = attribute->whole();
    field.value = attribute->value;
    beginField(std::move(field));
  }
  return target;
}

FieldTarget XmlRecorder::resumeField(const Name& name) {
  const FieldTarget target = builder_.resumeField(name);
  if (!target.known || !isRecording()) return target;
  const FieldInfo& info = builder_.innermostField();
  const bool isChild = element().begin != innermost().text.whole.begin;
  if (holdsNodes(info) != isChild) return target; // the reader refuses the child
  FieldText field;
  field.name = info.name;
  field.form = isChild ? FieldForm::children : FieldForm::program;
  beginField(std::move(field));
  return target;
}

void XmlRecorder::route(const Name& keyword, const RouteNames& names) {
  if (isRecording())
    addRoute(keyword, {{element().begin, 0}, valueOf("fromNode"), valueOf("toNode")});
  builder_.route(keyword, names);
}

void XmlRecorder::finish() {
  const auto completeAll = [this](auto& places) {
    for (NodePlace& place : places) complete(place.span);
  };
  completeAll(layout_.roots);
  for (NodeText& text : layout_.nodes) {
    complete(text.whole);
    for (FieldText& field : text.fields) {
      completeAll(field.nodes);
      if (field.form == FieldForm::element) complete(field.whole);
    }
  }
  for (RouteText& route : layout_.routes) complete(route.whole);
  for (PrototypeText& prototype : layout_.prototypes) complete(prototype.whole);
}

} // namespace xvrml
