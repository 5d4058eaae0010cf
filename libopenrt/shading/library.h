// library.h: one loaded shader library: its handle and its classes as the host sees them. If it
// replaces an older file, its parameter tables keep the older handles. Created and owned by the
// registry, under its lock; any thread may read the classes.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <sys/types.h>

#include "shading/running.h"

namespace openrt {

// Identifies one version of a file, to detect that it was replaced.
struct FileStamp {
  dev_t device = 0;
  ino_t node = 0;
  off_t size = 0;
  int64_t seconds = 0, nanoseconds = 0; // time of the last change
  bool operator==(const FileStamp&) const = default;
  static FileStamp of(const std::string& path); // returns zeros if there is no file
};

struct ShaderLibrary {
  std::string name, path;
  FileStamp stamp;
  void* handle = nullptr;
  // Each class lives as long as the library, so references to it stay valid.
  std::vector<std::unique_ptr<LoadedClass>> classes;

  ShaderLibrary(std::string bareName, std::string file);
  // Replaces another library. Loads a private copy of the file, because the dynamic loader
  // identifies files by name and inode.
  ShaderLibrary(std::string bareName, std::string file, const ShaderLibrary& before,
                uint32_t number);
  ~ShaderLibrary();
  ShaderLibrary(const ShaderLibrary&) = delete;
  ShaderLibrary& operator=(const ShaderLibrary&) = delete;

  // Returns the class of this name, or null. A class that was returned once must exist, with the
  // same kind, in every replacement of the library.
  const RtsClass* find(std::string_view className) const;

 private:
  void open(const std::string& file);
  void readClasses();
};

} // namespace openrt
