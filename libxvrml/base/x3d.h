// x3d.h: the fields of X3D (ISO/IEC 19775-1) that nodes of ours do not have, for messages, and
// those that it spells otherwise. Pure functions, any thread.
#pragma once

#include <string_view>

#include "xvrml/node.h"

namespace xvrml {

// Returns the word of ISO/IEC 19775-1 for an access.
constexpr std::string_view x3dAccessName(Access access) {
  constexpr std::string_view names[] = {"initializeOnly", "inputOutput", "inputOnly", "outputOnly"};
  return names[static_cast<size_t>(access)];
}

// Returns whether a field of X3D holds programs for graphics processors (clause 31), which can only
// be run there.
bool isGpuField(std::string_view field);
// Returns whether X3D adds this field to a node type of VRML97.
bool isX3dField(std::string_view type, std::string_view field);
// Returns the name in VRML97 of a field or event of a node of X3D: "choice" for a Switch's
// "children", "set_choice" for its "set_children". Other names are returned as
// they are.
std::string_view ownName(std::string_view type, std::string_view name);
// Returns the name in X3D of a field or event of ours: the reverse of ownName. version: the major
// version of X3D.
std::string_view x3dName(std::string_view type, std::string_view name, int version);

// Returns whether the numbers of a field of ours, which are no rotations, are angles.
bool isAngleField(std::string_view type, std::string_view field);

} // namespace xvrml
