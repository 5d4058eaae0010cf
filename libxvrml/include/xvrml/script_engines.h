// script_engines.h: the script engines (xscript.h) that are installed, and what they serve. [one
// thread at a time]
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace xvrml {

// Returns true if an engine serves the protocol: the scheme of a Script's url ("javascript") or a
// file's suffix (".js"). folders: separated by colons; they come before $XVRML_SCRIPT_PATH and the
// installed ones. Loads engines, and does not report refused ones.
bool hasScriptEngine(std::string_view protocol, std::string_view folders = {});

struct ScriptEngineInfo {
  std::string name, text;                       // "ecmascript"; a description of one line
  std::string library;                          // file that the engine comes from
  std::vector<std::string> schemes;             // "javascript", without the colon
  std::vector<std::string> mimeTypes, suffixes; // ".js"
  bool needsTrust = false; // its programs can do whatever the user can: trusted worlds only
  bool harmless = false;   // its programs need no process of their own
};

// Returns every engine of these folders, in the order of the search. refused: receives a line for
// each library that is no engine, and for each folder that is refused because another user could
// own it or the code in it.
std::vector<ScriptEngineInfo> scriptEngines(std::string_view folders = {},
                                            std::vector<std::string>* refused = nullptr);

} // namespace xvrml
