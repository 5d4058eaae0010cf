// plugin_library.h: The one door by which code comes into the process: every plug-in and library
// that is loaded by its file passes here. The file must be one that no other user could have
// written (plugin_files.h), and whole: the loader maps what the headers of an ELF file promise, and
// a file that ends before is a SIGBUS later. Stateless; any thread.
#pragma once

#include <stdexcept>
#include <string>

#include <dlfcn.h>

#include "plugin_files.h"
#include "system/libraries.h"

namespace plugin_files {

// Loads a library from its file and returns dlopen's handle. what: kind of library, for the
// message. Throws std::runtime_error with the reason.
inline void* openLibrary(const std::string& path, const char* what) {
  checkFile(path, what);
  if (const std::string why = os::whyIncomplete(path); !why.empty())
    throw std::runtime_error(std::string(what) + " " + path + ": " + why);
  if (void* handle = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL)) return handle;
  const char* reason = dlerror();
  throw std::runtime_error(std::string(what) + " " + path + ": " +
                           (reason ? reason : "cannot be loaded"));
}

} // namespace plugin_files
