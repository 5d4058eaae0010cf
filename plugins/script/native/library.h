// library.h: where libraries of native: Scripts come from: folders that the user configured, never
// a place that a world names. Loaded libraries stay for the life of the process. [the browser's
// thread]
#pragma once

#include <string>

namespace native {

// Looks for NAME, NAME.so, libNAME.so in the folders of $XVRML_NATIVE_PATH, then in xvrml/native
// beside the engines' folder. Returns dlopen's handle. Throws std::runtime_error with the reason:
// no bare name, not found, others may write to it.
void* loadLibrary(const std::string& name);

} // namespace native
