// visit_storage.h: calls a function with the typed value of a field whose type is known only at run
// time. [any thread that owns the value]
#pragma once

#include <type_traits>
#include <vector>

#include "xvrml/types.h"

namespace xvrml {

// Calls visit with a typed reference to the storage of a field of this type.
template <class Visitor>
decltype(auto) visitStorage(FieldType type, void* storage, Visitor&& visit) {
  switch (type) {
#define XVRML_CASE(name, type)                                                                     \
  case FieldType::name: return visit(*static_cast<name*>(storage));
    XVRML_FIELD_TYPES(XVRML_CASE)
#undef XVRML_CASE
  }
  return visit(*static_cast<MFVec3f*>(storage)); // for a number that is no type
}

// Whether a type is that of an MF field, and whether of one that holds numbers.
template <class T> inline constexpr bool isList = false;
template <class T> inline constexpr bool isList<std::vector<T>> = true;
template <class T> inline constexpr bool isNumberList = false;
template <class T> inline constexpr bool isNumberList<std::vector<T>> =
    std::is_trivially_copyable_v<T>;

} // namespace xvrml
