// types.cpp: names and default values of the 20 field types (ISO/IEC 14772-1 clause 5). Used by the
// parser, the writer, nodegen and the bindings. [any thread]
#include "xvrml/types.h"

#include <array>
#include <utility>

#include "xvrml/node.h"

namespace xvrml {
namespace {

#define XVRML_STRING(name, type) #name,
constexpr std::array<std::string_view, fieldTypeCount> typeNames = {
    XVRML_FIELD_TYPES(XVRML_STRING)};
#undef XVRML_STRING

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
  switch (type) {
#define XVRML_CASE(name, type)                                                                     \
  case FieldType::name: return Value(std::in_place_type<name>);
    XVRML_FIELD_TYPES(XVRML_CASE)
#undef XVRML_CASE
  }
  return {};
}

} // namespace xvrml
