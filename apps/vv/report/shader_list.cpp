// shader_list.cpp: Reads the names of the classes from each plug-in. The library checks the
// plug-ins.
#include "shader_list.h"

#include <algorithm>
#include <cfloat>
#include <filesystem>
#include <set>
#include <vector>

#include <dlfcn.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "folder_files.h"
#include "openrt/openrt.h"
#include "openrt/openrts.h"
#include "options/shader_text.h"
#include "plugin_library.h"
#include "printable.h"
#include "process/messages.h"
#include "system/libraries.h"

namespace vv {

namespace {

namespace fs = std::filesystem;
using picture::parameterTypeName;
using picture::roleName;
using Json = nlohmann::ordered_json;

struct File {
  std::string name, path;
};

// Returns the libraries in the shader folders, each name once, in the engine's search order.
std::vector<File> libraries(const std::string& shaderPath) {
  std::vector<File> list;
  std::set<std::string> known;
  const void* here = reinterpret_cast<const void*>(&rtNewContext);
  for (const std::string& folder :
       plugin_files::folders(shaderPath, "OPENRT_SHADER_PATH", "openrt/shaders", here)) {
    if (!plugin_files::trusted(folder)) continue;
    std::vector<std::string> names;
    for (const std::string& file : filesOfFolder(folder, ".so"))
      names.push_back(plugin_files::bareName(fs::path(file).filename().string(), "shader library"));
    std::sort(names.begin(), names.end());
    for (const std::string& name : names)
      if (known.insert(name).second) list.push_back({name, plugin_files::file(folder, name)});
  }
  return list;
}

std::string lastError() { return (rtGetError(), rtGetErrorMessage()); }

Json number(float value) { return value; }

Json defaultOf(const RTparameterInfo& info) {
  size_t count = 1;
  switch (info.type) {
  case RT_PARAM_FLOATS:
  case RT_PARAM_STRING:
  case RT_PARAM_TEXTURE: return nullptr;
  case RT_PARAM_VEC2: count = 2; break;
  case RT_PARAM_VEC3:
  case RT_PARAM_COLOR: count = 3; break;
  case RT_PARAM_VEC4: count = 4; break;
  case RT_PARAM_MATRIX: count = 16; break;
  default: break;
  }
  if (count == 1)
    return info.type == RT_PARAM_INT ? Json(int(info.defaultValue[0]))
                                     : number(info.defaultValue[0]);
  Json list = Json::array();
  for (size_t i = 0; i < count; ++i) list.push_back(number(info.defaultValue[i]));
  return list;
}

const char* frequencyName(RTenum frequency) {
  return frequency == RT_PER_VERTEX     ? "vertex"
         : frequency == RT_PER_TRIANGLE ? "triangle"
                                        : "shader";
}

Json classJson(const RtsClass& c, RTid id, const std::string& library) {
  Json parameters = Json::array();
  RTenum role = 0;
  int count = 0;
  rtGetShaderClass(id, &role, &count);
  for (int i = 0; i < count; ++i) {
    RTparameterInfo info{};
    rtGetParameterInfo(id, i, &info);
    Json one = {
        {"name", info.name}, {"type", parameterTypeName(info.type)}, {"default", defaultOf(info)}};
    if (info.minimum > -FLT_MAX) one["minimum"] = number(info.minimum);
    if (info.maximum < FLT_MAX) one["maximum"] = number(info.maximum);
    one["per"] = frequencyName(info.frequency);
    one["text"] = info.text ? info.text : "";
    parameters.push_back(std::move(one));
  }
  return {{"name", c.name},
          {"library", library},
          {"kind", roleName(role)},
          {"text", c.text ? c.text : ""},
          {"parameters", std::move(parameters)}};
}

// Appends the classes of a library, which stays loaded. Returns the error, or empty.
std::string addLibrary(const File& file, Json& classes) {
  void* handle = nullptr;
  try {
    handle = plugin_files::openLibrary(file.path, "shader library");
  } catch (const std::runtime_error& why) { return why.what(); }
  void* symbol = dlsym(handle, RTS_ENTRY_NAME);
  if (!symbol) return "exports no " RTS_ENTRY_NAME;
  const auto& plugin = *static_cast<const RtsPlugin*>(symbol);
  if (os::exportedBytes(symbol) < sizeof(RtsPlugin) || plugin.magic != RTS_MAGIC ||
      plugin.major != RTS_ABI_MAJOR || plugin.classCount == 0 || plugin.classCount > 10000 ||
      !plugin.classes || !plugin.classes[0] || !plugin.classes[0]->name) {
    rtNewShaderClass("any", file.name.c_str()); // fails and records the error text
    return lastError();
  }
  // the first call checks the tables of all classes
  for (uint32_t i = 0; i < plugin.classCount; ++i) {
    const RTid id = rtNewShaderClass(plugin.classes[i]->name, file.name.c_str());
    if (id == 0) return lastError();
    classes.push_back(classJson(*plugin.classes[i], id, file.name));
  }
  return {};
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
  const std::string config =
      "backend=null" + (shaderPath.empty() ? "" : " shaderpath=\"" + shaderPath + "\"");
  RTcontext context = rtNewContext(config.c_str());
  if (!context) throw std::runtime_error(lastError());
  Json classes = Json::array();
  for (const File& file : libraries(shaderPath))
    if (const std::string why = addLibrary(file, classes); !why.empty())
      sayWarning(why.find(file.path) == why.npos ? file.path + ": " + why : why);
  rtDeleteContext(context);
  if (json)
    return printableJson(Json({{"shaders", std::move(classes)}})
                             .dump(2, ' ', false, Json::error_handler_t::replace)) +
           "\n";
  std::string text;
  for (const Json& c : classes) text += classText(c);
  return text;
}

} // namespace vv
