// registry.cpp: finds shader libraries by bare name in the configured folders, loads them and keeps them loaded.
// Called by the front end on the application's thread and by backends on theirs; one lock.
#include "shading/registry.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <system_error>

#include <dlfcn.h>
#include <link.h>
#include <sys/stat.h>
#include <unistd.h>

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

namespace fs = std::filesystem;

// "libX.so", "X.so", "libX" and "X" all name X.
std::string bareLibraryName(std::string_view name) {
  constexpr size_t maxLength = 200;
  const bool plain = !name.empty() && name.size() <= maxLength && name.front() != '.' &&
                     name.find_first_of(std::string_view("/\\\0", 3)) == name.npos && name.find("..") == name.npos;
  if (!plain) {
    const std::string_view shown = name.substr(0, std::min(maxLength, name.find('\0')));
    throw std::runtime_error("shader library \"" + std::string(shown) + "\": only a bare name is allowed, no path");
  }
  if (name.ends_with(".so")) name.remove_suffix(3);
  if (name.starts_with("lib") && name.size() > 3) name.remove_prefix(3);
  return std::string(name);
}

// A folder that anybody may write to, or that belongs to another user, could hold anybody's code.
bool trusted(const std::string& folder) {
  struct stat info {};
  if (stat(folder.c_str(), &info) != 0 || !S_ISDIR(info.st_mode)) return false;
  const uid_t user = geteuid();
  return (info.st_mode & S_IWOTH) == 0 && (user == 0 || info.st_uid == user || info.st_uid == 0);
}

size_t exportedBytes(void* symbol) {
  Dl_info info{};
  ElfW(Sym)* entry = nullptr;
  if (dladdr1(symbol, &info, reinterpret_cast<void**>(&entry), RTLD_DL_SYMENT) == 0 || !entry || info.dli_saddr != symbol)
    return 0;
  return entry->st_size;
}

std::string lowerCase(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return result;
}

std::string libraryFile(const std::string& folder, const std::string& bareName) {
  for (const char* prefix : {"", "lib"}) {
    const fs::path candidate = fs::path(folder) / (prefix + bareName + ".so");
    std::error_code ignored;
    if (fs::is_regular_file(candidate, ignored)) return candidate.string();
  }
  return {};
}

void appendFolders(std::vector<std::string>& folders, std::string_view list) {
  while (!list.empty()) {
    const size_t end = std::min(list.find(':'), list.size());
    if (end > 0) folders.emplace_back(list.substr(0, end));
    list.remove_prefix(std::min(end + 1, list.size()));
  }
}

// Folder of the program, and of the shared library that holds this code; the same when it is linked statically.
std::vector<fs::path> ownFolders() {
  std::vector<fs::path> folders;
  std::error_code error;
  Dl_info info{};
  static const char here = 0;
  if (dladdr(&here, &info) != 0 && info.dli_fname && std::string_view(info.dli_fname).find('/') != std::string_view::npos) {
    const fs::path file = fs::canonical(info.dli_fname, error);
    if (!error) folders.push_back(file.parent_path());
  }
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  if (!error) folders.push_back(program.parent_path());
  return folders;
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
    classes = checkPlugin(static_cast<const RtsPlugin*>(symbol), exportedBytes(symbol), path);
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
    const std::string file = trusted(folder) ? libraryFile(folder, bareName) : std::string();
    if (file.empty()) continue;
    libraries_.push_back(std::make_unique<Library>(bareName, file));
    return libraries_.back().get();
  }
  return nullptr;
}

std::string ShaderRegistry::searched() const {
  std::string text;
  for (const std::string& folder : folders_) {
    std::error_code ignored;
    const bool refused = fs::is_directory(folder, ignored) && !trusted(folder);
    text += (text.empty() ? "" : ", ") + folder + (refused ? " (refused: others may write to it)" : "");
  }
  return text.empty() ? "no folder is configured" : text;
}

const RtsClass& ShaderRegistry::find(std::string_view name, std::string_view library) const {
  const std::lock_guard lock(mutex_);
  if (!library.empty()) {
    const Library* found = load(bareLibraryName(library));
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
  std::vector<std::string> folders;
  appendFolders(folders, configured);
  if (const char* environment = secure_getenv("OPENRT_SHADER_PATH")) appendFolders(folders, environment);
  for (const fs::path& own : ownFolders())
    for (const fs::path& candidate : {own / "../lib/openrt/shaders", own / "openrt/shaders"}) {
      std::error_code error;
      const fs::path folder = fs::canonical(candidate, error);
      if (!error && std::find(folders.begin(), folders.end(), folder.string()) == folders.end())
        folders.push_back(folder.string());
    }
  return folders;
}

} // namespace openrt
