#include "conformance/events/support.h"

namespace xvrml {
namespace {

std::string one(bool v) { return v ? "TRUE" : "FALSE"; }
std::string one(int32_t v) { return fmt::format("{}", v); }
std::string one(float v) { return fmt::format("{:g}", v); }
std::string one(double v) { return fmt::format("{:.17g}", v); }
std::string one(const std::string& v) { return v; }
std::string one(const NodeRef& v) {
  return v ? (v->defName.empty() ? v->type().name : v->defName) : "NULL";
}
std::string one(const Vec2f& v) { return fmt::format("{:g} {:g}", v.x, v.y); }
std::string one(const Vec3f& v) { return fmt::format("{:g} {:g} {:g}", v.x, v.y, v.z); }
std::string one(const Color& v) { return fmt::format("{:g} {:g} {:g}", v.r, v.g, v.b); }
std::string one(const Rotation& v) {
  return fmt::format("{:g} {:g} {:g} {:g}", v.x, v.y, v.z, v.angle);
}
std::string one(const Image& v) { return fmt::format("{}x{}x{}", v.width, v.height, v.components); }
template <class T> std::string one(const std::vector<T>& values) {
  std::string text = "[";
  for (const T& v : values) text += (text.size() > 1 ? ", " : "") + one(v);
  return text + "]";
}

} // namespace

std::string textOf(const Value& value) {
  return std::visit([](const auto& v) { return one(v); }, value);
}

} // namespace xvrml
