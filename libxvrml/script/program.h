// program.h: chooses which of a Script's URLs to run, and with which engine (ISO/IEC 14772-1 4.5.4,
// 4.12.7): the first one whose engine is installed and whose text can be read. [the browser's
// thread]
#pragma once

#include <unordered_set>

#include "script/engines.h"
#include "xvrml/world.h"

namespace xvrml {

struct ScriptProgram {
  const XsEngine* engine = nullptr; // null: none of the URLs can be run
  std::string scheme;               // such as "javascript"; empty: a file or data: URL
  std::string text;
  SourcePosition start; // position of the program's first line, as far as known
  size_t url = 0;       // index of the URL
};

class ProgramFinder {
 public:
  ProgramFinder(std::vector<std::string> folders, Diagnostics& diagnostics, bool trusted)
      : engines_(std::move(folders)), diagnostics_(diagnostics), trusted_(trusted) {}

  // Returns the first runnable program from URL number `first` on. If there is none, it reports
  // why: a missing engine once per protocol and world, other reasons for each Script.
  ScriptProgram find(const ScriptNode& script, const LoadOptions& options, size_t first = 0);
  // Does the same without messages, for a Script whose turn has not come. reportRefusals() is
  // called at its turn.
  ScriptProgram peek(const ScriptNode& script, const LoadOptions& options, size_t first = 0);
  void reportRefusals(); // reports plug-ins that cannot be used

 private:
  bool inlineProgram(const std::string& url, size_t colon, ScriptProgram& program);
  bool dataProgram(std::string_view url, const LoadOptions& options, ScriptProgram& program);
  bool fileProgram(const std::string& url, const std::string& base, const LoadOptions& options,
                   ScriptProgram& program);
  bool usable(const XsEngine* engine, const std::string& protocol);
  void reportMissing(const ScriptNode& script);

  ScriptEngines engines_;
  Diagnostics& diagnostics_;
  const bool trusted_;
  std::unordered_set<std::string> reported_; // reported protocols
  // Missing engines of the current Script: protocol and message.
  std::vector<std::pair<std::string, std::string>> missing_;
  std::string reasons_; // other reasons
};

} // namespace xvrml
