// available.cpp: see xvrml/script_engines.h.
#include "xvrml/script_engines.h"

#include "script/engines.h"

namespace xvrml {

bool hasScriptEngine(std::string_view protocol, std::string_view folders) {
  if (protocol.empty()) return false;
  ScriptEngines engines(scriptFolders(folders));
  return protocol.front() == '.' ? engines.bySuffix(protocol) != nullptr : engines.byScheme(protocol) != nullptr;
}

} // namespace xvrml
