// shader_text.h: shaders as they are written on the command line: Class:param=value:...,
// library/Class:param=value:... [main thread: a context of its own looks up the class]
#pragma once

#include <string>

#include "openrt/openrt.h"
#include "xvrml/node.h"

namespace vv {

// An ORTShader node with that class and these parameters. Throws UsageError naming what was
// expected: the nearest class or parameter, the type of a value, its range. option: for messages,
// "--shader"; role: RT_SURFACE, RT_CAMERA ...
xvrml::NodeRef readShader(const std::string& text, const char* option, RTenum role,
                          const std::string& shaderPath);

// "surface", "light" ... of RT_SURFACE, RT_LIGHT ...
const char* roleName(RTenum role);
const char* parameterTypeName(RTenum type);

} // namespace vv
