// x3d.h: Recognises the common nodes and fields of X3D (ISO/IEC 19775-1) that VRML97 does not have,
// for messages. Pure functions, any thread.
#pragma once

#include <string_view>

namespace xvrml {

bool isX3dNode(std::string_view type);
// Returns whether X3D adds this field to a node type of VRML97.
bool isX3dField(std::string_view type, std::string_view field);

} // namespace xvrml
