// script_engines.h: which script engines (xscript.h) are installed here, and what they serve. [one
// thread at a time]
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace xvrml {

// True if an engine serves the protocol: the scheme of a Script's url ("javascript"), or a file's
// suffix (".js"). folders: separated by colons, before $XVRML_SCRIPT_PATH and the installed ones.
// Loads engines; says nothing of refused ones.
bool hasScriptEngine(std::string_view protocol, std::string_view folders = {});

struct ScriptEngineInfo {
  std::string name, text;                       // "ecmascript"; a line for people
  std::string library;                          // the file that it comes from
  std::vector<std::string> schemes;             // "javascript", without the colon
  std::vector<std::string> mimeTypes, suffixes; // ".js"
  bool needsTrust = false; // its programs can do whatever the user can: trusted worlds only
  bool harmless = false;   // its programs need no process of their own
};

// Every engine of these folders, in the order in which they are looked at. refused: a line for each
// library that is none, and for each folder that is refused because it, or code put into it, could
// be somebody else's.
std::vector<ScriptEngineInfo> scriptEngines(std::string_view folders = {},
                                            std::vector<std::string>* refused = nullptr);

} // namespace xvrml
