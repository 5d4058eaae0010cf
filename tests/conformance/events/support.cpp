#include "conformance/events/support.h"

#include "xvrml/numbers.h"

namespace xvrml {
namespace {

std::string one(bool v) { return v ? "TRUE" : "FALSE"; }
template <Numeric T> std::string one(const T& v) {
  std::string text;
  for (int i = 0; i < numberCount<T>; ++i)
    if constexpr (std::is_same_v<ScalarOf<T>, float>)
      text += fmt::format("{}{:g}", i ? " " : "", numbersOf(v)[i]);
    else
      text += fmt::format("{}{:.17g}", i ? " " : "", double(numbersOf(v)[i]));
  return text;
}
std::string one(const std::string& v) { return v; }
std::string one(const NodeRef& v) {
  return v ? (v->defName.empty() ? v->type().name : v->defName) : "NULL";
}
std::string one(const Image& v) { return fmt::format("{}x{}x{}", v.width, v.height, v.components); }
template <class T> std::string one(const std::vector<T>& values) {
  std::string text = "[";
  for (const auto& v : values)
    text += (text.size() > 1 ? ", " : "") + one(ElementOf<std::vector<T>>(v));
  return text + "]";
}

} // namespace

std::string textOf(const Value& value) {
  return std::visit([](const auto& v) { return one(v); }, value);
}

} // namespace xvrml
