// libraries.h: shader libraries that a scene needs against those that this machine has: found by bare name in the folders that
// are configured here, compared by what is in the file. Nothing executable travels. One thread's.
#pragma once

#include <map>
#include <span>
#include <string>

#include "backend/cluster/messages.h"

namespace openrt {
class ShaderRegistry;
}

namespace openrt::cluster {

class LibraryCheck {
 public:
  explicit LibraryCheck(const ShaderRegistry* shaders) : shaders_(shaders) {}
  // Empty, or which of them are missing or different, for people.
  std::string problem(std::span<const message::Library> wanted);

 private:
  struct Known {
    int64_t changed = 0;
    uint64_t bytes = 0;
    Hash hash;
  };
  const ShaderRegistry* shaders_;
  std::map<std::string, Known> files_;
};

} // namespace openrt::cluster
