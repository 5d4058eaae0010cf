// types.cpp: names and default values of the field types (ISO/IEC 19775-1 clause 5). Used by the
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

template <class T> constexpr bool isVector = false;
template <class T> constexpr bool isVector<std::vector<T>> = true;
#define XVRML_MULTIPLE(name, type) isVector<type>,
constexpr std::array<bool, fieldTypeCount> multiple = {XVRML_FIELD_TYPES(XVRML_MULTIPLE)};
#undef XVRML_MULTIPLE

// The types' names differ in their first letter only: MFColor is a list of SFColor.
constexpr std::array<FieldType, fieldTypeCount> findElements() {
  std::array<FieldType, fieldTypeCount> elements{};
  for (size_t many = 0; many < typeNames.size(); ++many)
    for (size_t one = 0; one < typeNames.size(); ++one)
      if (!multiple[one] && typeNames[one].substr(1) == typeNames[many].substr(1))
        elements[many] = FieldType(one);
  return elements;
}
constexpr std::array<FieldType, fieldTypeCount> elements = findElements();

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

bool isMultiple(FieldType type) {
  const auto index = size_t(type);
  return index < multiple.size() && multiple[index];
}

FieldType elementType(FieldType type) {
  const auto index = size_t(type);
  return index < elements.size() ? elements[index] : type;
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
