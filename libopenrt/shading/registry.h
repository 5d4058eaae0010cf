// registry.h: shader classes by name and library. Loads plug-ins (dlopen) from the configured folders only, checks their
// ABI, and keeps them loaded for the life of the registry. Used by the front end (parameter tables) and by the local backend
// (functions). Thread-safe after construction for lookups of classes already loaded.
#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "openrt/openrts.h"

namespace openrt {

class ShaderRegistry {
 public:
  // folders: in the order they are searched.
  explicit ShaderRegistry(std::vector<std::string> folders);
  ~ShaderRegistry();
  ShaderRegistry(const ShaderRegistry&) = delete;
  ShaderRegistry& operator=(const ShaderRegistry&) = delete;

  // library "" means a stock class: the folders' plug-in that bears the class's name in lower case, or the stock plug-in
  // `vrml97`, which also brings the stock lights, cameras and environments. Throws std::runtime_error: what was looked for and
  // where.
  const RtsClass& find(std::string_view name, std::string_view library) const;

 private:
  struct Library;
  const Library* load(const std::string& bareName) const; // null: in no folder
  std::string searched() const;                           // the folders, for messages
  std::vector<std::string> folders_;
  mutable std::mutex mutex_;
  mutable std::vector<std::unique_ptr<Library>> libraries_;
};

// Folders of a process: configured ones (colon-separated), $OPENRT_SHADER_PATH, the folder beside the library
// (../lib/openrt/shaders).
std::vector<std::string> shaderFolders(std::string_view configured);

} // namespace openrt
