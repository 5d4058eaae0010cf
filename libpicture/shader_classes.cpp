#include "libpicture/shader_classes.h"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <set>
#include <stdexcept>

#include <dlfcn.h>
#include <fmt/format.h>

#include "folder_files.h"
#include "openrt/openrts.h"
#include "plugin_library.h"
#include "system/libraries.h"

namespace picture {

namespace {

namespace fs = std::filesystem;

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

std::vector<float> defaultOf(const RTparameterInfo& info) {
  size_t count = 1;
  switch (info.type) {
  case RT_PARAM_FLOATS:
  case RT_PARAM_STRING:
  case RT_PARAM_TEXTURE: return {};
  case RT_PARAM_VEC2: count = 2; break;
  case RT_PARAM_VEC3:
  case RT_PARAM_COLOR: count = 3; break;
  case RT_PARAM_VEC4: count = 4; break;
  case RT_PARAM_MATRIX: count = 16; break;
  default: break;
  }
  return {info.defaultValue, info.defaultValue + count};
}

ShaderClass classOf(const RtsClass& c, RTid id, const std::string& library) {
  ShaderClass made{c.name, library, c.text ? c.text : "", 0, {}};
  int count = 0;
  rtGetShaderClass(id, &made.role, &count);
  for (int i = 0; i < count; ++i) {
    RTparameterInfo info{};
    rtGetParameterInfo(id, i, &info);
    made.parameters.push_back({info.name, info.text ? info.text : "", info.type, info.frequency,
                               defaultOf(info), info.minimum, info.maximum});
  }
  return made;
}

// Appends the classes of a library, which stays loaded. Returns the error, or empty.
std::string addLibrary(const File& file, std::vector<ShaderClass>& classes) {
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
    classes.push_back(classOf(*plugin.classes[i], id, file.name));
  }
  return {};
}

} // namespace

std::vector<ShaderClass> installedShaders(const std::string& shaderPath,
                                          std::vector<std::string>& problems) {
  const RTcontext before = rtGetCurrent();
  const std::string config =
      "backend=null" + (shaderPath.empty() ? "" : " shaderpath=\"" + shaderPath + "\"");
  const RTcontext context = rtNewContext(config.c_str());
  if (!context) {
    const std::string why = lastError();
    rtMakeCurrent(before);
    throw std::runtime_error(why);
  }
  std::vector<ShaderClass> classes;
  for (const File& file : libraries(shaderPath))
    if (const std::string why = addLibrary(file, classes); !why.empty())
      problems.push_back(why.find(file.path) == why.npos ? file.path + ": " + why : why);
  rtDeleteContext(context);
  rtMakeCurrent(before);
  return classes;
}

} // namespace picture
