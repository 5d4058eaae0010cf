#include "edit/shader_parameters.h"

#include <algorithm>
#include <cfloat>
#include <cstdint>
#include <cstdlib>
#include <iterator>
#include <string_view>

#include <fmt/format.h>

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

// Returns the number that a plug-in's text has, as a float is printed: 0.1, not 0.10000000149.
double printed(float number) { return std::strtod(fmt::format("{}", number).c_str(), nullptr); }

} // namespace

const ShaderClass* classOf(WorldEditor& editor, const nodes::ORTShader& shader) {
  const std::vector<ShaderClass>& classes = editor.shaderClasses();
  const auto found = std::find_if(classes.begin(), classes.end(), [&](const ShaderClass& one) {
    return one.name == shader.name && (shader.file.empty() || shader.file == one.library);
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
    field.range.minimum = printed(parameter.minimum);
    field.range.minimumOpen = false;
  }
  if (parameter.maximum < FLT_MAX) {
    field.range.maximum = printed(parameter.maximum);
    field.range.maximumOpen = false;
  }
  field.declared = true;
  return field;
}

bool isInOptions(const nodes::ORTShader& shader, const std::string& parameter) {
  constexpr std::string_view types[] = {"1i",  "bool",  "1f",     "2f",     "3f",      "4f",
                                        "16f", "color", "floats", "string", "texture", "file"};
  constexpr const char* blanks = " \t\r\n,";
  return std::any_of(shader.options.begin(), shader.options.end(), [&](std::string_view option) {
    // The name of a parameter stands behind its type; an option may be one of several.
    std::string_view before;
    for (size_t at = option.find_first_not_of(blanks); at != option.npos;
         at = option.find_first_not_of(blanks, at)) {
      const size_t end = std::min(option.find_first_of(blanks, at), option.size());
      const std::string_view word = option.substr(at, end - at);
      if (word == parameter && std::count(std::begin(types), std::end(types), before) > 0)
        return true;
      before = word;
      at = end;
    }
    return false;
  });
}

void declareParameter(WorldEditor& editor, const NodeRef& shader, const std::string& name,
                      const Value& value) {
  const NodeRef made = editor.editor().declare(*shader, name, value);
  MFNode nodes = editor.selection();
  std::replace(nodes.begin(), nodes.end(), shader, made);
  editor.select(std::move(nodes));
}

} // namespace vv
