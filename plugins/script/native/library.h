// library.h: Loads the libraries of native: Scripts. They come from folders that the user
// configured, never from a path in a world. Loaded libraries stay for the life of the process. [the
// browser's thread]
#pragma once

#include <string>

namespace native {

// Searches NAME, NAME.so and libNAME.so in the folders of $XVRML_NATIVE_PATH, then in xvrml/native
// beside the engines' folder. Returns dlopen's handle. Throws std::runtime_error with the reason:
// not a bare name, not found, or writable by others.
void* loadLibrary(const std::string& name);

} // namespace native
