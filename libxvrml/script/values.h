// values.h: field values at the script ABI: converts the host's Value to typed arrays, and checked
// arrays from a Script to a Value. [the browser's thread]
#pragma once

#include "script/handles.h"
#include "xvrml/limits.h"

namespace xvrml {

constexpr XsType xsType(FieldType type) { return XsType(int(type) + XS_SFBOOL); }
inline XsAccess xsAccess(Access access) {
  constexpr XsAccess table[] = {XS_FIELD, XS_EXPOSED_FIELD, XS_EVENT_IN, XS_EVENT_OUT};
  return table[size_t(access)];
}

// Holds the data that an XsValue points to.
class LentValue {
 public:
  // Returns a view of the value that is valid until the next call.
  const XsValue& lend(Value value, Handles& handles);
  void clear();

 private:
  template <class T> void lendAll(const T& value, Handles& handles);
  void lendOne(bool value, Handles& handles);
  void lendOne(const std::string& text, Handles& handles);
  void lendOne(const NodeRef& node, Handles& handles);
  void lendOne(const Image& image, Handles& handles);

  Value value_;
  std::vector<int32_t> booleans_;
  std::vector<XsString> strings_;
  std::vector<XsNode> nodes_;
  std::vector<XsImage> images_;
  XsValue view_{};
};

// Checks and converts a value of a Script. Returns false, with the reason, for a wrong type, wrong
// counts, missing arrays, invalid UTF-8 or unknown nodes.
bool takeValue(const XsValue* value, FieldType wanted, const Handles& handles, const Limits& limits,
               Value& out, std::string& why);
bool takeText(const XsString& text, const Limits& limits, std::string& out, std::string& why);

} // namespace xvrml
