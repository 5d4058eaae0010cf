// shader_changes.h: Implements --shader DEF=Class:param=value, which changes surface shaders of a
// loaded world. [main thread]
#pragma once

#include <string>
#include <vector>

#include "xvrml/world.h"

namespace vv {

// Gives the selected shapes another shader. DEF selects a Shape, an appearance, a Material, or a
// node above shapes; * selects all shapes without an ORTShader of their own. Material and texture
// of a shape stay, for shaders with parameters of these names. Later texts override earlier ones.
// Throws Failure (usage) that says what was expected.
void changeShaders(const std::vector<std::string>& texts, const std::string& shaderPath,
                   xvrml::World& world);

} // namespace vv
