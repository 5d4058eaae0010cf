#include "parse/text_layout.h"

#include <utility>

#include "base/lexer.h"

namespace xvrml {

// Returns where the keyword before a name begins, also if comments stand between them; the name's
// own place if something else does.
size_t LayoutRecorder::keywordBefore(const Name& name, std::string_view keyword) const {
  const std::string_view text = locator_.text();
  const size_t own = offset(name.at);
  size_t at = own;
  for (;;) {
    const size_t line = at == 0 ? 0 : text.find_last_of("\r\n", at - 1) + 1; // npos + 1 is 0
    while (at > line && isVrmlSpace(text[at - 1])) --at;
    if (const size_t comment = text.substr(line, at - line).rfind('#'); comment != text.npos) {
      size_t before = line + comment;
      while (before > line && isVrmlSpace(text[before - 1])) --before;
      if (before == line || text.substr(line, before - line).ends_with(keyword)) at = before;
    }
    if (at > line || line == 0) break;
    at = line - 1; // nothing but a comment stands in this line
  }
  return at >= keyword.size() && text.substr(at - keyword.size(), keyword.size()) == keyword
             ? at - keyword.size()
             : own;
}

void LayoutRecorder::add(const NodePlace& place) {
  if (nodes_.empty())
    layout_.roots.push_back(place);
  else if (nodes_.back().inField)
    nodes_.back().field.nodes.push_back(place);
}

void LayoutRecorder::placed(const char* begin, const char* end) {
  placed_ = {offset(begin), offset(end)};
}

bool LayoutRecorder::openNode(const Name& type, const Name* def) {
  const bool made = builder_.openNode(type, def);
  if (!made || !isRecording()) return made;
  NodeText text;
  text.whole.begin = offset(type.at);
  if (def) {
    text.whole.begin = keywordBefore(*def, "DEF");
    text.name = spanOf(*def);
  }
  nodes_.push_back({&builder_.innermostNode(), std::move(text), false, {}});
  return made;
}

void LayoutRecorder::closeNode(bool good) {
  if (isRecording()) {
    OpenNode closed = std::move(nodes_.back());
    nodes_.pop_back();
    closed.text.node = NodeRef(const_cast<Node*>(closed.node));
    closed.text.body = placed_;
    closed.text.whole.end = placed_.end;
    add({closed.text.whole, closed.node, false});
    layout_.nodes.emplace(closed.node, std::move(closed.text));
  }
  builder_.closeNode(good);
}

void LayoutRecorder::useNode(const Name& name) {
  if (isRecording())
    add({{keywordBefore(name, "USE"), spanOf(name).end}, builder_.named(name.text), true});
  builder_.useNode(name);
}

void LayoutRecorder::nullNode(const Name& token) {
  if (isRecording()) add({spanOf(token), nullptr, false});
  builder_.nullNode(token);
}

void LayoutRecorder::beginField(std::string name, const char* at) {
  OpenNode& open = nodes_.back();
  open.inField = true;
  open.field = {};
  open.field.name = std::move(name);
  open.field.whole.begin = offset(at);
}

void LayoutRecorder::endField(bool good) {
  OpenNode& open = nodes_.back();
  if (!std::exchange(open.inField, false)) return;
  open.field.value = placed_;
  open.field.whole.end = placed_.end;
  open.field.readable = good;
  open.text.fields.push_back(std::move(open.field));
}

FieldTarget LayoutRecorder::openField(const Name& name) {
  const FieldTarget target = builder_.openField(name);
  if (target.known && isRecording()) beginField(builder_.innermostField().name, name.at);
  return target;
}

void LayoutRecorder::closeField(bool good) {
  if (isRecording()) endField(good);
  builder_.closeField(good);
}

FieldTarget LayoutRecorder::openDeclaration(Access access, FieldType type, const Name& name,
                                            bool hasValue) {
  const FieldTarget target = builder_.openDeclaration(access, type, name, hasValue);
  if (isRecording() && hasValue && target.known) {
    beginField(std::string(name.text), name.at);
    nodes_.back().field.declared = true;
  }
  return target;
}

void LayoutRecorder::closeDeclaration(bool good) {
  if (isRecording()) endField(good);
  builder_.closeDeclaration(good);
}

void LayoutRecorder::beginPrototype(const Name& name, std::string_view keyword) {
  if (prototypes_++ > 0) return;
  const SourcePosition place = locator_.place(name.at);
  layout_.prototypes.push_back({{keywordBefore(name, keyword), 0}, place.line, place.column});
}

// good: the world has the prototype; the text of another one is left as it is.
void LayoutRecorder::endPrototype(bool good) {
  if (--prototypes_ > 0) return;
  if (good)
    layout_.prototypes.back().whole.end = placed_.end;
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

void LayoutRecorder::route(const Name& keyword, const RouteNames& names) {
  if (isRecording()) {
    const SourcePosition place = locator_.place(keyword.at);
    layout_.routes.push_back({{offset(keyword.at), spanOf(names.toField).end},
                              spanOf(names.from),
                              spanOf(names.to),
                              place.line,
                              place.column});
  }
  builder_.route(keyword, names);
}

} // namespace xvrml
