#include "mapper/shading/shader_fields.h"

#include <algorithm>

#include "base/visit_storage.h"
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

// Reads a value into an option. Returns false if the value sets nothing.
struct Reader {
  RTenum parameter;
  ShaderOption& option;
  using Type = ShaderOption::Type;

  bool operator()(bool value) const {
    option.type = Type::boolean;
    option.integer = value;
    return true;
  }
  bool operator()(int32_t value) const {
    option.type = Type::integer;
    option.integer = value;
    return true;
  }
  bool operator()(const std::string& value) const {
    option.type = Type::text;
    option.text = value;
    return true;
  }
  bool operator()(const MFString& urls) const {
    if (urls.empty()) return false;
    option.type = parameter == RT_PARAM_TEXTURE ? Type::texture : Type::file;
    option.text = urls[0];
    option.otherUrls.assign(urls.begin() + 1, urls.end());
    return true;
  }
  bool operator()(const NodeRef& node) const {
    option.type = Type::node;
    option.picture = node;
    return bool(node);
  }
  template <class T> bool operator()(const T& value) const {
    if constexpr (isNumberList<T>) {
      option.type = Type::list;
      for (const auto& one : value) append(one);
    } else if constexpr (Numeric<T>) {
      option.type = Type::floats;
      append(value);
    }
    return true;
  }
  template <class T> void append(const T& value) const {
    for (int i = 0; i < numberCount<T>; ++i) option.numbers.push_back(float(numbersOf(value)[i]));
  }
};

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
    ShaderOption option;
    option.name = field.name;
    option.field = &field;
    const RTenum parameter = shaderClass.parameters.at(field.name);
    const bool sets =
        visitStorage(field.type, const_cast<void*>(node.storage(field)), [&](const auto& value) {
          return Reader{parameter, option}(value);
        });
    if (std::erase_if(options, [&](const ShaderOption& one) { return one.name == field.name; }))
      problems.push_back({&field, false, "an option sets this parameter, too; the field counts"});
    if (sets) options.push_back(std::move(option));
  }
}

} // namespace xvrml::mapper
