// available.cpp: lists the installed script engines (xvrml/script_engines.h). [any thread]
#include "xvrml/script_engines.h"

#include <filesystem>

#include "plugin_files.h"
#include "script/engines.h"

namespace xvrml {
namespace {

std::vector<std::string> listOf(const char* const* names) {
  std::vector<std::string> list;
  for (; names && *names; ++names) list.emplace_back(*names);
  return list;
}

} // namespace

bool hasScriptEngine(std::string_view protocol, std::string_view folders) {
  if (protocol.empty()) return false;
  ScriptEngines engines(scriptFolders(folders));
  return protocol.front() == '.' ? engines.bySuffix(protocol) != nullptr
                                 : engines.byScheme(protocol) != nullptr;
}

std::vector<ScriptEngineInfo> scriptEngines(std::string_view folders,
                                            std::vector<std::string>* refused) {
  const std::vector<std::string> searched = scriptFolders(folders);
  ScriptEngines engines(searched);
  std::vector<ScriptEngineInfo> list;
  for (const XsEngine* engine : engines.all()) {
    const bool trust = engine->flags & XS_NEEDS_TRUST, harmless = engine->flags & XS_HARMLESS;
    list.push_back({engine->name, engine->text ? engine->text : "", libraryOf(*engine),
                    listOf(engine->schemes), listOf(engine->mimeTypes), listOf(engine->suffixes),
                    trust, harmless});
  }
  if (!refused) return list;
  *refused = engines.takeRefusals();
  for (const std::string& folder : searched) {
    std::error_code none;
    if (std::filesystem::is_directory(folder, none) && !plugin_files::trusted(folder))
      refused->push_back("script engines in " + folder +
                         " are refused: " + plugin_files::objection(folder));
  }
  return list;
}

} // namespace xvrml
