// program.h: which of a Script's URLs to run, with which engine (ISO/IEC 14772-1 4.5.4, 4.12.7):
// the first whose engine is installed and whose text can be read. [the browser's thread]
#pragma once

#include <unordered_set>

#include "script/engines.h"
#include "xvrml/world.h"

namespace xvrml {

struct ScriptProgram {
  const XsEngine* engine = nullptr; // null: none of the URLs can be run
  std::string scheme;               // "javascript"; empty: a file, or a data: URL
  std::string text;
  SourcePosition start; // of its first line, as well as known
  size_t url = 0;       // which one
};

class ProgramFinder {
 public:
  ProgramFinder(std::vector<std::string> folders, Diagnostics& diagnostics, bool trusted)
      : engines_(std::move(folders)), diagnostics_(diagnostics), trusted_(trusted) {}

  // The first that can be run, from URL number `first` on. If there is none, says why: a missing
  // engine once for each protocol of a world, anything else for each Script.
  ScriptProgram find(const ScriptNode& script, const LoadOptions& options, size_t first = 0);
  // The same without a message: for a Script whose turn has not come. tellRefusals() follows when
  // it has.
  ScriptProgram peek(const ScriptNode& script, const LoadOptions& options, size_t first = 0);
  void tellRefusals(); // of plug-ins that cannot be used

 private:
  bool inlineProgram(const std::string& url, size_t colon, ScriptProgram& program);
  bool dataProgram(std::string_view url, const LoadOptions& options, ScriptProgram& program);
  bool fileProgram(const std::string& url, const std::string& base, const LoadOptions& options,
                   ScriptProgram& program);
  bool usable(const XsEngine* engine, const std::string& protocol);
  void tellMissing(const ScriptNode& script);

  ScriptEngines engines_;
  Diagnostics& diagnostics_;
  const bool trusted_;
  std::unordered_set<std::string> told_; // protocols
  std::vector<std::pair<std::string, std::string>>
      missing_;         // of the present Script: protocol, message
  std::string reasons_; // other ones
};

} // namespace xvrml
