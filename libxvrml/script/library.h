// library.h: loads the file of a script plug-in and checks its exports. Used by the list of engines
// and by xvrml-script-host. [any thread]
#pragma once

#include <string>
#include <vector>

#include "xvrml/xscript.h"

namespace xvrml {

// Loads the engines of a library. The library is never unloaded, because language interpreters do
// not tolerate it. Throws std::runtime_error if it is not a valid plug-in.
std::vector<XsEngine> loadScriptLibrary(const std::string& path);

} // namespace xvrml
