// fill_properties.h: FillProperties (ISO/IEC 19775-1 12.4.2) as parameters of shaders. [the
// mapper's thread]
#pragma once

#include "mapper/rt.h"
#include "xvrml/nodes.h"
#include "xvrml/world.h"

namespace xvrml::mapper {

// Each function takes an appearance that may be null.
// Returns whether faces are to be left out, but for their hatching.
bool isUnfilled(const nodes::Appearance* appearance);
// Returns whether lines are to be drawn over faces.
bool isHatched(const nodes::Appearance* appearance);
// Sets the parameters hatchStyle and hatchColor of a shader's class.
void setHatching(ShaderSetup& shader, const nodes::Appearance* appearance, bool linear);
// Warns of a style that the register of graphical items does not have.
void warnOfHatching(const nodes::Appearance* appearance, World& world);

} // namespace xvrml::mapper
