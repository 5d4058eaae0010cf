// registry.cpp: finds shader libraries by bare name in the configured folders and loads them
// (library.h). Called by the API on the application's thread and by backends on theirs, under one
// lock.
#include "shading/registry.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include "folder_files.h"
#include "lower_case.h"
#include "nearest.h"
#include "plugin_files.h"
#include "shading/library.h"

namespace openrt {

struct ShaderRegistry::Library : ShaderLibrary {
  using ShaderLibrary::ShaderLibrary;
};

ShaderRegistry::ShaderRegistry(std::vector<std::string> folders) : folders_(std::move(folders)) {}
ShaderRegistry::~ShaderRegistry() = default;

const ShaderRegistry::Library* ShaderRegistry::load(const std::string& bareName) const {
  for (const auto& library : libraries_)
    if (library->name == bareName) return library.get();
  const std::string file = fileOf(bareName);
  if (file.empty()) return nullptr;
  libraries_.push_back(std::make_unique<Library>(bareName, file));
  return libraries_.back().get();
}

std::string ShaderRegistry::fileOf(const std::string& bareName) const {
  for (const std::string& folder : folders_) {
    std::string file =
        plugin_files::trusted(folder) ? plugin_files::file(folder, bareName) : std::string();
    if (!file.empty()) return file;
  }
  return {};
}

int ShaderRegistry::reload(std::vector<std::string>& problems) {
  const std::lock_guard lock(mutex_);
  int count = 0;
  for (auto& library : libraries_) {
    const std::string file = fileOf(library->name);
    if (!file.empty() && FileStamp::of(file) == library->stamp) continue;
    try {
      if (file.empty())
        throw std::runtime_error("shader library " + library->path + ": its file is gone");
      auto fresh = std::make_unique<Library>(library->name, file, *library, ++reloads_);
      replaced_.push_back(nullptr);
      replaced_.back() = std::exchange(library, std::move(fresh));
      count++;
    } catch (const std::runtime_error& e) { problems.emplace_back(e.what()); }
  }
  return count;
}

std::vector<std::string> ShaderRegistry::files() const {
  const std::lock_guard lock(mutex_);
  std::vector<std::string> result;
  for (const auto& library : libraries_) result.push_back(library->path);
  return result;
}

std::string ShaderRegistry::searched() const { return plugin_files::listed(folders_); }

const RtsClass& ShaderRegistry::find(std::string_view name, std::string_view library) const {
  const std::lock_guard lock(mutex_);
  const Library* from = nullptr;
  return find(name, library, from);
}

std::string ShaderRegistry::libraryOf(std::string_view name, std::string_view library) const {
  const std::lock_guard lock(mutex_);
  const Library* from = nullptr;
  find(name, library, from);
  return from->name;
}

std::string ShaderRegistry::locate(std::string_view bareName) const {
  const std::lock_guard lock(mutex_);
  for (const auto& library : libraries_)
    if (library->name == bareName) return library->path;
  try {
    return fileOf(plugin_files::bareName(bareName, "shader library"));
  } catch (const std::runtime_error&) { return {}; }
}

const RtsClass* ShaderRegistry::loaded(std::string_view name, std::string_view bareName) const {
  const std::lock_guard lock(mutex_);
  for (const auto& library : libraries_)
    if (library->name == bareName) return library->find(name);
  return nullptr;
}

// Only the names of files are compared, and the nearest library is loaded for the spelling of its
// class.
std::string ShaderRegistry::nearestClass(std::string_view name, const Library* stock) const {
  std::vector<std::string> known;
  if (stock)
    for (const auto& c : stock->classes) known.emplace_back(c->name);
  if (const std::string* near = nearest::find(name, known, nearest::written(name))) return *near;
  try {
    known.clear();
    for (const std::string& folder : folders_)
      if (plugin_files::trusted(folder))
        for (const std::string& file : filesOfFolder(folder, ".so"))
          known.push_back(plugin_files::bareName(std::filesystem::path(file).filename().string(),
                                                 "shader library"));
    const std::string typed = lowerCase(name);
    const std::string* near = nearest::find(typed, known, nearest::written(typed));
    const Library* library = near ? load(*near) : nullptr;
    if (library)
      for (const auto& c : library->classes)
        if (lowerCase(c->name) == *near) return std::string(c->name);
  } catch (const std::runtime_error&) {} // a library that cannot be loaded is not suggested
  return {};
}

const RtsClass& ShaderRegistry::find(std::string_view name, std::string_view library,
                                     const Library*& from) const {
  if (!library.empty()) {
    const Library* found = from = load(plugin_files::bareName(library, "shader library"));
    if (!found)
      throw std::runtime_error("shader library \"" + std::string(library) +
                               "\" not found in: " + searched());
    if (const RtsClass* shaderClass = found->find(name)) return *shaderClass;
    std::string has;
    for (const auto& c : found->classes) has += (has.empty() ? "" : ", ") + std::string(c->name);
    throw std::runtime_error("shader library " + found->path + " has no class \"" +
                             std::string(name) + "\"; it has: " + has);
  }
  const std::string own = lowerCase(name);
  const bool plain = !own.empty() && std::all_of(own.begin(), own.end(), [](unsigned char c) {
    return std::isalnum(c) || c == '_';
  });
  from = plain ? load(own) : nullptr;
  if (from)
    if (const RtsClass* shaderClass = from->find(name)) return *shaderClass;
  const Library* stock = from = load("vrml97");
  if (stock)
    if (const RtsClass* shaderClass = stock->find(name)) return *shaderClass;
  const std::string near = nearestClass(name, stock);
  throw std::runtime_error("there is no shader class \"" + std::string(name) + "\"" +
                           (near.empty() ? "" : "; did you mean " + near + "?") +
                           (stock ? "" : " (the stock library vrml97 is missing)") +
                           (near.empty() ? "; looked in: " + searched() : ""));
}

std::vector<std::string> shaderFolders(std::string_view configured) {
  static const char here = 0;
  return plugin_files::folders(configured, "OPENRT_SHADER_PATH", "openrt/shaders", &here);
}

} // namespace openrt
