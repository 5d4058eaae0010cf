// node_stream.cpp: nodes and names for a ParseSink.
#include "parse/mesh/node_stream.h"

#include <fmt/format.h>

#include "base/lexer.h"
#include "graph/expander.h"

namespace xvrml {
namespace {

constexpr size_t longestName = 100; // bytes of a DEF name that are taken from the file's name

Name named(std::string_view text) { return {text, nullptr}; }

} // namespace

void NodeStream::open(std::string_view type, std::string_view def) {
  const Name name = named(def);
  const bool known = !skips() && file_.sink.openNode(named(type), def.empty() ? nullptr : &name);
  known_.push_back(known);
  skipped_ += !known;
}

void NodeStream::close() {
  if (known_.back())
    file_.sink.closeNode(true);
  else
    --skipped_;
  known_.pop_back();
}

void NodeStream::openField(std::string_view field) {
  const bool known = !skips() && file_.sink.openField(named(field)).known;
  known_.push_back(known);
  skipped_ += !known;
}

void NodeStream::closeField() {
  if (known_.back())
    file_.sink.closeField(true);
  else
    --skipped_;
  known_.pop_back();
}

void NodeStream::openIn(std::string_view field, std::string_view type, std::string_view def) {
  openField(field);
  open(type, def);
}

void NodeStream::closeIn() {
  close();
  closeField();
}

void NodeStream::use(std::string_view def) {
  if (!skips()) file_.sink.useNode(named(def));
}

void NodeStream::useIn(std::string_view field, std::string_view def) {
  openField(field);
  use(def);
  closeField();
}

void NodeStream::route(std::string_view from, std::string_view fromField, std::string_view to,
                       std::string_view toField) {
  if (!skips())
    file_.sink.route(named("ROUTE"), {named(from), named(fromField), named(to), named(toField)});
}

template <class T> void NodeStream::set(std::string_view field, T value) {
  if (skips()) return;
  constexpr FieldType type = FieldType(Value(std::in_place_type<T>).index());
  const FieldTarget target = file_.sink.openField(named(field));
  if (!target.known) return;
  bool good = target.type == type;
  if (!good) {
    file_.locator.error(nullptr, fmt::format("field {} is {} here: expected {}", field,
                                             fieldTypeName(target.type), fieldTypeName(type)));
  } else if (!file_.budget->take(valueBytes(type, &value))) {
    good = false;
    if (!std::exchange(full_, true))
      file_.locator.error(nullptr, fmt::format("the world takes more memory than {}; arrays beyond "
                                               "are left out",
                                               file_.budget->name()));
  } else {
    *static_cast<T*>(target.storage) = std::move(value);
  }
  file_.sink.closeField(good);
}

#define XVRML_SET(name, type) template void NodeStream::set<type>(std::string_view, type);
XVRML_SET(SFBool, bool)
XVRML_SET(SFColor, Color)
XVRML_SET(SFFloat, float)
XVRML_SET(SFInt32, int32_t)
XVRML_SET(SFRotation, Rotation)
XVRML_SET(SFString, std::string)
XVRML_SET(SFTime, double)
XVRML_SET(SFVec2f, Vec2f)
XVRML_SET(SFVec3f, Vec3f)
XVRML_SET(MFColor, std::vector<Color>)
XVRML_SET(MFColorRGBA, std::vector<ColorRGBA>)
XVRML_SET(MFFloat, std::vector<float>)
XVRML_SET(MFInt32, std::vector<int32_t>)
XVRML_SET(MFRotation, std::vector<Rotation>)
XVRML_SET(MFString, std::vector<std::string>)
XVRML_SET(MFVec2f, std::vector<Vec2f>)
XVRML_SET(MFVec3f, std::vector<Vec3f>)
#undef XVRML_SET

std::string_view NodeStream::define(std::string_view name, std::string_view otherwise) {
  if (name.empty()) name = otherwise;
  std::string text;
  for (const char c : name.substr(0, longestName))
    text += isIdentifierRest(static_cast<unsigned char>(c)) && c != '.' ? c : '_';
  // Characters of several bytes are not cut apart.
  while (text.size() == longestName && (static_cast<unsigned char>(text.back()) & 0x80))
    text.pop_back();
  if (text.empty() || !isIdentifier(text)) text.insert(0, "_");
  uint64_t& number = used_[text];
  std::string unique = text;
  while (number++ > 0 && used_.contains(unique = fmt::format("{}_{}", text, number))) {}
  if (unique != text) used_.emplace(unique, 1);
  return file_.names.emplace_back(std::move(unique));
}

bool NodeStream::knows(std::string_view type, std::string_view field) const {
  const NodeType* known = file_.sink.typeNamed(type);
  return known && known->find(field);
}

} // namespace xvrml
