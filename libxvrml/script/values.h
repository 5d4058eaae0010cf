// values.h: field values across the border of the script ABI: the host's Value as typed arrays, and
// arrays that a Script hands over, checked, as a Value. [the browser's thread]
#pragma once

#include "script/handles.h"
#include "xvrml/limits.h"

namespace xvrml {

inline XsType xsType(FieldType type) { return XsType(int(type) + XS_SFBOOL); }
inline XsAccess xsAccess(Access access) {
  constexpr XsAccess table[] = {XS_FIELD, XS_EXPOSED_FIELD, XS_EVENT_IN, XS_EVENT_OUT};
  return table[size_t(access)];
}

// Keeps what an XsValue points to.
class LentValue {
 public:
  // The value stays as it is until the next call.
  const XsValue& lend(Value value, Handles& handles);
  void clear();

 private:
  Value value_;
  int32_t boolean_ = 0;
  std::vector<XsString> strings_;
  std::vector<XsNode> nodes_;
  XsImage image_{};
  XsValue view_{};
};

// False, and why, if it is not a good value of this type: another type, wrong counts, missing
// arrays, text that is no UTF-8, nodes that the Script does not know.
bool takeValue(const XsValue* value, FieldType wanted, const Handles& handles, const Limits& limits,
               Value& out, std::string& why);
bool takeText(const XsString& text, const Limits& limits, std::string& out, std::string& why);

} // namespace xvrml
