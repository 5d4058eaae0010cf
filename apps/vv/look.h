// bare_model.h: Gives pictures of models that say nothing of how they are shown a neutral
// background, or a studio if a part is metal (docs/decisions/0040-models.md). [main thread]
#pragma once

#include "options/options.h"
#include "xvrml/world.h"

namespace vv {

// Returns whether the world is a model alone: no Viewpoint, NavigationInfo, Background, fog or
// light, and no ORT node that shows or lights it. Cameras of glTF files do not count.
bool isBareModel(const xvrml::World& world);

// Sets the background of such a model, or a studio of that colour if a PhysicalMaterial is metal.
// The pictures must be made for screens, and the options leave the background open. EXR and PPM
// files, which programs read, and comparisons keep the world as it is.
void chooseBackground(Options& options, const xvrml::World& world);

} // namespace vv
