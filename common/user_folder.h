// user_folder.h: Finds the folders of a user for data and state (XDG Base Directory Specification).
// Stateless; any thread.
#pragma once

#include <cstdlib>
#include <filesystem>

// Returns the folder that a variable of the environment names, or else `usual` in the user's home
// folder; empty if there is neither. Relative folders are ignored, as the specification says.
inline std::filesystem::path userFolder(const char* variable, const char* usual) {
  const auto folder = [](const char* name) {
    const char* const value = std::getenv(name);
    return value && *value == '/' ? std::filesystem::path(value) : std::filesystem::path();
  };
  if (std::filesystem::path given = folder(variable); !given.empty()) return given;
  const std::filesystem::path home = folder("HOME");
  return home.empty() ? home : home / usual;
}
