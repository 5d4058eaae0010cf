// plugin_files.h: Finds the files of plug-ins and decides which ones to trust. Plug-ins come from
// configured folders, are given by bare names, and must not be owned, writable or replaceable by
// another user. Used by the loaders of shaders (libopenrt) and script engines (libxvrml).
// Stateless; any thread.
#pragma once

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include <dlfcn.h>
#include <grp.h>
#include <pwd.h>
#include <sys/stat.h>
#include <unistd.h>

#include "system/files.h"
#include "system/libraries.h"

namespace plugin_files {

namespace fs = std::filesystem;

// Converts "libX.so", "X.so", "libX" and "X" to X. Throws std::runtime_error for anything that is
// or could be a path. what: kind of library, for the message.
inline std::string bareName(std::string_view name, const char* what) {
  constexpr size_t maxLength = 200;
  const bool plain = !name.empty() && name.size() <= maxLength && name.front() != '.' &&
                     name.find_first_of(std::string_view("/\\\0", 3)) == name.npos &&
                     name.find("..") == name.npos;
  if (!plain) {
    const std::string_view shown = name.substr(0, std::min(maxLength, name.find('\0')));
    throw std::runtime_error(std::string(what) + " \"" + std::string(shown) +
                             "\": only a bare name is allowed, no path");
  }
  if (name.ends_with(".so")) name.remove_suffix(3);
  if (name.starts_with("lib") && name.size() > 3) name.remove_prefix(3);
  return std::string(name);
}

// Returns whether the owner is the only member of a group: with umask 002, every user has a group
// of the same name. If a container does not know the user who owns a folder of the host, equal user
// and group numbers count as private.
inline bool isPrivateGroup(uid_t owner, gid_t group) {
  std::vector<char> userText(1 << 14), groupText(1 << 16);
  passwd user{}, *foundUser = nullptr;
  ::group members{}, *foundGroup = nullptr;
  getpwuid_r(owner, &user, userText.data(), userText.size(), &foundUser);
  // the group has too many members
  if (getgrgid_r(group, &members, groupText.data(), groupText.size(), &foundGroup) != 0)
    return false;
  if (!foundUser || !foundGroup) return !foundUser && !foundGroup && owner == group;
  if (std::strcmp(user.pw_name, members.gr_name) != 0) return false;
  for (char** name = members.gr_mem; name && *name; ++name)
    if (std::strcmp(*name, user.pw_name) != 0) return false;
  return true;
}

// Returns the owner of the library that contains this function, and the folders above it. A user
// who can replace one of them can replace the library itself, and needs no plug-in for that.
struct ThisLibrary {
  uid_t owner = 0;
  std::set<std::string> folders;
};
inline ThisLibrary thisLibrary() {
  static const char here = 0;
  ThisLibrary result;
  std::error_code error;
  Dl_info info{};
  if (dladdr(&here, &info) == 0 || !info.dli_fname) return result;
  const fs::path file = fs::canonical(info.dli_fname, error);
  struct stat state {};
  if (error || stat(file.c_str(), &state) != 0) return result;
  result.owner = state.st_uid;
  for (fs::path place = file.parent_path(); place.has_relative_path(); place = place.parent_path())
    result.folders.insert(place.string());
  return result;
}

// Returns why another user could have written the code in a file or folder; empty if nobody could.
//
// * The file and all folders above it must belong to root, to the user who runs the program, or to
//   the owner
// of this library.
// * No other user or group may write to them. A group whose only member is the owner is permitted.
// * Folders above may have the sticky bit, like /tmp, where only an entry's owner can replace it.
// * The folders of this library itself are not checked.
//
// Links are followed first.
inline std::string objection(const std::string& fileOrFolder) {
  std::error_code error;
  const fs::path place = fs::canonical(fileOrFolder, error);
  if (error) return error.message();
  const ThisLibrary library = thisLibrary();
  for (fs::path at = place;; at = at.parent_path()) {
    const bool itself = at == place;
    if (!itself && library.folders.contains(at.string())) return {};
    struct stat info {};
    if (stat(at.c_str(), &info) != 0) return std::strerror(errno);
    const uid_t owner = info.st_uid;
    if (owner != 0 && owner != geteuid() && owner != library.owner)
      return (itself ? "it" : at.string() + ", above it,") + " belongs to another user";
    const bool open = (info.st_mode & S_IWOTH) ||
                      ((info.st_mode & S_IWGRP) && !isPrivateGroup(info.st_uid, info.st_gid));
    if (open && (itself || !(info.st_mode & S_ISVTX)))
      return "others may write to " + (itself ? std::string("it") : at.string() + ", above it");
    if (!at.has_relative_path()) return {};
  }
}

// Returns whether code may be loaded from a folder.
inline bool trusted(const std::string& folder) {
  std::error_code ignored;
  return fs::is_directory(folder, ignored) && objection(folder).empty();
}

// Throws std::runtime_error for a library that another user could have written. what: kind of
// library, for the message.
inline void checkFile(const std::string& path, const char* what) {
  if (const std::string why = objection(path); !why.empty())
    throw std::runtime_error(
        std::string(what) + " " + path + " is refused: " + why +
        (why.starts_with("others") ? " (chmod go-w takes that right away)" : ""));
}

// Returns the file of a library in a folder, with or without the prefix lib; empty if it does not
// exist.
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

// Returns the folders of this process in search order: configured ones (colon-separated), those of
// an environment variable, then ../lib/SUBFOLDER and SUBFOLDER beside the library that contains the
// object `here`, and beside the program.
inline std::vector<std::string> folders(std::string_view configured,
                                        const char* environmentVariable, const char* subfolder,
                                        const void* here) {
  std::vector<std::string> result;
  appendList(result, configured);
  if (const char* environment = os::trustedEnvironment(environmentVariable))
    appendList(result, environment);
  std::vector<fs::path> own;
  std::error_code error;
  Dl_info info{};
  if (dladdr(here, &info) != 0 && info.dli_fname &&
      std::string_view(info.dli_fname).find('/') != std::string_view::npos) {
    const fs::path library = fs::canonical(info.dli_fname, error);
    if (!error) own.push_back(library.parent_path());
  }
  const fs::path program = os::programFile(error);
  if (!error) own.push_back(program.parent_path());
  for (const fs::path& place : own)
    for (const fs::path& candidate : {place / "../lib" / subfolder, place / subfolder}) {
      const fs::path folder = fs::canonical(candidate, error);
      if (!error && std::find(result.begin(), result.end(), folder.string()) == result.end())
        result.push_back(folder.string());
    }
  return result;
}

// Formats the folders for a message and marks the refused ones.
inline std::string listed(const std::vector<std::string>& folders) {
  std::string text;
  for (const std::string& folder : folders) {
    std::error_code ignored;
    const std::string why = fs::is_directory(folder, ignored) ? objection(folder) : std::string();
    text += (text.empty() ? "" : ", ") + folder + (why.empty() ? "" : " (refused: " + why + ")");
  }
  return text.empty() ? "no folder is configured" : text;
}

} // namespace plugin_files
