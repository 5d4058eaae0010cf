// shader_list.h: --list-shaders: the classes of all shader plug-ins that are found, as text or
// JSON. [main thread]
#pragma once

#include <string>

namespace vv {

// shaderPath: folders looked at first. A plug-in that cannot be used is named with the reason.
std::string listShaders(const std::string& shaderPath, bool json);

} // namespace vv
