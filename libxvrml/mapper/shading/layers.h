// layers.h: the pictures of a surface as layers of the shader class X3DMaterial: a MultiTexture
// with its MultiTextureTransform (ISO/IEC 19775-1 18.4.3, 18.4.5), or one texture. [the mapper's
// thread]
#pragma once

#include <string_view>

#include "mapper/rt.h"
#include "mapper/shading/textures.h"
#include "mapper/shading/volumes.h"
#include "xvrml/nodes.h"
#include "xvrml/world.h"

namespace xvrml::mapper {

// Where layers find their textures.
struct LayerPictures {
  Textures& textures;
  Volumes& volumes;
  RTid of(Node* node) const { return isVolume(node) ? volumes.of(*node) : textures.ofNode(node); }
};

// Sets the parameters of all layers. A single texture multiplies the colour if `multiplies`,
// else it follows the rules of VRML97.
void setLayers(ShaderSetup& shader, Node* texture, Node* textureTransform, std::string_view mapping,
               bool multiplies, const LayerPictures& from, World& world, bool linear);

} // namespace xvrml::mapper
