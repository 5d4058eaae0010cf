#include "edit/shader_parameters.h"

#include <algorithm>
#include <cfloat>
#include <cstdint>
#include <cstdlib>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "edit/as_printed.h"
#include "xvrml/numbers.h"

namespace vv {

using namespace xvrml;
using picture::ShaderClass;
using picture::ShaderParameter;

namespace {

// Returns the default of a parameter as a value of the field that stands for it; nothing if no
// field is offered.
std::optional<Value> valueOf(const ShaderParameter& parameter) {
  const std::vector<float>& n = parameter.value;
  switch (parameter.type) {
  case RT_PARAM_INT: return int32_t(std::clamp(double(n[0]), double(INT32_MIN), double(INT32_MAX)));
  case RT_PARAM_FLOAT: return n[0];
  case RT_PARAM_VEC2: return Vec2f{n[0], n[1]};
  case RT_PARAM_VEC3: return Vec3f{n[0], n[1], n[2]};
  case RT_PARAM_VEC4: return Vec4f{n[0], n[1], n[2], n[3]};
  case RT_PARAM_COLOR: return Color{n[0], n[1], n[2]};
  case RT_PARAM_FLOATS: return MFFloat();
  case RT_PARAM_STRING:
  case RT_PARAM_TEXTURE: return MFString(); // urls
  default: return std::nullopt;
  }
}

} // namespace

const ShaderClass* classOf(WorldEditor& editor, const std::string& name, const std::string& file) {
  const std::vector<ShaderClass>& classes = editor.shaderClasses();
  const auto found = std::find_if(classes.begin(), classes.end(), [&](const ShaderClass& one) {
    return one.name == name && (file.empty() || file == one.library);
  });
  return found == classes.end() ? nullptr : &*found;
}

std::optional<FieldInfo> fieldFor(const ShaderParameter& parameter) {
  std::optional<Value> value = valueOf(parameter);
  if (!value) return std::nullopt;
  FieldInfo field{};
  field.name = parameter.name;
  field.type = FieldType(value->index());
  field.access = Access::exposedField;
  field.change = Change::shader;
  field.defaultValue = std::move(*value);
  field.text = parameter.text;
  if (parameter.minimum > -FLT_MAX) {
    field.range.minimum = asPrinted(parameter.minimum);
    field.range.minimumOpen = false;
  }
  if (parameter.maximum < FLT_MAX) {
    field.range.maximum = asPrinted(parameter.maximum);
    field.range.maximumOpen = false;
  }
  field.declared = true;
  return field;
}

std::map<std::string, ShaderOption> optionsOf(const nodes::ORTShader& shader) {
  std::vector<std::string> errors; // the world's messages have them
  std::map<std::string, ShaderOption> options;
  for (ShaderOption& option : parseShaderOptions(shader.options, errors)) {
    std::string name = option.name;
    options.insert_or_assign(std::move(name), std::move(option));
  }
  return options;
}

namespace {

// Return how many numbers an option or a value has; 0 if it is something else.
size_t countOf(const ShaderOption& option) {
  using Type = ShaderOption::Type;
  if (option.type == Type::integer) return 1;
  return option.type == Type::floats || option.type == Type::color ? option.numbers.size() : 0;
}
size_t countOf(const Value& value) {
  return std::visit(
      []<class T>(const T&) -> size_t {
        if constexpr (Numeric<T>)
          return numberCount<T>;
        else
          return 0;
      },
      value);
}

} // namespace

std::optional<Value> valueOf(const ShaderOption& option, const ShaderParameter& parameter) {
  const bool isInteger = option.type == ShaderOption::Type::integer;
  if (isInteger != (parameter.type == RT_PARAM_INT) || countOf(option) == 0 ||
      countOf(option) != parameter.value.size())
    return std::nullopt;
  if (isInteger) return int32_t(option.integer);
  ShaderParameter set = parameter;
  set.value = option.numbers;
  return valueOf(set);
}

namespace {

// Returns the text of an option's values with other numbers. Those that stay keep their words.
std::string withNumbers(std::string_view text, const Value& value) {
  constexpr const char* blanks = " \t\r\n,";
  std::string out;
  const auto replace = [&](auto number) {
    const size_t begin = std::min(text.find_first_not_of(blanks), text.size());
    const size_t end = std::min(text.find_first_of(blanks, begin), text.size());
    const std::string word(text.substr(begin, end - begin));
    const char* const digits = word.c_str() + (word.starts_with('\'') ? 1 : 0); // may be quoted
    const bool stays = decltype(number)(std::strtod(digits, nullptr)) == number;
    out += std::string(text.substr(0, begin)) + (stays ? word : fmt::format("{}", number));
    text.remove_prefix(end);
  };
  std::visit(
      [&]<class T>(const T& set) {
        if constexpr (Numeric<T>)
          for (int i = 0; i < numberCount<T>; ++i) replace(numbersOf(set)[i]);
      },
      value);
  return out += text;
}

} // namespace

void setParameter(WorldEditor& editor, const NodeRef& shader, const std::string& name,
                  const Value& value) {
  if (const auto* const node = nodeCast<nodes::ORTShader>(shader)) {
    const auto options = optionsOf(*node);
    const auto option = options.find(name);
    const bool isInteger = std::holds_alternative<int32_t>(value);
    if (option != options.end() && countOf(option->second) == countOf(value) &&
        isInteger == (option->second.type == ShaderOption::Type::integer)) {
      const auto& [begin, end] = std::pair(option->second.begin, option->second.end);
      MFString texts = node->options;
      std::string& text = texts.at(option->second.element);
      text.replace(begin, end - begin, withNumbers(text.substr(begin, end - begin), value));
      return editor.step("Set ORTShader." + name,
                         [&] { editor.editor().set(*shader, "options", std::move(texts)); });
    }
  }
  const NodeRef made = editor.editor().declare(*shader, name, value);
  MFNode nodes = editor.selection();
  std::replace(nodes.begin(), nodes.end(), shader, made);
  editor.select(std::move(nodes));
}

} // namespace vv
