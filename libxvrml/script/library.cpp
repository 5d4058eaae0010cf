// library.cpp: loads script plug-ins. Part of the library and of xvrml-script-host.
#include "script/library.h"

#include <stdexcept>

#include <dlfcn.h>

#include "plugin_library.h"
#include "script/plugin_check.h"
#include "system/libraries.h"

namespace xvrml {

std::vector<XsEngine> loadScriptLibrary(const std::string& path) {
  void* const handle = plugin_files::openLibrary(path, "script library");
  try {
    void* symbol = dlsym(handle, XS_ENTRY_NAME);
    if (!symbol)
      throw std::runtime_error("script library " + path +
                               ": exports no " XS_ENTRY_NAME ", so it is not a script plug-in");
    return checkScriptPlugin(static_cast<const XsPlugin*>(symbol), os::exportedBytes(symbol), path);
  } catch (...) {
    dlclose(handle);
    throw;
  }
}

} // namespace xvrml
