// material_ball.h: Draws a ball of a material in a studio, as choosers of materials show it. [any
// thread that may use the appearance]
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "libpicture/renderer.h"

namespace picture {

// Returns the display bytes (libpicture/files/picture.h) of a square picture of a ball with an
// Appearance or ORTAppearance, which may belong to another world. It takes one thread some tenths
// of a second. shaderPath: folders of shader plug-ins that are searched first. Empty if `watch` has
// ended it. Throws RenderError.
std::vector<uint8_t> drawMaterialBall(const xvrml::NodeRef& appearance, int side,
                                      const std::string& shaderPath, const ProgressCallback& watch);

} // namespace picture
