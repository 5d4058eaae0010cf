#include "parse/layout_recorder.h"

#include <iterator>

namespace xvrml {

void LayoutRecorder::add(const NodePlace& place) {
  if (nodes_.empty())
    layout_.roots.push_back(place);
  else if (nodes_.back().inField)
    nodes_.back().field.nodes.push_back(place);
}

bool LayoutRecorder::openNode(const Name& type, const Name* def) {
  const bool made = builder_.openNode(type, def);
  if (made && isRecording())
    nodes_.push_back({&builder_.innermostNode(), begunNode(type, def), fields_.size(), false, {}});
  return made;
}

void LayoutRecorder::closeNode(bool good) {
  if (isRecording()) {
    OpenNode closed = std::move(nodes_.back());
    nodes_.pop_back();
    const auto first = fields_.begin() + std::ptrdiff_t(closed.firstField);
    closed.text.fields.assign(std::make_move_iterator(first),
                              std::make_move_iterator(fields_.end()));
    fields_.erase(first, fields_.end());
    closed.text.node = NodeRef(const_cast<Node*>(closed.node));
    endNode(closed.text);
    add({closed.text.whole, closed.node, false});
    layout_.nodes.push_back(std::move(closed.text));
  }
  builder_.closeNode(good);
}

void LayoutRecorder::beginField(FieldText field) {
  nodes_.back().inField = true;
  nodes_.back().field = std::move(field);
}

// A field of child elements, or of the nodes of one list of JSON, that is opened again goes on.
void LayoutRecorder::finishField(bool good) {
  OpenNode& open = nodes_.back();
  if (!std::exchange(open.inField, false)) return;
  endField(open.field, good);
  const auto goesOn = [&](const FieldText& one) {
    return one.form == open.field.form && one.name == open.field.name &&
           one.whole.begin == open.field.whole.begin;
  };
  const auto begin = fields_.begin() + std::ptrdiff_t(open.firstField);
  auto same = fields_.end();
  if (open.field.form == FieldForm::children)
    same = std::find_if(begin, fields_.end(), goesOn);
  else if (begin != fields_.end() && goesOn(fields_.back()))
    --same;
  if (same != fields_.end())
    same->nodes.insert(same->nodes.end(), open.field.nodes.begin(), open.field.nodes.end());
  else
    fields_.push_back(std::move(open.field));
}

void LayoutRecorder::closeField(bool good) {
  if (isRecording()) finishField(good);
  builder_.closeField(good);
}

FieldTarget LayoutRecorder::openDeclaration(Access access, FieldType type, const Name& name,
                                            bool hasValue) {
  const FieldTarget target = builder_.openDeclaration(access, type, name, hasValue);
  if (isRecording() && hasValue && target.known) {
    FieldText field = begunDeclaration(name);
    field.declared = true;
    beginField(std::move(field));
  }
  return target;
}

void LayoutRecorder::closeDeclaration(bool good) {
  if (isRecording()) finishField(good);
  builder_.closeDeclaration(good);
}

void LayoutRecorder::beginPrototype(const Name& name, std::string_view keyword) {
  if (prototypes_++ > 0) return;
  const SourcePosition place = locator_.place(name.at);
  layout_.prototypes.push_back({{prototypeBegin(name, keyword), 0}, place.line, place.column});
}

// good: the world has the prototype; the text of another one is left as it is.
void LayoutRecorder::endPrototype(bool good) {
  if (--prototypes_ > 0) return;
  if (good)
    layout_.prototypes.back().whole.end = prototypeEnd();
  else
    layout_.prototypes.pop_back();
}

void LayoutRecorder::openProto(const Name& name) {
  beginPrototype(name, "PROTO");
  builder_.openProto(name);
}

void LayoutRecorder::closeProto(bool good) {
  endPrototype(good);
  builder_.closeProto(good);
}

void LayoutRecorder::openExternProto(const Name& name) {
  beginPrototype(name, "EXTERNPROTO");
  builder_.openExternProto(name);
}

void LayoutRecorder::closeExternProto(bool good) {
  endPrototype(good);
  builder_.closeExternProto(good);
}

void LayoutRecorder::addRoute(const Name& keyword, RouteText route) {
  const SourcePosition place = locator_.place(keyword.at);
  route.line = place.line;
  route.column = place.column;
  layout_.routes.push_back(route);
}

void LayoutRecorder::endField(FieldText& field, bool good) {
  const bool hasValue = field.value.begin > 0 || field.declared;
  field.readable =
      good && field.form != FieldForm::program && (field.form != FieldForm::element || hasValue);
}

} // namespace xvrml
