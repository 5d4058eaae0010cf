// plugin_check.h: decides whether the constant exported by a script library can be used safely.
// Used by the list of engines when it loads a library, and by the ABI tests. [any thread]
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "xvrml/xscript.h"

namespace xvrml {

// Checks magic, versions, sizes and all tables of a plug-in. Returns its engines as full XsEngine
// structures; functions unknown to an older plug-in are NULL. symbolBytes: size of the exported
// constant if the loader knows it, else 0. Throws std::runtime_error with the reason, including
// both versions if they differ.
std::vector<XsEngine> checkScriptPlugin(const XsPlugin* plugin, size_t symbolBytes,
                                        const std::string& path);

} // namespace xvrml
