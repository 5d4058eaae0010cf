#include "libpicture/export/shader_values.h"

#include <algorithm>
#include <stdexcept>

#include "libpicture/export/surface.h"

namespace picture {

using xvrml::Color;
using xvrml::MaterialValues;
using xvrml::ShaderOption;

float ShaderValues::number(std::string_view name) const {
  const auto found = values_.find(name);
  return found == values_.end() || found->second.empty() ? 0 : found->second[0];
}

Color ShaderValues::color(std::string_view name) const {
  const auto found = values_.find(name);
  if (found == values_.end() || found->second.size() < 3) return {};
  return {found->second[0], found->second[1], found->second[2]};
}

// The names are those of libxvrml's mapper (docs/shaders.md).
std::string_view ShaderValues::materialColor() const {
  for (const char* name : {"diffuseColor", "baseColor", "color", "reflectance"})
    if (const auto found = values_.find(name); found != values_.end() && found->second.size() == 3)
      return found->first;
  return {};
}

const ShaderOption* ShaderValues::given(std::string_view name) const {
  const auto found = std::find_if(options_.begin(), options_.end(),
                                  [&](const ShaderOption& one) { return one.name == name; });
  return found == options_.end() ? nullptr : &*found;
}

void ShaderValues::set(std::string_view name, const Color& value) {
  if (const auto found = values_.find(name); found != values_.end() && found->second.size() == 3)
    found->second = {value.r, value.g, value.b};
}

void ShaderValues::set(std::string_view name, float value) {
  if (const auto found = values_.find(name); found != values_.end() && found->second.size() == 1)
    found->second = {value};
}

// Fields of the material set the parameters of the same names.
void ShaderValues::setMaterial(const MaterialValues& material) {
  using Model = MaterialValues::Model;
  if (material.model == Model::none) return;
  set(materialColor(), linearOf(material.color));
  if (material.model == Model::unlit) return;
  set("emissiveColor", linearOf(material.emissiveColor));
  set("transparency", material.transparency);
  if (material.model == Model::phong) {
    set("specularColor", linearOf(material.specularColor));
    set("shininess", material.shininess);
  } else if (values_.contains("metallic")) {
    set("metallic", material.metallic);
    set("roughness", material.roughness);
  }
}

std::optional<ShaderValues> ShaderTables::valuesOf(const xvrml::AppearanceParts& parts) {
  if (!classes_) {
    classes_.emplace();
    std::vector<std::string> problems;
    try {
      *classes_ = installedShaders(shaderPath_, problems);
    } catch (const std::runtime_error&) {} // then no class is known
  }
  const xvrml::nodes::ORTShader& node = *parts.shader;
  const auto found = std::find_if(classes_->begin(), classes_->end(), [&](const ShaderClass& one) {
    return one.name == node.name && (node.file.empty() || one.library == node.file);
  });
  if (found == classes_->end()) return {};
  ShaderValues values;
  for (const ShaderParameter& parameter : found->parameters) {
    values.values_.emplace(parameter.name, parameter.value);
    if (parameter.type == RT_PARAM_COLOR && values.firstColor_.empty())
      values.firstColor_ = parameter.name;
  }
  values.setMaterial(xvrml::materialValues(parts.material));
  values.options_ = xvrml::shaderOptions(node);
  for (const ShaderOption& option : values.options_) {
    const auto value = values.values_.find(option.name);
    if (value == values.values_.end()) continue;
    if (!option.numbers.empty())
      value->second = option.numbers;
    else if (option.type == ShaderOption::Type::integer ||
             option.type == ShaderOption::Type::boolean)
      value->second = {float(option.integer)};
  }
  return values;
}

} // namespace picture
