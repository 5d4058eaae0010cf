#include "library.h"

#include <map>
#include <mutex>

#include "plugin_library.h"
#include "system/libraries.h"

namespace native {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> searchedFolders() {
  static const char here = 0;
  std::vector<std::string> folders;
  if (const char* configured = os::trustedEnvironment("XVRML_NATIVE_PATH"))
    plugin_files::appendList(folders, configured);
  Dl_info info{};
  std::error_code error;
  if (dladdr(&here, &info) != 0 && info.dli_fname) {
    const fs::path installed =
        fs::canonical(fs::path(info.dli_fname).parent_path() / "../native", error);
    if (!error) folders.push_back(installed.string());
  }
  return folders;
}

std::string find(const std::string& name, const std::vector<std::string>& folders) {
  for (const std::string& folder : folders) {
    if (!plugin_files::trusted(folder)) continue;
    for (const std::string& file : {name, name + ".so", "lib" + name + ".so"}) {
      const fs::path candidate = fs::path(folder) / file;
      std::error_code error;
      if (fs::is_regular_file(candidate, error)) return candidate.string();
    }
  }
  return {};
}

} // namespace

void* loadLibrary(const std::string& name) {
  plugin_files::bareName(name, "native library");
  const std::vector<std::string> folders = searchedFolders();
  const std::string path = find(name, folders);
  if (path.empty())
    throw std::runtime_error("there is no library \"" + name +
                             "\" in the folders of $XVRML_NATIVE_PATH and of the installation (" +
                             plugin_files::listed(folders) + ")");
  static std::mutex mutex;
  static auto& known = *new std::map<std::string, void*>();
  const std::scoped_lock lock(mutex);
  void*& handle = known[path];
  if (!handle) handle = plugin_files::openLibrary(path, "native library");
  return handle;
}

} // namespace native
