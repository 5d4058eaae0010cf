// plugin_check.h: decides whether the constant that a shader library exports may be trusted with
// being called. Used by the registry when it loads a library, and by the ABI tests. Any thread.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "openrt/openrts.h"

namespace openrt {

// Checks magic, versions, sizes and every table of a plug-in and returns its classes as the host
// sees them: whole RtsClass structures in which functions unknown to an older plug-in are NULL.
// symbolBytes: size of the exported constant where the loader knows it, else 0. Throws
// std::runtime_error that says what is wrong, with both versions where they differ.
std::vector<RtsClass> checkPlugin(const RtsPlugin* plugin, size_t symbolBytes,
                                  const std::string& path);

// Bytes that a value of this type takes in a parameter struct; 0 for an unknown type.
size_t parameterBytes(RtsType type);

} // namespace openrt
