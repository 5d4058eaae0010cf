// registry.cpp: finds shader libraries by bare name in the configured folders, loads them and keeps them loaded.
// Called by the front end on the application's thread and by backends on theirs; one lock.
#include "shading/registry.h"

#include <algorithm>
#include <cctype>
#include <stdexcept>

#include <dlfcn.h>

#include "plugin_files.h"
#include "shading/plugin_check.h"

namespace openrt {

struct ShaderRegistry::Library {
  std::string name, path;
  void* handle = nullptr;
  std::vector<RtsClass> classes; // never grows after construction: references into it stay valid

  Library(std::string bareName, std::string file);
  ~Library() { dlclose(handle); }
  Library(const Library&) = delete;
  Library& operator=(const Library&) = delete;

  const RtsClass* find(std::string_view className) const {
    for (const RtsClass& c : classes)
      if (className == c.name) return &c;
    return nullptr;
  }
};

namespace {

std::string lowerCase(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return result;
}

} // namespace

ShaderRegistry::Library::Library(std::string bareName, std::string file) : name(std::move(bareName)), path(std::move(file)) {
  handle = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (!handle) {
    const char* reason = dlerror();
    throw std::runtime_error("shader library " + path + ": " + (reason ? reason : "cannot be loaded"));
  }
  try {
    void* symbol = dlsym(handle, RTS_ENTRY_NAME);
    if (!symbol)
      throw std::runtime_error("shader library " + path + ": exports no " RTS_ENTRY_NAME ", so it is no shader plug-in");
    classes = checkPlugin(static_cast<const RtsPlugin*>(symbol), plugin_files::exportedBytes(symbol), path);
  } catch (...) {
    dlclose(handle);
    throw;
  }
}

ShaderRegistry::ShaderRegistry(std::vector<std::string> folders) : folders_(std::move(folders)) {}
ShaderRegistry::~ShaderRegistry() = default;

const ShaderRegistry::Library* ShaderRegistry::load(const std::string& bareName) const {
  for (const auto& library : libraries_)
    if (library->name == bareName) return library.get();
  for (const std::string& folder : folders_) {
    const std::string file = plugin_files::trusted(folder) ? plugin_files::file(folder, bareName) : std::string();
    if (file.empty()) continue;
    libraries_.push_back(std::make_unique<Library>(bareName, file));
    return libraries_.back().get();
  }
  return nullptr;
}

std::string ShaderRegistry::searched() const { return plugin_files::listed(folders_); }

const RtsClass& ShaderRegistry::find(std::string_view name, std::string_view library) const {
  const std::lock_guard lock(mutex_);
  if (!library.empty()) {
    const Library* found = load(plugin_files::bareName(library, "shader library"));
    if (!found) throw std::runtime_error("shader library \"" + std::string(library) + "\" not found in: " + searched());
    if (const RtsClass* shaderClass = found->find(name)) return *shaderClass;
    std::string has;
    for (const RtsClass& c : found->classes) has += (has.empty() ? "" : ", ") + std::string(c.name);
    throw std::runtime_error("shader library " + found->path + " has no class \"" + std::string(name) + "\"; it has: " + has);
  }
  const std::string own = lowerCase(name);
  const bool plain =
      !own.empty() && std::all_of(own.begin(), own.end(), [](unsigned char c) { return std::isalnum(c) || c == '_'; });
  const Library* ownLibrary = plain ? load(own) : nullptr;
  if (ownLibrary)
    if (const RtsClass* shaderClass = ownLibrary->find(name)) return *shaderClass;
  const Library* stock = load("vrml97");
  if (stock)
    if (const RtsClass* shaderClass = stock->find(name)) return *shaderClass;
  throw std::runtime_error("no stock shader class \"" + std::string(name) + "\"" +
                           (stock ? "" : " (the stock library vrml97 is missing)") + "; looked in: " + searched());
}

std::vector<std::string> shaderFolders(std::string_view configured) {
  static const char here = 0;
  return plugin_files::folders(configured, "OPENRT_SHADER_PATH", "openrt/shaders", &here);
}

} // namespace openrt
