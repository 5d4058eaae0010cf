// cpp_values.cpp: names and default values in C++ syntax. Pure functions.
#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "nodegen/writers.h"
#include "xvrml/numbers.h"

namespace xvrml::nodegen {
namespace {

// Keywords of C++20, and the names of members that every generated struct has.
constexpr auto reserved = std::to_array<std::string_view>(
    {"alignas",      "alignof",      "and",           "and_eq",
     "asm",          "auto",         "bitand",        "bitor",
     "bool",         "break",        "case",          "catch",
     "char",         "char16_t",     "char32_t",      "char8_t",
     "class",        "co_await",     "co_return",     "co_yield",
     "compl",        "concept",      "const",         "const_cast",
     "consteval",    "constexpr",    "constinit",     "continue",
     "decltype",     "default",      "delete",        "do",
     "double",       "dynamic_cast", "else",          "enum",
     "explicit",     "export",       "extern",        "false",
     "float",        "for",          "friend",        "goto",
     "if",           "inline",       "int",           "long",
     "mutable",      "namespace",    "new",           "nodeType",
     "noexcept",     "not",          "not_eq",        "nullptr",
     "operator",     "or",           "or_eq",         "private",
     "protected",    "public",       "register",      "reinterpret_cast",
     "requires",     "return",       "short",         "signed",
     "sizeof",       "static",       "static_assert", "static_cast",
     "struct",       "switch",       "template",      "this",
     "thread_local", "throw",        "true",          "try",
     "typeIndex",    "typedef",      "typeid",        "typename",
     "union",        "unsigned",     "using",         "virtual",
     "void",         "volatile",     "wchar_t",       "while",
     "xor",          "xor_eq"});
static_assert(std::is_sorted(reserved.begin(), reserved.end()));

// Returns the shortest literal that is exactly the number.
std::string literal(float number) {
  std::string text = fmt::format("{}", number);
  if (text.find_first_of(".e") != std::string::npos) text += 'f';
  return text;
}
std::string literal(int32_t number) { return std::to_string(number); }
std::string literal(double number) { return fmt::format("{}", number); }

struct Initializer {
  std::string operator()(bool value) const { return value ? "true" : "false"; }
  std::string operator()(const std::string& value) const { return cppString(value); }
  std::string operator()(const NodeRef&) const { return {}; }
  template <class T> std::string operator()(const Boxed<T>& value) const {
    return '{' + (*this)(*value) + '}';
  }
  template <Numeric T> std::string operator()(const T& value) const {
    std::string text;
    for (int i = 0; i < numberCount<T>; ++i) text += (i ? ", " : "") + literal(numbersOf(value)[i]);
    return text;
  }
  std::string operator()(const Image& image) const {
    return fmt::format("{}, {}, {}, {{{}}}", image.width, image.height, image.components,
                       fmt::join(image.pixels, ", "));
  }
  std::string operator()(const MFNode&) const { return {}; }
  template <class T> std::string operator()(const std::vector<T>& values) const {
    std::string text;
    for (const auto& value : values) {
      const std::string item = (*this)(ElementOf<std::vector<T>>(value));
      constexpr bool scalar = std::is_arithmetic_v<T> || std::is_same_v<T, std::string>;
      text += (text.empty() ? "" : ", ") + (scalar ? item : '{' + item + '}');
    }
    return text;
  }
};

} // namespace

std::string cppMember(const FieldSpec& field) {
  return std::binary_search(reserved.begin(), reserved.end(), std::string_view(field.name))
             ? field.name + '_'
             : field.name;
}

std::string cppInitializer(const Value& value) {
  if (value == defaultValue(FieldType(value.index())) &&
      value.index() != size_t(FieldType::SFRotation)) {
    // Default numbers and booleans are written out, because readers of the header want to see them.
    const bool empty =
        isMultiple(FieldType(value.index())) || value.index() == size_t(FieldType::SFNode) ||
        value.index() == size_t(FieldType::SFString) || value.index() == size_t(FieldType::SFImage);
    if (empty) return {};
  }
  return std::visit(Initializer(), value);
}

std::string cppString(std::string_view text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\')
      result.append({'\\', c});
    else if (static_cast<unsigned char>(c) < ' ')
      result += fmt::format("\\{:03o}", static_cast<unsigned char>(c));
    else
      result += c;
  }
  return result + '"';
}

std::string joinNames(const std::vector<Reference>& names) {
  std::string result;
  for (const Reference& name : names) result += (result.empty() ? "" : " ") + name.name;
  return result;
}

} // namespace xvrml::nodegen
