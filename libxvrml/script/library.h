// library.h: loads the file of a script plug-in and checks its exports. Used by the list of engines
// and by xvrml-script-host. [any thread]
#pragma once

#include <string>
#include <vector>

#include "xvrml/xscript.h"

namespace xvrml {

struct ScriptLibrary {
  std::vector<XsEngine> engines;
  uint32_t minor = XS_ABI_MINOR; // the minor version of the ABI that it was built against
};

// Loads the engines of a library. The library is never unloaded, because language interpreters do
// not tolerate it. Throws std::runtime_error if it is not a valid plug-in.
ScriptLibrary loadScriptLibrary(const std::string& path);

} // namespace xvrml
