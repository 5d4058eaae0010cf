// shader_text.h: Parses the syntax for shaders of the command line and of presets:
// Class:param=value:... and library/Class:param=value:... The class is looked up in a context of
// its own. [any thread; the current context stays]
#pragma once

#include <stdexcept>
#include <string>

#include "openrt/openrt.h"
#include "xvrml/nodes.h"

namespace picture {

struct ShaderError : std::runtime_error {
  using runtime_error::runtime_error;
};

// Returns an ORTShader node with that class and these parameters. Throws ShaderError that says what
// was expected: the nearest class or parameter, the type of a value, or its range. `option` is for
// messages, such as "--shader"; `role` is RT_SURFACE, RT_CAMERA and so on. If `folder` is not
// empty, the files that the text names are relative to it and must be inside. `showsColor`, if
// given, tells whether the shader shows the colour of a shape's material.
xvrml::NodeRef readShader(const std::string& text, const char* option, RTenum role,
                          const std::string& shaderPath, const std::string& folder = "",
                          bool* showsColor = nullptr);

// Returns the text that readShader() reads as this shader, with the fields that it declares.
// Pictures, files, and texts with blanks, commas or colons are left out; isWhole, if given, tells
// whether nothing is.
std::string shaderText(const xvrml::nodes::ORTShader& shader, bool* isWhole = nullptr);

// Returns "surface", "light" and so on for RT_SURFACE, RT_LIGHT and so on.
const char* roleName(RTenum role);
const char* parameterTypeName(RTenum type);

} // namespace picture
