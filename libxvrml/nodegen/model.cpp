// model.cpp: names the kinds of access and change, and implements look-ups and messages of a Model.
#include "nodegen/model.h"

#include <array>

#include <fmt/format.h>

namespace xvrml::nodegen {
namespace {

constexpr std::array<std::string_view, 9> changeNames = {
    "none", "transform", "geometry", "appearance", "shader", "children", "light", "view", "time"};

template <class Names, class Enum>
bool fromName(const Names& names, std::string_view name, Enum& out) {
  for (size_t i = 0; i < names.size(); ++i) {
    if (names[i] != name) continue;
    out = Enum(i);
    return true;
  }
  return false;
}

std::string_view lineOf(std::string_view text, uint32_t line) {
  for (; line > 1; --line) {
    const size_t end = text.find('\n');
    if (end == std::string_view::npos) return {};
    text.remove_prefix(end + 1);
  }
  return text.substr(0, text.find_first_of("\r\n"));
}

} // namespace

std::string_view changeName(Change change) { return changeNames[size_t(change)]; }
std::string clauseText(const TypeSpec& type) {
  if (type.clause.empty()) return {};
  return fmt::format("{} clause {}", standardName(type.ofX3d ? Standard::x3d : Standard::vrml97),
                     type.clause);
}
bool accessFromName(std::string_view name, Access& access) {
  for (const Access each :
       {Access::field, Access::exposedField, Access::eventIn, Access::eventOut}) {
    if (name != accessName(each)) continue;
    access = each;
    return true;
  }
  return false;
}
bool changeFromName(std::string_view name, Change& change) {
  return fromName(changeNames, name, change);
}

void Model::error(const SourcePosition& source, std::string message) {
  Diagnostic diagnostic{Severity::error,    source.file ? *source.file : std::string(),
                        source.line,        source.column,
                        std::move(message), {}};
  if (const auto text = texts.find(diagnostic.file); text != texts.end())
    diagnostic.sourceLine = lineOf(text->second, source.line);
  diagnostics.add(std::move(diagnostic));
}

const TypeSpec* Model::find(std::string_view name) const {
  for (const Component& component : components)
    for (const TypeSpec& type : component.types)
      if (type.name == name) return &type;
  return nullptr;
}

} // namespace xvrml::nodegen
