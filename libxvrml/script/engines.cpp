#include "script/engines.h"

#include <map>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <utility>

#include "folder_files.h"
#include "plugin_files.h"
#include "script/library.h"

namespace xvrml {
namespace {

namespace fs = std::filesystem;

// The engines of each file. They are loaded once per process and kept for ever.
struct Libraries {
  std::mutex mutex;
  std::map<std::string, std::vector<XsEngine>, std::less<>> byPath; // the engines of each file
};
Libraries& libraries() {
  static auto& all = *new Libraries();
  return all;
}

const std::vector<XsEngine>& libraryEngines(const std::string& path) {
  Libraries& all = libraries();
  const std::scoped_lock lock(all.mutex);
  const auto known = all.byPath.find(path);
  if (known != all.byPath.end()) return known->second;
  return all.byPath.emplace(path, loadScriptLibrary(path)).first->second;
}

} // namespace

std::string ScriptEngines::searched() const { return plugin_files::listed(folders_); }

void ScriptEngines::load(const std::string& path) {
  if (std::find(tried_.begin(), tried_.end(), path) != tried_.end()) return;
  tried_.push_back(path);
  try {
    loaded_.push_back(&libraryEngines(path));
  } catch (const std::runtime_error& error) { refusals_.emplace_back(error.what()); }
}

void ScriptEngines::loadNamed(std::string_view name) {
  for (const std::string& folder : folders_) {
    const std::string file = plugin_files::trusted(folder)
                                 ? plugin_files::file(folder, std::string(name))
                                 : std::string();
    if (!file.empty()) return load(file);
  }
}

void ScriptEngines::loadAll() {
  if (std::exchange(all_, true)) return;
  for (const std::string& folder : folders_) {
    if (!plugin_files::trusted(folder)) continue;
    for (const std::string& file : filesOfFolder(folder, ".so")) load(file);
  }
}

const XsEngine* ScriptEngines::find(Names names, std::string_view wanted,
                                    std::string_view libraryName) {
  const auto known = [&]() -> const XsEngine* {
    for (const auto* engines : loaded_)
      for (const XsEngine& engine : *engines)
        for (const char* const* name = engine.*names; name && *name; ++name)
          if (wanted == *name) return &engine;
    return nullptr;
  };
  if (const XsEngine* engine = known()) return engine;
  if (!libraryName.empty()) {
    loadNamed(libraryName);
    if (const XsEngine* engine = known()) return engine;
  }
  loadAll();
  return known();
}

std::vector<const XsEngine*> ScriptEngines::all() {
  loadAll();
  std::vector<const XsEngine*> list;
  for (const auto* engines : loaded_)
    for (const XsEngine& engine : *engines) list.push_back(&engine);
  return list;
}

std::string libraryOf(const XsEngine& engine) {
  Libraries& all = libraries();
  const std::scoped_lock lock(all.mutex);
  for (const auto& [path, engines] : all.byPath) {
    const XsEngine* first = engines.data();
    if (&engine >= first && &engine < first + engines.size()) return path;
  }
  return "";
}

const XsEngine* ScriptEngines::byScheme(std::string_view scheme) {
  return find(&XsEngine::schemes, scheme, scheme);
}
const XsEngine* ScriptEngines::byMimeType(std::string_view type) {
  return find(&XsEngine::mimeTypes, type, {});
}
const XsEngine* ScriptEngines::bySuffix(std::string_view suffix) {
  return find(&XsEngine::suffixes, suffix, {});
}

std::vector<std::string> scriptFolders(std::string_view configured) {
  static const char here = 0;
  return plugin_files::folders(configured, "XVRML_SCRIPT_PATH", "xvrml/scripts", &here);
}

} // namespace xvrml
