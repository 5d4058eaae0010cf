// watched.h: files that are looked at again and again, for --watch. Their times, sizes and numbers
// are compared five times a second: that also sees editors that replace a file, and folders of
// other machines. [main thread]
#pragma once

#include <ctime>
#include <map>
#include <string>
#include <vector>

#include "xvrml/world.h"

namespace vv {

// The files that a world was made of, and those that it names in vain: its own, Inlines,
// prototypes, pictures, sounds, scripts.
std::vector<std::string> usedFiles(const xvrml::World& world);

// Shader libraries in the folders that were asked for: of --shader-path and $OPENRT_SHADER_PATH
// (colon-separated).
std::vector<std::string> shaderFiles(const std::string& shaderPath);

class Watched {
 public:
  explicit Watched(const std::vector<std::string>& files) { add(files, now()); }
  // The clock of files' times.
  static timespec now();
  // read: when files may have been read first. One that was written since counts as changed: nobody
  // knows what of it was read.
  void add(const std::vector<std::string>& files, timespec read);
  // True once a file has changed and all have been at rest since the last call; to be called about
  // five times a second.
  bool changed();
  // Comes back when a file has changed and all have been at rest for a moment. False if `ended`
  // said so.
  bool waitForChange(bool (*ended)());

 private:
  struct Stamp {
    long long seconds = -1, nanoseconds = 0, size = 0; // seconds -1: no such file
    unsigned long long number = 0;
    bool operator==(const Stamp&) const = default;
  };
  static Stamp stampOf(const std::string& path);
  bool update(); // true if a stamp is another one
  std::map<std::string, Stamp> files_;
  bool pending_ = false; // a change has been seen
};

} // namespace vv
