// engines.h: which script engine serves a protocol: looks through the configured folders, loads
// plug-ins (dlopen), checks their ABI. Loaded libraries stay for the life of the process. One
// object per world, on the browser's thread; libraries are shared.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "xvrml/xscript.h"

namespace xvrml {

class ScriptEngines {
 public:
  // folders: in the order they are searched.
  explicit ScriptEngines(std::vector<std::string> folders) : folders_(std::move(folders)) {}

  // The first engine that serves a URL scheme ("javascript"), a MIME type or a file suffix (".js"),
  // all in lower case; null if there is none. A library that bears the scheme's name is tried
  // before all others.
  const XsEngine* byScheme(std::string_view scheme);
  const XsEngine* byMimeType(std::string_view type);
  const XsEngine* bySuffix(std::string_view suffix);

  // All engines of all folders, in the order in which they are looked at.
  std::vector<const XsEngine*> all();

  // Why libraries were refused since the last call, each once.
  std::vector<std::string> takeRefusals() { return std::exchange(refusals_, {}); }
  std::string searched() const; // the folders, for messages

 private:
  using Names = const char* const* XsEngine::*;
  const XsEngine* find(Names names, std::string_view wanted, std::string_view libraryName);
  void loadNamed(std::string_view name);
  void loadAll();
  void load(const std::string& path);

  std::vector<std::string> folders_, tried_, refusals_;
  std::vector<const std::vector<XsEngine>*> loaded_; // in the order of loading
  bool all_ = false;                                 // every library of the folders has been tried
};

// The file that an engine found by these functions has come from; "" if it was not.
std::string libraryOf(const XsEngine& engine);

// Folders of a process: configured ones (colon-separated), $XVRML_SCRIPT_PATH, the folder beside
// the library
// (../lib/xvrml/scripts).
std::vector<std::string> scriptFolders(std::string_view configured);

} // namespace xvrml
