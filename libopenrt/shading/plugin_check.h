// plugin_check.h: checks the constant that a shader library exports before any of its functions are
// called. Used by the registry when it loads a library, and by the ABI tests. [any thread]
#pragma once

#include <cstddef>
#include <iterator>
#include <span>
#include <string>
#include <vector>

#include "openrt/openrts.h"

namespace openrt {

// Sizes of RtsClass in the minor versions of the ABI, from 0 to that of this library.
inline constexpr size_t classBytesByMinor[] = {offsetof(RtsClass, opening),
                                               offsetof(RtsClass, opening),
                                               offsetof(RtsClass, opening), sizeof(RtsClass)};
static_assert(std::size(classBytesByMinor) == RTS_ABI_MINOR + 1);

// Checks magic, versions, sizes and every table of a plug-in. Returns its classes as the host sees
// them: complete RtsClass structures in which functions that an older plug-in does not know are
// NULL. symbolBytes: size of the exported constant if the loader knows it, else 0. Accepts a minor
// version for each of classBytes. Throws std::runtime_error with the reason, and with both versions
// if they differ.
std::vector<RtsClass> checkPlugin(const RtsPlugin* plugin, size_t symbolBytes,
                                  const std::string& path,
                                  std::span<const size_t> classBytes = classBytesByMinor);

// Returns the size in bytes of a value of this type in a parameter struct; 0 for an unknown type.
size_t parameterBytes(RtsType type);

} // namespace openrt
