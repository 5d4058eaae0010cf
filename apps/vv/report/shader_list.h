// shader_list.h: Implements --list-shaders: lists the classes of all installed shader plug-ins as
// text or JSON. [main thread]
#pragma once

#include <string>

namespace vv {

// shaderPath: folders that are searched first. Unusable plug-ins are listed with the reason.
std::string listShaders(const std::string& shaderPath, bool json);

} // namespace vv
