#include "shader_list.h"

#include <cfloat>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "libpicture/shader_classes.h"
#include "options/shader_text.h"
#include "printable.h"
#include "process/messages.h"

namespace vv {

namespace {

using picture::parameterTypeName;
using picture::roleName;
using picture::ShaderClass;
using picture::ShaderParameter;
using Json = nlohmann::ordered_json;

Json number(float value) { return value; }

Json defaultOf(const ShaderParameter& parameter) {
  if (parameter.value.empty()) return nullptr;
  if (parameter.value.size() == 1)
    return parameter.type == RT_PARAM_INT ? Json(int(parameter.value[0]))
                                          : number(parameter.value[0]);
  Json list = Json::array();
  for (const float one : parameter.value) list.push_back(number(one));
  return list;
}

const char* frequencyName(RTenum frequency) {
  return frequency == RT_PER_VERTEX     ? "vertex"
         : frequency == RT_PER_TRIANGLE ? "triangle"
                                        : "shader";
}

Json classJson(const ShaderClass& c) {
  Json parameters = Json::array();
  for (const ShaderParameter& parameter : c.parameters) {
    Json one = {{"name", parameter.name},
                {"type", parameterTypeName(parameter.type)},
                {"default", defaultOf(parameter)}};
    if (parameter.minimum > -FLT_MAX) one["minimum"] = number(parameter.minimum);
    if (parameter.maximum < FLT_MAX) one["maximum"] = number(parameter.maximum);
    one["per"] = frequencyName(parameter.frequency);
    one["text"] = parameter.text;
    parameters.push_back(std::move(one));
  }
  return {{"name", c.name},
          {"library", c.library},
          {"kind", roleName(c.role)},
          {"text", c.text},
          {"parameters", std::move(parameters)}};
}

std::string valueText(const Json& value) {
  if (value.is_null()) return "";
  if (!value.is_array())
    return value.is_number_integer() ? value.dump() : fmt::format("{}", value.get<float>());
  std::string text;
  for (const Json& one : value)
    text += fmt::format("{}{}", text.empty() ? "" : " ", one.get<float>());
  return text;
}

std::string classText(const Json& c) {
  std::string text = fmt::format("{} ({}, plug-in {}): {}\n", c["name"].get<std::string>(),
                                 c["kind"].get<std::string>(), c["library"].get<std::string>(),
                                 c["text"].get<std::string>());
  for (const Json& p : c["parameters"]) {
    const std::string value = p["type"] == "matrix" ? "" : valueText(p["default"]);
    text += fmt::format("  {:<8} {:<18} {:<14} {}{}\n", p["type"].get<std::string>(),
                        p["name"].get<std::string>(), value, p["text"].get<std::string>(),
                        p["per"] == "shader" ? "" : " (per " + p["per"].get<std::string>() + ")");
  }
  return text;
}

} // namespace

std::string listShaders(const std::string& shaderPath, bool json) {
  Json classes = Json::array();
  std::vector<std::string> problems;
  for (const ShaderClass& one : picture::installedShaders(shaderPath, problems))
    classes.push_back(classJson(one));
  for (const std::string& problem : problems) sayWarning(problem);
  if (json)
    return printableJson(Json({{"shaders", std::move(classes)}})
                             .dump(2, ' ', false, Json::error_handler_t::replace)) +
           "\n";
  std::string text;
  for (const Json& c : classes) text += classText(c);
  return text;
}

} // namespace vv
