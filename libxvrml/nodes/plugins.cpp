// plugins.cpp: finds, checks and registers node plug-ins.
#include "xvrml/node_plugin.h"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <mutex>
#include <set>

#include <dlfcn.h>
#include <fmt/format.h>

#include "folder_files.h"
#include "nodes/registry.h"
#include "plugin_library.h"

namespace xvrml {
namespace {

namespace fs = std::filesystem;

std::string sizesText(const uint32_t (&sizes)[10]) {
  return fmt::format("{}", fmt::join(sizes, " "));
}

// Returns the reason why a plug-in cannot be used; "" if it can. Reads no member beyond `size`, and
// none after a wrong version.
std::string whyRefused(const NodePlugin& plugin) {
  if (plugin.magic != nodePluginMagic)
    return fmt::format("its {} has a wrong magic number", nodePluginSymbol);
  if (plugin.major != nodePluginMajor || plugin.minor > nodePluginMinor)
    return fmt::format(
        "it is made for version {}.{} of the node plug-in interface, this library has {}.{}",
        plugin.major, plugin.minor, nodePluginMajor, nodePluginMinor);
  if (plugin.size < sizeof(NodePlugin))
    return fmt::format("its description has {} bytes, {} were expected", plugin.size,
                       sizeof(NodePlugin));
  if (!plugin.abi || std::string_view(plugin.abi) != XVRML_CXX_ABI)
    return fmt::format("it is built for the C++ library \"{}\", this one for \"{}\"",
                       plugin.abi ? plugin.abi : "", XVRML_CXX_ABI);
  if (!std::equal(std::begin(plugin.sizes), std::end(plugin.sizes), std::begin(nodePluginSizes)))
    return fmt::format("it is built with headers of another version: sizes {}, expected {}",
                       sizesText(plugin.sizes), sizesText(nodePluginSizes));
  for (uint32_t i = 0; i < plugin.count; ++i) {
    const NodePluginRow& one = plugin.rows[i];
    if (!one.row || !one.row->create || !one.registered || !one.render)
      return fmt::format("row {} of its nodes is incomplete", i);
    if (findNodeType(one.row->name))
      return fmt::format("there is a node type {} already", one.row->name);
  }
  return "";
}

// Registers a plug-in's node types, which live for ever. Returns false if two have the same name.
bool registerNodes(const NodePlugin& plugin) {
  std::vector<const NodeType*> types;
  for (uint32_t i = 0; i < plugin.count; ++i) {
    const NodePluginRow& one = plugin.rows[i];
    auto* type = new NodeType(makeNodeType(*one.row, int(nodeTypes().size() + i)));
    if (one.implementation) type->expand = one.implementation->expand;
    types.push_back(type);
  }
  if (!addNodeTypes(types)) return false;
  for (uint32_t i = 0; i < plugin.count; ++i) {
    const NodePluginRow& one = plugin.rows[i];
    one.registered(*types[i]);
    if (one.implementation) setBehaviour(*types[i], one.implementation->behaviour);
    setRenderCall(*types[i], one.render);
  }
  return true;
}

// Loads one plug-in. Returns "" or the reason why it is refused.
std::string loadOne(const std::string& path) {
  void* handle = nullptr;
  try {
    handle = plugin_files::openLibrary(path, "node plug-in");
  } catch (const std::runtime_error& why) { return why.what(); }
  const auto* plugin = static_cast<const NodePlugin*>(::dlsym(handle, nodePluginSymbol));
  std::string reason =
      plugin ? whyRefused(*plugin) : fmt::format("it exports no {}", nodePluginSymbol);
  if (reason.empty() && !registerNodes(*plugin)) reason = "two of its nodes have one name";
  if (reason.empty()) return "";
  ::dlclose(handle);
  return fmt::format("node plug-in {} is refused: {}", path, reason);
}

} // namespace

std::vector<std::string> nodePluginFolders(std::string_view first) {
  static const char here = 0;
  return plugin_files::folders(first, "XVRML_NODE_PATH", "xvrml/nodes", &here);
}

std::vector<std::string> loadNodePlugins(std::string_view first) {
  static std::mutex mutex;
  static std::set<std::string> seen;
  const std::scoped_lock lock(mutex);
  std::vector<std::string> refused;
  for (const std::string& folder : nodePluginFolders(first)) {
    const std::vector<std::string> files = filesOfFolder(folder, ".so");
    if (!files.empty() && !plugin_files::trusted(folder)) {
      refused.push_back(fmt::format("node plug-ins in {} are refused: {}", folder,
                                    plugin_files::objection(folder)));
      continue;
    }
    for (const std::string& file : files) {
      std::error_code error;
      const fs::path canonical = fs::canonical(file, error);
      if (!seen.insert(error ? file : canonical.string()).second) continue;
      if (std::string reason = loadOne(file); !reason.empty()) refused.push_back(std::move(reason));
    }
  }
  return refused;
}

} // namespace xvrml
