// material_parameters.h: The fields of an appearance as parameters of the class that an ORTShader
// names. [the mapper's thread]
#pragma once

#include "mapper/rt.h"
#include "mapper/shading/textures.h"
#include "xvrml/appearance.h"
#include "xvrml/nodes.h"
#include "xvrml/world.h"

namespace xvrml::mapper {

// Returns the name of the parameter that takes the colour of a material, or null. It is the first
// of diffuseColor, baseColor, color and reflectance that the class has.
const char* colorParameterOf(const ShaderClass& shaderClass);

// Sets the parameters that have the names and types of the material's fields, its colour, texture
// and textureTransform. Warns of a picture that the class has no parameter for.
void setMaterialParameters(ShaderSetup& shader, const ShaderClass& shaderClass,
                           const nodes::ORTShader& node, const AppearanceParts& parts,
                           Textures& textures, World& world, bool linear);

} // namespace xvrml::mapper
