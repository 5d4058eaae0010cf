#include "engine_list.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "printable.h"
#include "process/messages.h"
#include "xvrml/script_engines.h"

namespace vv {

namespace {

using Json = nlohmann::ordered_json;

Json engineJson(const xvrml::ScriptEngineInfo& e) {
  return {{"name", e.name},           {"text", e.text},         {"schemes", e.schemes},
          {"mimeTypes", e.mimeTypes}, {"suffixes", e.suffixes}, {"trust", e.needsTrust},
          {"harmless", e.harmless},   {"library", e.library}};
}

std::string engineText(const xvrml::ScriptEngineInfo& e) {
  std::string serves;
  const auto add = [&](const std::string& one) { serves += (serves.empty() ? "" : " ") + one; };
  for (const std::string& scheme : e.schemes) add(scheme + ":");
  for (const std::string& suffix : e.suffixes) add(suffix);
  for (const std::string& type : e.mimeTypes) add(type);
  return fmt::format("{}: {}\n  serves   {}\n  worlds   {}\n  library  {}\n", e.name, e.text,
                     serves, e.needsTrust ? "trusted ones only (--trust)" : "all", e.library);
}

} // namespace

std::string listEngines(const std::string& scriptPath, bool json) {
  std::vector<std::string> refused;
  const std::vector<xvrml::ScriptEngineInfo> engines = xvrml::scriptEngines(scriptPath, &refused);
  for (const std::string& line : refused) sayWarning(line);
  Json list = Json::array();
  std::string text;
  for (const xvrml::ScriptEngineInfo& engine : engines) {
    list.push_back(engineJson(engine));
    text += engineText(engine);
  }
  if (json)
    return printableJson(Json({{"engines", std::move(list)}})
                             .dump(2, ' ', false, Json::error_handler_t::replace)) +
           "\n";
  return text.empty() ? "no script engine is installed\n" : text;
}

} // namespace vv
