// shader_text.h: Parses the command line's syntax for shaders: Class:param=value:... and
// library/Class:param=value:... The class is looked up in a context of its own. [main thread]
#pragma once

#include <string>

#include "openrt/openrt.h"
#include "xvrml/node.h"

namespace vv {

// Returns an ORTShader node with that class and these parameters. Throws UsageError that says what
// was expected: the nearest class or parameter, the type of a value, or its range. `option` is for
// messages, such as "--shader"; `role` is RT_SURFACE, RT_CAMERA and so on.
xvrml::NodeRef readShader(const std::string& text, const char* option, RTenum role,
                          const std::string& shaderPath);

// Returns "surface", "light" and so on for RT_SURFACE, RT_LIGHT and so on.
const char* roleName(RTenum role);
const char* parameterTypeName(RTenum type);

} // namespace vv
