// shader_changes.h: --shader DEF=Class:param=value: other surface shaders for shapes of a loaded
// world. [main thread]
#pragma once

#include <string>
#include <vector>

#include "xvrml/world.h"

namespace vv {

// Gives the shapes that the texts name another shader. DEF: a Shape, an appearance, a Material, or
// anything that shapes stand below; *: all of the world that have no ORTShader of their own.
// Material and texture of a shape stay, for shaders that have parameters of these names. Later
// texts win. Throws Failure (usage) naming what was expected.
void changeShaders(const std::vector<std::string>& texts, const std::string& shaderPath,
                   xvrml::World& world);

} // namespace vv
