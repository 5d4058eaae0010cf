// types.cpp: names and default values of the 20 field types (ISO/IEC 14772-1 clause 5). Used by the
// parser, the writer, nodegen and the bindings. [any thread]
#include "xvrml/types.h"

#include <array>
#include <utility>

#include "xvrml/node.h"

namespace xvrml {
namespace {

constexpr std::array<std::string_view, fieldTypeCount> typeNames = {
    "SFBool",   "SFColor",    "SFFloat",  "SFImage", "SFInt32", "SFNode",  "SFRotation",
    "SFString", "SFTime",     "SFVec2f",  "SFVec3f", "MFColor", "MFFloat", "MFInt32",
    "MFNode",   "MFRotation", "MFString", "MFTime",  "MFVec2f", "MFVec3f"};

static_assert(std::variant_size_v<Value> == fieldTypeCount);
static_assert(std::is_same_v<std::variant_alternative_t<size_t(FieldType::SFNode), Value>, SFNode>);
static_assert(
    std::is_same_v<std::variant_alternative_t<size_t(FieldType::SFVec3f), Value>, SFVec3f>);
static_assert(
    std::is_same_v<std::variant_alternative_t<size_t(FieldType::MFVec3f), Value>, MFVec3f>);

template <size_t... I> Value defaultOf(size_t type, std::index_sequence<I...>) {
  Value value;
  ((I == type ? void(value.emplace<I>()) : void()), ...);
  return value;
}

} // namespace

std::string_view fieldTypeName(FieldType type) {
  const auto index = size_t(type);
  return index < typeNames.size() ? typeNames[index] : std::string_view();
}

bool fieldTypeFromName(std::string_view name, FieldType& type) {
  if (name.size() < 5 || name[1] != 'F') return false;
  for (size_t i = 0; i < typeNames.size(); ++i) {
    if (typeNames[i] != name) continue;
    type = FieldType(i);
    return true;
  }
  return false;
}

Value defaultValue(FieldType type) {
  return defaultOf(size_t(type), std::make_index_sequence<fieldTypeCount>());
}

} // namespace xvrml
