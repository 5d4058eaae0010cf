// registry.h: shader classes by name and library. Loads plug-ins (dlopen) from the configured
// folders only, checks their ABI, and keeps them loaded for the life of the registry, also those
// that a newer file has replaced: frames in flight, and scenes that have not been committed since,
// go on with the former functions. Used by the front end (parameter tables) and by the local
// backend (functions). Thread-safe after construction for lookups of classes already loaded.
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

  // library "" means a stock class: the folders' plug-in that bears the class's name in lower case,
  // or the stock plug-in `vrml97`, which also brings the stock lights, cameras and environments.
  // Throws std::runtime_error: what was looked for and where.
  const RtsClass& find(std::string_view name, std::string_view library) const;

  // Loads the libraries anew whose files are not those that were loaded; find() then answers with
  // the new tables. Handles stay: a parameter keeps its index as long as its name and type are
  // declared, new ones come behind; one that is gone stays in the table without a name, behind what
  // the plug-in knows of the structure. Returns how many; the others stay as they were, with a line
  // in `problems` each.
  int reload(std::vector<std::string>& problems);
  // Files of the libraries in use, as they are found now.
  std::vector<std::string> files() const;
  // Bare name of the library that find() answers from; throws as it does.
  std::string libraryOf(std::string_view name, std::string_view library) const;
  // The file that a library of this bare name was loaded from, or would be; empty: there is none,
  // or this is no bare name.
  std::string locate(std::string_view bareName) const;
  // A class of a library that is loaded already; null: none.
  const RtsClass* loaded(std::string_view name, std::string_view bareName) const;

 private:
  struct Library;
  const Library* load(const std::string& bareName) const; // null: in no folder
  const RtsClass& find(std::string_view name, std::string_view library, const Library*& from) const;
  std::string searched() const;                          // the folders, for messages
  std::string fileOf(const std::string& bareName) const; // empty: in no folder
  std::vector<std::string> folders_;
  mutable std::mutex mutex_;
  mutable std::vector<std::unique_ptr<Library>> libraries_;
  std::vector<std::unique_ptr<Library>> replaced_;
  uint32_t reloads_ = 0; // names the private copies
};

// Folders of a process: configured ones (colon-separated), $OPENRT_SHADER_PATH, the folder beside
// the library
// (../lib/openrt/shaders).
std::vector<std::string> shaderFolders(std::string_view configured);

} // namespace openrt
