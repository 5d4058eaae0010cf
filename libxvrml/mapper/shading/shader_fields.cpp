#include "mapper/shading/shader_fields.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "nearest.h"

namespace xvrml::mapper {
namespace {

// The types of fields that a parameter can be declared with. SFString is a text itself; MFString
// has the URLs of a file that holds the text or the picture.
struct Row {
  RTenum parameter;
  std::vector<FieldType> fields;
};
const std::vector<Row>& table() {
  using enum FieldType;
  static const auto& rows =
      *new std::vector<Row>{{RT_PARAM_INT, {SFInt32, SFBool}},
                            {RT_PARAM_FLOAT, {SFFloat, SFDouble}},
                            {RT_PARAM_VEC2, {SFVec2f, SFVec2d}},
                            {RT_PARAM_VEC3, {SFVec3f, SFVec3d, SFColor}},
                            {RT_PARAM_VEC4, {SFVec4f, SFVec4d, SFColorRGBA, SFRotation}},
                            {RT_PARAM_COLOR, {SFColor, SFVec3f, SFVec3d}},
                            {RT_PARAM_MATRIX, {SFMatrix4f, SFMatrix4d}},
                            {RT_PARAM_FLOATS, {MFFloat, MFDouble}},
                            {RT_PARAM_STRING, {SFString, MFString}},
                            {RT_PARAM_TEXTURE, {MFString, SFNode}}};
  return rows;
}

// Returns what is wrong with the name or the type of a field; "" if the class takes it.
std::string problemOf(const FieldInfo& field, const nodes::ORTShader& node,
                      const ShaderClass& shaderClass) {
  const auto parameter = shaderClass.parameters.find(field.name);
  if (parameter == shaderClass.parameters.end()) {
    std::vector<std::string> names;
    for (const auto& [name, type] : shaderClass.parameters) names.push_back(name);
    std::sort(names.begin(), names.end());
    return "the class has no parameter of this name" + nearest::suggestion(field.name, names);
  }
  const auto row = std::find_if(table().begin(), table().end(),
                                [&](const Row& one) { return one.parameter == parameter->second; });
  if (row == table().end()) return "a field cannot set a parameter of this type";
  const std::vector<FieldType>& types = row->fields;
  if (std::find(types.begin(), types.end(), field.type) != types.end()) return "";
  std::string wanted;
  for (const FieldType& type : types)
    wanted += (wanted.empty()           ? ""
               : &type == &types.back() ? " or "
                                        : ", ") +
              std::string(fieldTypeName(type));
  return "this parameter of " + node.name + " is declared as " + wanted + ", not as " +
         std::string(fieldTypeName(field.type));
}

} // namespace

void addDeclaredFields(const nodes::ORTShader& node, const ShaderClass& shaderClass,
                       std::vector<ShaderOption>& options, std::vector<FieldProblem>& problems) {
  if (shaderClass.id == 0) return; // there is nothing to compare with
  for (const FieldInfo& field : node.type().fields) {
    if (!field.declared || !holdsValue(field)) continue;
    if (std::string why = problemOf(field, node, shaderClass); !why.empty()) {
      problems.push_back({&field, true, std::move(why)});
      continue;
    }
    std::optional<ShaderOption> option = declaredOption(node, field);
    if (option && option->type == ShaderOption::Type::file &&
        shaderClass.parameters.at(field.name) == RT_PARAM_TEXTURE)
      option->type = ShaderOption::Type::texture;
    if (std::erase_if(options, [&](const ShaderOption& one) { return one.name == field.name; }))
      problems.push_back({&field, false, "an option sets this parameter, too; the field counts"});
    if (option) options.push_back(std::move(*option));
  }
}

} // namespace xvrml::mapper
