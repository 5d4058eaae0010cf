// libraries.h: shader libraries that a scene needs against those that this machine has: found by
// bare name in the folders that are configured here, compared by what is in the file. Nothing
// executable travels. One thread's.
#pragma once

#include <map>
#include <span>
#include <string>

#include "backend/cluster/net/messages.h"

namespace openrt {
class ShaderRegistry;
}

namespace openrt::cluster {

// What is in files: read again only when one has changed.
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
  // Empty, or which of them are missing or different, for people.
  std::string problem(std::span<const message::Library> wanted);

 private:
  const ShaderRegistry* shaders_;
  FileHashes files_;
};

} // namespace openrt::cluster
