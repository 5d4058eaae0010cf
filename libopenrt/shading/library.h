// library.h: one loaded shader library: its handle, its classes as the host sees them, and how its
// tables follow from those of the file that it replaces. Made and owned by the registry under its
// lock; its classes are read by any thread.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <sys/types.h>

#include "shading/running.h"

namespace openrt {

// What tells a file from another one in its place.
struct FileStamp {
  dev_t device = 0;
  ino_t node = 0;
  off_t size = 0;
  int64_t seconds = 0, nanoseconds = 0; // of its last change
  bool operator==(const FileStamp&) const = default;
  static FileStamp of(const std::string& path); // all 0 where there is none
};

struct ShaderLibrary {
  std::string name, path;
  FileStamp stamp;
  void* handle = nullptr;
  // Each lives as long as the library: references into them stay valid.
  std::vector<std::unique_ptr<LoadedClass>> classes;

  ShaderLibrary(std::string bareName, std::string file);
  // In place of another one: from a private copy of the file, because the loader knows files by
  // name and number.
  ShaderLibrary(std::string bareName, std::string file, const ShaderLibrary& before,
                uint32_t number);
  ~ShaderLibrary();
  ShaderLibrary(const ShaderLibrary&) = delete;
  ShaderLibrary& operator=(const ShaderLibrary&) = delete;

  // Null: it has none of this name. One that was found must be there, of the same kind, in whatever
  // replaces the library.
  const RtsClass* find(std::string_view className) const;

 private:
  void open(const std::string& file);
  void readClasses();
};

} // namespace openrt
