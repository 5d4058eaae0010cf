#include "edit/material_files.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

#include "lower_case.h"
#include "user_folder.h"
#include "xvrml/edit.h"
#include "xvrml/nodes.h"
#include "xvrml/walk.h"

namespace vv {

using namespace xvrml;
namespace fs = std::filesystem;

namespace {

// Returns the first Appearance in the order of the file; null: there is none.
NodeRef firstAppearance(const World& world) {
  std::vector<Node*> roots = rootsOf(world.scope);
  std::reverse(roots.begin(), roots.end()); // walks begin at the last one
  NodeRef found;
  walk(std::move(roots), [&](Node& node, std::vector<Node*>& open) {
    if (nodeCast<nodes::Appearance>(&node) || nodeCast<nodes::ORTAppearance>(&node))
      found = NodeRef(&node);
    const auto own = std::ptrdiff_t(open.size());
    appendChildren(node, open);
    std::reverse(open.begin() + own, open.end());
    return !found;
  });
  return found;
}

} // namespace

std::string materialFolder() {
  const fs::path data = userFolder("XDG_DATA_HOME", ".local/share");
  return data.empty() ? std::string() : (data / "xvrml" / "materials").string();
}

std::vector<std::string> materialFiles(const std::string& folder) {
  constexpr size_t most = 1000;
  constexpr std::array<std::string_view, 7> suffixes = {".wrl",  ".wrz",  ".x3d", ".x3dz",
                                                        ".x3dv", ".x3dj", ".vrml"};
  std::vector<std::string> files;
  std::error_code error;
  for (fs::directory_iterator one(folder, error), end; !error && one != end && files.size() < most;
       one.increment(error)) {
    std::error_code none;
    const std::string suffix = lowerCase(one->path().extension().string());
    if (std::find(suffixes.begin(), suffixes.end(), suffix) != suffixes.end() &&
        one->is_regular_file(none))
      files.push_back(one->path().string());
  }
  std::sort(files.begin(), files.end());
  return files;
}

UserMaterial readMaterial(const std::string& file) {
  LoadOptions options;
  options.loadInlines = false;
  UserMaterial material;
  try {
    material.world = loadWorld(file, options);
  } catch (const LoadError& error) { throw EditError(error.diagnostic.text()); }
  material.appearance = firstAppearance(*material.world);
  if (!material.appearance)
    throw EditError(fmt::format("{} has no Appearance that could be taken", file));
  return material;
}

} // namespace vv
