// physical.h: PhysicalMaterial and UnlitMaterial of X3D 4 as parameters of the shader class
// Physical. [the mapper's thread]
#pragma once

#include <initializer_list>
#include <string>

#include "mapper/rt.h"
#include "mapper/shading/layers.h"
#include "mapper/shading/textures.h"
#include "xvrml/appearance.h"
#include "xvrml/nodes.h"
#include "xvrml/world.h"

namespace xvrml::mapper {

// Returns whether the node is a material that the class Physical draws.
bool isPhysical(Node* material);
// Returns the value of the parameter alphaMode for an appearance, which may be null: 0 opaque, 1
// mask, 2 blend.
int alphaModeOf(const nodes::Appearance* appearance, World& world);
// Warns if the names of mappings differ.
void warnOfMappings(const Node& material, std::initializer_list<const std::string*> mappings,
                    World& world);
// Returns whether a material has a picture of its own other than a cube map.
bool hasPictures(Node& material);

// Sets all parameters of a shader of the class Physical. Warns where a material asks for different
// texture coordinates for its pictures.
void setPhysical(ShaderSetup& shader, const AppearanceParts& parts, const LayerPictures& pictures,
                 World& world, bool linear);

} // namespace xvrml::mapper
