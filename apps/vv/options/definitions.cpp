#include "definitions.h"

#include <fmt/format.h>

#include "nearest.h"
#include "values.h"
#include "xvrml/value_text.h"
#include "xvrml/versions.h"

namespace vv {

namespace {

using namespace xvrml;

[[noreturn]] void fail(const std::string& text, const std::string& why) {
  throw Failure{exitUsage, fmt::format("-D {}: {}", text, why)};
}

std::string didYouMean(const std::string& word, const std::vector<std::string>& known) {
  const std::string near = nearest::word(word, known);
  return near.empty() ? "" : fmt::format("; did you mean {}?", near);
}

NodeRef findNode(const std::string& text, const std::string& name, const World& world) {
  const auto found = world.scope.names.find(name);
  if (found != world.scope.names.end()) return found->second;
  std::vector<std::string> known;
  for (const auto& [one, node] : world.scope.names) known.push_back(one);
  fail(text, known.empty() ? "no node of the world has a DEF name"
                           : fmt::format("no node is called {}{}", name, didYouMean(name, known)));
}

const FieldInfo& findField(const std::string& text, const std::string& name, const Node& node) {
  const NodeType& type = node.type();
  const FieldInfo* field = xvrml::findField(node, name);
  if (!field) field = findEventIn(node, name);
  if (field && field->access == Access::eventOut)
    fail(text, fmt::format("{} is an eventOut: {} sends it", name, type.name));
  if (field) return *field;
  std::vector<std::string> known;
  for (const FieldInfo& one : type.fields)
    if (one.access != Access::eventOut) known.emplace_back(fieldName(node, one));
  fail(text, fmt::format("{} has no field {}{}", type.name, name, didYouMean(name, known)));
}

Definition readOne(const std::string& text, const World& world) {
  const size_t dot = text.find('.'), equals = text.find('=');
  Definition one;
  one.node = findNode(text, text.substr(0, dot), world);
  one.field = &findField(text, text.substr(dot + 1, equals - dot - 1), *one.node);
  std::string problem;
  const std::string_view written = std::string_view(text).substr(equals + 1);
  std::optional<Value> value = parseValue(one.field->type, written, problem, world.options.limits);
  if (!value && one.field->type == FieldType::SFNode)
    fail(text, "-D sets a node field only to NULL");
  if (!value)
    fail(text, fmt::format("a value of type {} was expected: {}", fieldTypeName(one.field->type),
                           problem));
  // rotation axes are normalised, so their range is not checked
  const bool rotates =
      one.field->type == FieldType::SFRotation || one.field->type == FieldType::MFRotation;
  if (holdsValue(*one.field) && !rotates && !inRange(*one.node, *one.field, *value))
    fail(text, fmt::format("the value is out of the range of {}.{}", one.node->type().name,
                           one.field->name));
  one.value = std::move(*value);
  const bool instance = nodeCast<ProtoInstance>(one.node) != nullptr;
  if (instance && one.field->access == Access::field)
    fail(text, fmt::format("{} is a field of prototype {}, which is fixed when the file is read; "
                           "an exposedField can be set",
                           one.field->name, one.node->type().name));
  one.asEvent =
      one.field->access == Access::eventIn || instance || one.node->type().name == "Inline";
  return one;
}

} // namespace

std::vector<Definition> readDefinitions(const std::vector<std::string>& texts, const World& world) {
  std::vector<Definition> all;
  for (const std::string& text : texts) all.push_back(readOne(text, world));
  return all;
}

} // namespace vv
