// x3d.h: the nodes and fields of X3D (ISO/IEC 19775-1) that VRML97 does not have, for messages, and
// those that it spells otherwise or gives other defaults. Pure functions, any thread.
#pragma once

#include <string_view>

#include "xvrml/node.h"

namespace xvrml {

// Returns the word of ISO/IEC 19775-1 for an access.
constexpr std::string_view x3dAccessName(Access access) {
  constexpr std::string_view names[] = {"initializeOnly", "inputOutput", "inputOnly", "outputOnly"};
  return names[static_cast<size_t>(access)];
}

bool isX3dNode(std::string_view type);
// Return whether a node of X3D, or a field that holds such nodes, belongs to a program for graphics
// processors (clause 31): it can only be run there.
bool isGpuNode(std::string_view type);
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
// Returns the default of a field of VRML97 where X3D gives it another one; null: they are the same.
const Value* x3dDefault(std::string_view type, std::string_view field);

} // namespace xvrml
