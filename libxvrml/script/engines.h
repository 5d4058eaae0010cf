// engines.h: finds the script engine for a protocol: searches the configured folders, loads
// plug-ins (dlopen) and checks their ABI. Loaded libraries stay for the lifetime of the process.
// One object per world, on the browser's thread; the libraries are shared.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "xvrml/xscript.h"

namespace xvrml {

class ScriptEngines {
 public:
  // folders: in search order.
  explicit ScriptEngines(std::vector<std::string> folders) : folders_(std::move(folders)) {}

  // Return the first engine for a URL scheme ("javascript"), a MIME type or a file suffix (".js"),
  // all in lower case; null if there is none. A library named after the scheme is tried before all
  // others.
  const XsEngine* byScheme(std::string_view scheme);
  const XsEngine* byMimeType(std::string_view type);
  const XsEngine* bySuffix(std::string_view suffix);

  // Returns all engines of all folders, in search order.
  std::vector<const XsEngine*> all();

  // Returns why libraries were refused since the last call, each once.
  std::vector<std::string> takeRefusals() { return std::exchange(refusals_, {}); }
  std::string searched() const; // returns the folders, for messages

 private:
  using Names = const char* const* XsEngine::*;
  const XsEngine* find(Names names, std::string_view wanted, std::string_view libraryName);
  void loadNamed(std::string_view name);
  void loadAll();
  void load(const std::string& path);

  std::vector<std::string> folders_, tried_, refusals_;
  std::vector<const std::vector<XsEngine>*> loaded_; // in loading order
  bool all_ = false;                                 // every library in the folders has been tried
};

// Returns the library file of an engine that these functions have returned; "" for any other
// engine.
std::string libraryOf(const XsEngine& engine);

// Returns the search folders of the process: the configured ones (colon-separated),
// $XVRML_SCRIPT_PATH, and the folder next to the library (../lib/xvrml/scripts).
std::vector<std::string> scriptFolders(std::string_view configured);

} // namespace xvrml
