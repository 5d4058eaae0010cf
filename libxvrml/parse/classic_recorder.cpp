#include "parse/classic_recorder.h"

#include "base/lexer.h"

namespace xvrml {

// Returns where the keyword before a name begins, also if comments stand between them; the name's
// own place if something else does.
size_t ClassicRecorder::keywordBefore(const Name& name, std::string_view keyword) const {
  const std::string_view text = locator_.text();
  const size_t own = offset(name.at);
  const auto endsLine = [](char c) { return c == '\n' || c == '\r'; };
  size_t at = own;
  for (;;) {
    while (at > 0 && isVrmlSpace(text[at - 1]) && !endsLine(text[at - 1])) --at;
    if (at > 0 && !endsLine(text[at - 1])) {
      // The name's own line has no comment before it, and may be as long as the file.
      if (text.substr(at, own - at).find_first_of("\r\n") == text.npos) break;
      const size_t line = text.find_last_of("\r\n", at - 1) + 1; // npos + 1 is 0
      if (const size_t comment = text.substr(line, at - line).rfind('#'); comment != text.npos) {
        size_t before = line + comment;
        while (before > line && isVrmlSpace(text[before - 1])) --before;
        if (before == line || text.substr(line, before - line).ends_with(keyword)) at = before;
      }
      if (at > line) break;
    }
    if (at == 0) break;
    --at; // nothing but a comment stands in this line
  }
  return at >= keyword.size() && text.substr(at - keyword.size(), keyword.size()) == keyword
             ? at - keyword.size()
             : own;
}

void ClassicRecorder::placed(const char* begin, const char* end) {
  placed_ = {offset(begin), offset(end)};
}

NodeText ClassicRecorder::begunNode(const Name& type, const Name* def) {
  NodeText text;
  text.whole.begin = offset(type.at);
  if (def) {
    text.whole.begin = keywordBefore(*def, "DEF");
    text.name = spanOf(*def);
  }
  return text;
}

void ClassicRecorder::endNode(NodeText& node) {
  node.body = placed_;
  node.whole.end = placed_.end;
}

void ClassicRecorder::useNode(const Name& name) {
  if (isRecording())
    add({{keywordBefore(name, "USE"), spanOf(name).end}, builder_.named(name.text), true});
  builder_.useNode(name);
}

void ClassicRecorder::nullNode(const Name& token) {
  if (isRecording()) add({spanOf(token), nullptr, false});
  builder_.nullNode(token);
}

FieldText ClassicRecorder::begunField(std::string name, const char* at) const {
  FieldText field;
  field.name = std::move(name);
  field.whole.begin = offset(at);
  return field;
}

void ClassicRecorder::endField(FieldText& field, bool good) {
  field.value = placed_;
  field.whole.end = placed_.end;
  field.readable = good;
}

FieldTarget ClassicRecorder::openField(const Name& name) {
  const FieldTarget target = builder_.openField(name);
  if (target.known && isRecording())
    beginField(begunField(builder_.innermostField().name, name.at));
  return target;
}

void ClassicRecorder::route(const Name& keyword, const RouteNames& names) {
  if (isRecording())
    addRoute(
        keyword,
        {{offset(keyword.at), spanOf(names.toField).end}, spanOf(names.from), spanOf(names.to)});
  builder_.route(keyword, names);
}

} // namespace xvrml
