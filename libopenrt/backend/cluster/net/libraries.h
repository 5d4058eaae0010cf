// libraries.h: checks the shader libraries that a scene needs against those of this machine.
// Libraries are found by bare name in the configured folders and compared by file hash. No
// executable code is sent. One thread.
#pragma once

#include <map>
#include <span>
#include <string>

#include "backend/cluster/messages/messages.h"

namespace openrt {
class ShaderRegistry;
}

namespace openrt::cluster {

// Content hashes of files. A file is read again only after it has changed.
class FileHashes {
 public:
  const Hash& of(const std::string& path);

 private:
  struct Known {
    int64_t changed = 0;
    uint64_t bytes = 0;
    Hash hash;
  };
  std::map<std::string, Known> files_;
};

class LibraryCheck {
 public:
  explicit LibraryCheck(const ShaderRegistry* shaders) : shaders_(shaders) {}
  // Returns which libraries are missing or different, as a message for the user; empty if none.
  std::string problem(std::span<const message::Library> wanted);

 private:
  const ShaderRegistry* shaders_;
  FileHashes files_;
};

} // namespace openrt::cluster
