// plugin_check.cpp: checks a plug-in against the rules of the script ABI.
#include "script/plugin_check.h"

#include <cstring>
#include <stdexcept>
#include <string_view>

#include <fmt/format.h>

namespace xvrml {
namespace {

constexpr uint32_t maximumEngines = 256;
constexpr size_t maximumNames = 256;
// An engine's structure reaches at least to its last mandatory function.
constexpr size_t minEngineBytes = offsetof(XsEngine, initialize);

[[noreturn]] void refuse(const std::string& path, const std::string& why) {
  throw std::runtime_error(fmt::format("script library {}: {}", path, why));
}

void checkHeader(const XsPlugin* plugin, size_t symbolBytes, const std::string& path) {
  if (symbolBytes != 0 && symbolBytes < sizeof(XsPlugin))
    refuse(path, fmt::format("its " XS_ENTRY_NAME " has {} bytes; a plug-in's has at least {}",
                             symbolBytes, sizeof(XsPlugin)));
  if (plugin->magic != XS_MAGIC) refuse(path, "not a script plug-in (wrong magic number)");
  if (plugin->major != XS_ABI_MAJOR || plugin->minor > XS_ABI_MINOR)
    refuse(path, fmt::format("made for script ABI {}.{}; this library has {}.{}", plugin->major,
                             plugin->minor, XS_ABI_MAJOR, XS_ABI_MINOR));
  if (plugin->size != sizeof(XsPlugin))
    refuse(path, fmt::format("claims a plug-in structure of {} bytes; ABI {}.{} has {}",
                             plugin->size, plugin->major, plugin->minor, sizeof(XsPlugin)));
  if (plugin->engineCount == 0 || plugin->engineCount > maximumEngines || !plugin->engines)
    refuse(path, fmt::format("claims {} script engines", plugin->engineCount));
}

bool isSchemeCharacter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '+' || c == '-' || c == '.';
}

// Checks a list of lower-case names and returns its length.
size_t checkNames(const char* const* names, const char* what, bool scheme,
                  const std::string& where) {
  size_t count = 0;
  for (; names && names[count]; ++count) {
    if (count == maximumNames)
      throw std::runtime_error(fmt::format("{}: its list of {} does not end", where, what));
    const std::string_view name = names[count];
    bool good = !name.empty() && name.size() <= 100;
    for (const char c : name)
      good =
          good && (scheme ? isSchemeCharacter(c) : c > ' ' && c < 127 && !(c >= 'A' && c <= 'Z'));
    if (!good || (scheme && name.size() < 2)) // one letter is a drive in old paths
      throw std::runtime_error(
          fmt::format("{}: '{}' is no name for its {}", where, name.substr(0, 100), what));
  }
  return count;
}

XsEngine checkEngine(const XsEngine* theirs, const std::string& path) {
  if (!theirs) refuse(path, "an empty entry in its table of engines");
  if (theirs->size < minEngineBytes || theirs->size > sizeof(XsEngine))
    refuse(path, fmt::format("claims an engine structure of {} bytes; this library knows {} to {}",
                             theirs->size, minEngineBytes, sizeof(XsEngine)));
  XsEngine ours{};
  // Copies whole pointers only: half a function pointer would be wild.
  std::memcpy(&ours, theirs, theirs->size / sizeof(void*) * sizeof(void*));
  ours.size = sizeof(XsEngine);
  if (!ours.name || !*ours.name) refuse(path, "an engine without a name");
  if (!ours.text) ours.text = "";
  const std::string where = fmt::format("script library {}: engine {}", path, ours.name);
  const size_t names = checkNames(ours.schemes, "URL schemes", true, where) +
                       checkNames(ours.mimeTypes, "MIME types", false, where) +
                       checkNames(ours.suffixes, "file suffixes", false, where);
  if (names == 0)
    throw std::runtime_error(where + ": serves no URL scheme, MIME type or file suffix");
  const char* missing = !ours.create ? "create" : !ours.destroy ? "destroy" : nullptr;
  if (missing) throw std::runtime_error(fmt::format("{}: lacks the function {}", where, missing));
  return ours;
}

} // namespace

std::vector<XsEngine> checkScriptPlugin(const XsPlugin* plugin, size_t symbolBytes,
                                        const std::string& path) {
  checkHeader(plugin, symbolBytes, path);
  std::vector<XsEngine> engines;
  for (uint32_t i = 0; i < plugin->engineCount; ++i)
    engines.push_back(checkEngine(plugin->engines[i], path));
  return engines;
}

} // namespace xvrml
