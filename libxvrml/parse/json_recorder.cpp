#include "parse/json_recorder.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "base/x3d.h"
#include "graph/field_access.h"
#include "lower_case.h"

namespace xvrml {

void JsonRecorder::enter(const Element& element) {
  open_.push_back(element);
  const Value& object = at(element.object);
  if (open_.size() > 2 || lowerCase(object.key) != "scene") return;
  layout_.scene = bodyOf(object);
  layout_.sceneList = {};
  index_.eachWithin(element.object, [&](size_t i) {
    if (at(i).key != "-children") return;
    if (at(i).kind == Value::Kind::array)
      layout_.sceneList = spanOf(at(i));
    else
      refuse("has a Scene whose \"-children\" are no list");
  });
}

void JsonRecorder::refuse(std::string_view reason) const {
  if (layout_.whyNot.empty()) layout_.whyNot = reason;
}

// Returns where the object stands that holds the innermost element and no other.
TextSpan JsonRecorder::spanOfHolder() const {
  if (!layout_.whyNot.empty()) return {};
  const size_t holder = element().holder;
  size_t elements = 0;
  if (holder != none)
    for (size_t i = holder + 1; i < at(holder).next && elements < 2; i = at(i).next)
      if (!at(i).key.starts_with('#')) ++elements;
  if (elements == 1) return spanOf(at(holder));
  refuse("has nodes, routes or prototypes that have no object of their own in a list");
  return {};
}

// Returns where the name stands, without its quotes, in a value.
TextSpan JsonRecorder::nameAt(const char* value) const {
  const Value& found = index_.from(value);
  if (found.kind != Value::Kind::string) refuse("has names that are no strings");
  const TextSpan span = spanOf(found);
  return {span.begin + 1, span.end - 1};
}

NodeText JsonRecorder::begunNode(const Name&, const Name* def) {
  NodeText text;
  text.whole = spanOfHolder();
  text.body = bodyOf(at(element().object));
  if (def) text.name = nameAt(def->at);
  return text;
}

// Adds the lists that no node of the world stands in, and notes what else the object has.
void JsonRecorder::endNode(NodeText& node) {
  addEmptyLists(node);
  index_.eachWithin(element().object, [&](size_t i) {
    const Value& member = at(i);
    if (member.key == "@containerField" && member.kind == Value::Kind::string)
      node.container = {spanOf(member).begin + 1, spanOf(member).end - 1};
    if (member.key == "fieldValue") node.values = spanOf(member);
  });
}

void JsonRecorder::addEmptyLists(NodeText& node) {
  const auto before = [](const FieldText& a, const FieldText& b) {
    return a.whole.begin < b.whole.begin;
  };
  std::vector<FieldText>& fields = node.fields;
  std::stable_sort(fields.begin(), fields.end(), before);
  const NodeType& type = node.node->type();
  std::vector<FieldText> empty;
  index_.eachWithin(element().object, [&](size_t i) {
    const Value& member = at(i);
    if (!member.key.starts_with('-')) return;
    const std::string_view name = member.key.substr(1);
    const FieldInfo* const info = type.find(type.index >= 0 ? ownName(type.name, name) : name);
    if (!info || !holdsNodes(*info)) return;
    FieldText field;
    field.name = info->name;
    field.whole = memberSpan(member);
    field.value = spanOf(member);
    field.readable = true;
    if (!std::binary_search(fields.begin(), fields.end(), field, before))
      empty.push_back(std::move(field));
  });
  std::move(empty.begin(), empty.end(), std::back_inserter(fields));
  std::stable_sort(fields.begin(), fields.end(), before);
  const auto same =
      std::adjacent_find(fields.begin(), fields.end(), [](const FieldText& a, const FieldText& b) {
        return a.form == FieldForm::statement && b.form == FieldForm::statement &&
               a.whole.begin == b.whole.begin;
      });
  if (same != fields.end()) refuse("has lists with nodes of several fields");
}

void JsonRecorder::useNode(const Name& name) {
  // A reference to no node is left as it is.
  if (const Node* const node = builder_.named(name.text); node && isRecording()) {
    nameAt(name.at);
    add({spanOfHolder(), node, true});
  }
  builder_.useNode(name);
}

// Returns whether the reader is in the object of the innermost node itself.
bool JsonRecorder::isOwnMember() {
  return bodyOf(at(element().object)).begin == innermost().text.body.begin;
}

// Returns the field that the innermost element gives: a field or fieldValue.
FieldText JsonRecorder::begunElement(std::string name) const {
  FieldText field;
  field.name = std::move(name);
  field.form = FieldForm::element;
  field.whole = spanOf(at(element().object));
  index_.eachWithin(element().object, [&](size_t i) {
    if (at(i).key == "@value" || at(i).key.starts_with('-')) field.value = spanOf(at(i));
  });
  return field;
}

FieldTarget JsonRecorder::openField(const Name& name) {
  const FieldTarget target = builder_.openField(name);
  if (!target.known || !isRecording()) return target;
  const FieldInfo& info = builder_.innermostField();
  if (!isOwnMember()) {
    beginField(begunElement(info.name));
  } else if (!holdsNodes(info)) { // an attribute of nodes has no value
    const Value& member = index_.from(name.at);
    FieldText field;
    field.name = info.name;
    field.whole = memberSpan(member);
    field.value = spanOf(member);
    beginField(std::move(field));
  }
  return target;
}

FieldTarget JsonRecorder::resumeField(const Name& name) {
  const FieldTarget target = builder_.resumeField(name);
  if (!target.known || !isRecording()) return target;
  const FieldInfo& info = builder_.innermostField();
  const bool isChild = !isOwnMember();
  if (holdsNodes(info) != isChild) return target; // the reader refuses the child
  FieldText field;
  field.name = info.name;
  if (isChild && element().list != none) {
    field.whole = memberSpan(at(element().list));
    field.value = spanOf(at(element().list));
  } else {
    field.form = FieldForm::program;
    forgetFields([&](const FieldText& one) { return one.name == info.name; });
  }
  beginField(std::move(field));
  return target;
}

void JsonRecorder::route(const Name& keyword, const RouteNames& names) {
  if (isRecording())
    addRoute(keyword, {spanOfHolder(), nameAt(names.from.at), nameAt(names.to.at)});
  builder_.route(keyword, names);
}

void JsonRecorder::finish(bool isFragment) {
  if (!index_.isWhole()) refuse("is not well-formed JSON: mend it first");
  // Some members of an object are read before others that stand above them.
  const auto inOrder = [](const auto& a, const auto& b) { return a.whole.begin < b.whole.begin; };
  std::sort(layout_.routes.begin(), layout_.routes.end(), inOrder);
  std::sort(layout_.prototypes.begin(), layout_.prototypes.end(), inOrder);
  if (isFragment) return;
  if (layout_.scene.begin == 0) refuse("has no Scene");
  for (const NodePlace& root : layout_.roots)
    if (root.span.begin < layout_.sceneList.begin || root.span.end > layout_.sceneList.end)
      refuse("has nodes outside of the \"-children\" of its Scene");
}

} // namespace xvrml
