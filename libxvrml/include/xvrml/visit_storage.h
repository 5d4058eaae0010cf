// visit_storage.h: calls a function with the typed value of a field whose type is known only at run
// time. [any thread that owns the value]
#pragma once

#include <utility>

#include "xvrml/numbers.h"

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
// Does the same for storage that is only read.
template <class Visitor>
decltype(auto) visitStorage(FieldType type, const void* storage, Visitor&& visit) {
  return visitStorage(type, const_cast<void*>(storage), [&visit](auto& value) -> decltype(auto) {
    return visit(std::as_const(value));
  });
}

} // namespace xvrml
