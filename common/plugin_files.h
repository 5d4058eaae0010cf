// plugin_files.h: where plug-ins may come from, and what may be believed of their files: configured folders only, bare names
// only, no folder that others may write to. Used by whoever loads plug-ins: shaders (libopenrt), script engines (libxvrml).
// Stateless; any thread.
#pragma once

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include <dlfcn.h>
#include <link.h>
#include <sys/stat.h>
#include <unistd.h>

namespace plugin_files {

namespace fs = std::filesystem;

// "libX.so", "X.so", "libX" and "X" all name X. Throws std::runtime_error for anything that is or could be a path; what: kind of
// library, for the message.
inline std::string bareName(std::string_view name, const char* what) {
  constexpr size_t maxLength = 200;
  const bool plain = !name.empty() && name.size() <= maxLength && name.front() != '.' &&
                     name.find_first_of(std::string_view("/\\\0", 3)) == name.npos && name.find("..") == name.npos;
  if (!plain) {
    const std::string_view shown = name.substr(0, std::min(maxLength, name.find('\0')));
    throw std::runtime_error(std::string(what) + " \"" + std::string(shown) + "\": only a bare name is allowed, no path");
  }
  if (name.ends_with(".so")) name.remove_suffix(3);
  if (name.starts_with("lib") && name.size() > 3) name.remove_prefix(3);
  return std::string(name);
}

// A folder that anybody may write to, or that belongs to another user, could hold anybody's code.
inline bool trusted(const std::string& folder) {
  struct stat info {};
  if (stat(folder.c_str(), &info) != 0 || !S_ISDIR(info.st_mode)) return false;
  const uid_t user = geteuid();
  return (info.st_mode & S_IWOTH) == 0 && (user == 0 || info.st_uid == user || info.st_uid == 0);
}

// Size of the object that an exported symbol names; 0 if it is not known.
inline size_t exportedBytes(void* symbol) {
  Dl_info info{};
  ElfW(Sym)* entry = nullptr;
  if (dladdr1(symbol, &info, reinterpret_cast<void**>(&entry), RTLD_DL_SYMENT) == 0 || !entry || info.dli_saddr != symbol)
    return 0;
  return entry->st_size;
}

// The file of a library in a folder, with or without the prefix lib; empty if it is not there.
inline std::string file(const std::string& folder, const std::string& bareName) {
  for (const char* prefix : {"", "lib"}) {
    const fs::path candidate = fs::path(folder) / (prefix + bareName + ".so");
    std::error_code ignored;
    if (fs::is_regular_file(candidate, ignored)) return candidate.string();
  }
  return {};
}

inline void appendList(std::vector<std::string>& folders, std::string_view list) {
  while (!list.empty()) {
    const size_t end = std::min(list.find(':'), list.size());
    if (end > 0) folders.emplace_back(list.substr(0, end));
    list.remove_prefix(std::min(end + 1, list.size()));
  }
}

// Folders of a process, in the order in which they are searched: configured ones (colon-separated), those of an environment
// variable, and ../lib/SUBFOLDER or SUBFOLDER beside the library that holds the object `here` and beside the program.
inline std::vector<std::string> folders(std::string_view configured, const char* environmentVariable, const char* subfolder,
                                        const void* here) {
  std::vector<std::string> result;
  appendList(result, configured);
  if (const char* environment = secure_getenv(environmentVariable)) appendList(result, environment);
  std::vector<fs::path> own;
  std::error_code error;
  Dl_info info{};
  if (dladdr(here, &info) != 0 && info.dli_fname && std::string_view(info.dli_fname).find('/') != std::string_view::npos) {
    const fs::path library = fs::canonical(info.dli_fname, error);
    if (!error) own.push_back(library.parent_path());
  }
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  if (!error) own.push_back(program.parent_path());
  for (const fs::path& place : own)
    for (const fs::path& candidate : {place / "../lib" / subfolder, place / subfolder}) {
      const fs::path folder = fs::canonical(candidate, error);
      if (!error && std::find(result.begin(), result.end(), folder.string()) == result.end()) result.push_back(folder.string());
    }
  return result;
}

// The folders for a message, with those that are refused.
inline std::string listed(const std::vector<std::string>& folders) {
  std::string text;
  for (const std::string& folder : folders) {
    std::error_code ignored;
    const bool refused = fs::is_directory(folder, ignored) && !trusted(folder);
    text += (text.empty() ? "" : ", ") + folder + (refused ? " (refused: others may write to it)" : "");
  }
  return text.empty() ? "no folder is configured" : text;
}

} // namespace plugin_files
