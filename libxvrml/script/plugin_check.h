// plugin_check.h: decides whether the constant that a script library exports may be trusted with
// being called. Used by the list of engines when it loads a library, and by the ABI tests. Any
// thread.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "xvrml/xscript.h"

namespace xvrml {

// Checks magic, versions, sizes and every table of a plug-in and returns its engines as the host
// sees them: whole XsEngine structures in which functions unknown to an older plug-in are NULL.
// symbolBytes: size of the exported constant where the loader knows it, else 0. Throws
// std::runtime_error that says what is wrong, with both versions where they differ.
std::vector<XsEngine> checkScriptPlugin(const XsPlugin* plugin, size_t symbolBytes,
                                        const std::string& path);

} // namespace xvrml
