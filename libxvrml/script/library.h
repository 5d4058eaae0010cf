// library.h: one script plug-in: loads its file and checks what it exports. Used by the list of
// engines and by xvrml-script-host. Any thread.
#pragma once

#include <string>
#include <vector>

#include "xvrml/xscript.h"

namespace xvrml {

// The engines of a library, which is never unloaded: interpreters of languages do not bear it.
// Throws std::runtime_error if it is no good plug-in.
std::vector<XsEngine> loadScriptLibrary(const std::string& path);

} // namespace xvrml
