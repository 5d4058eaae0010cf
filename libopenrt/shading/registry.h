// registry.h: finds shader classes by name and library. It loads plug-ins (dlopen) only from the
// configured folders and checks their ABI. Libraries stay loaded for the life of the registry, even
// if a newer file has replaced them: frames in flight and uncommitted scenes still use the old
// functions. Used by the API (parameter tables) and the local backend (functions), from any thread;
// a lock guards the tables.
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
  // Creates a registry that searches `folders` in this order.
  explicit ShaderRegistry(std::vector<std::string> folders);
  ~ShaderRegistry();
  ShaderRegistry(const ShaderRegistry&) = delete;
  ShaderRegistry& operator=(const ShaderRegistry&) = delete;

  // Returns a class. An empty library means a stock class: it is looked up in the plug-in whose
  // name is the class's name in lower case, then in the stock plug-in `vrml97`, which also contains
  // the stock lights, cameras and environments. Throws std::runtime_error that says what was looked
  // for and where.
  const RtsClass& find(std::string_view name, std::string_view library) const;

  // Reloads the libraries whose files have changed and returns their number; find() then returns
  // the new tables. A library that fails to load stays as it was and adds a line to `problems`.
  // Parameter handles stay valid:
  //   a parameter with the same name and type keeps its index
  //   new parameters are appended
  //   a removed parameter stays in the table without a name; its value is stored behind the
  //     plug-in's struct
  int reload(std::vector<std::string>& problems);
  // Returns the files of the loaded libraries.
  std::vector<std::string> files() const;
  // Returns the bare name of the library in which find() finds the class; throws like find().
  std::string libraryOf(std::string_view name, std::string_view library) const;
  // Returns the file that a library of this bare name was or would be loaded from; empty if there
  // is none or if the name is not a bare name.
  std::string locate(std::string_view bareName) const;
  // Returns a class of a library that is already loaded, or null.
  const RtsClass* loaded(std::string_view name, std::string_view bareName) const;

 private:
  struct Library;
  const Library* load(const std::string& bareName) const; // returns null if it is in no folder
  const RtsClass& find(std::string_view name, std::string_view library, const Library*& from) const;
  // Returns the class that a mistyped name probably means; "" if none is near.
  std::string nearestClass(std::string_view name, const Library* stock) const;
  std::string searched() const;                          // returns the folders, for messages
  std::string fileOf(const std::string& bareName) const; // returns "" if it is in no folder
  std::vector<std::string> folders_;
  mutable std::mutex mutex_;
  mutable std::vector<std::unique_ptr<Library>> libraries_;
  std::vector<std::unique_ptr<Library>> replaced_;
  uint32_t reloads_ = 0; // number for the names of private copies
};

// Returns the folders to search: the configured ones (colon-separated), those of
// $OPENRT_SHADER_PATH, and the folder beside the library (../lib/openrt/shaders).
std::vector<std::string> shaderFolders(std::string_view configured);

} // namespace openrt
