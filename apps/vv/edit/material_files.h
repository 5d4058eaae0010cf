// material_files.h: The materials of a user: worlds in a folder, which show one material each.
// [any thread]
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "xvrml/world.h"

namespace vv {

// Returns the folder: xvrml/materials in $XDG_DATA_HOME or ~/.local/share; "" if there is no such
// folder.
std::string materialFolder();
// Returns the worlds in a folder by their names; at most 1000. A folder that cannot be read has
// none.
std::vector<std::string> materialFiles(const std::string& folder);

// An Appearance, and the world that it belongs to.
struct UserMaterial {
  std::unique_ptr<xvrml::World> world;
  xvrml::NodeRef appearance;
};
// Returns the first Appearance or ORTAppearance of a file. Throws xvrml::EditError if there is
// none.
UserMaterial readMaterial(const std::string& file);

} // namespace vv
