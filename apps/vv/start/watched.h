// watched.h: Polls files for changes, for --watch. Modification times, sizes and inode numbers are
// compared five times a second, which also detects editors that replace a file, and works on
// network file systems. [main thread]
#pragma once

#include <ctime>
#include <map>
#include <string>
#include <vector>

#include "xvrml/world.h"

namespace vv {

// Returns the files of a world, existing or not: its own, Inlines, prototypes, pictures, sounds,
// scripts.
std::vector<std::string> usedFiles(const xvrml::World& world);

// Returns the shader libraries in the folders of --shader-path and $OPENRT_SHADER_PATH
// (colon-separated).
std::vector<std::string> shaderFiles(const std::string& shaderPath);

class Watched {
 public:
  explicit Watched(const std::vector<std::string>& files) { add(files, now()); }
  // Returns the time of the clock that stamps files.
  static timespec now();
  // read: the earliest time at which the files may have been read. A file written later counts as
  // changed, because the reader may have seen any part of it.
  void add(const std::vector<std::string>& files, timespec read);
  // Returns true once, after a file has changed and no file has changed since the previous call.
  // Call it about five times a second.
  bool changed();
  // Waits until a file has changed and all files have been unchanged for a moment. Returns false if
  // `ended` returns true.
  bool waitForChange(bool (*ended)());

 private:
  struct Stamp {
    long long seconds = -1, nanoseconds = 0, size = 0; // seconds -1: the file does not exist
    unsigned long long number = 0;
    bool operator==(const Stamp&) const = default;
  };
  static Stamp stampOf(const std::string& path);
  bool update(); // returns true if a stamp has changed
  std::map<std::string, Stamp> files_;
  bool pending_ = false; // a change was detected and not yet reported
};

} // namespace vv
