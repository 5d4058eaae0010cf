// x3d_material.h: surfaces that need what X3D adds to a Material, as parameters of the shader class
// X3DMaterial. All others keep the class VRML97. [the mapper's thread]
#pragma once

#include "mapper/rt.h"
#include "mapper/shading/cube_maps.h"
#include "mapper/shading/textures.h"
#include "xvrml/nodes.h"
#include "xvrml/world.h"

namespace xvrml::mapper {

// The parts of an appearance, with prototype instances resolved; null where it has none.
struct X3dParts {
  const nodes::Appearance* appearance = nullptr;
  Node* material = nullptr;
  Node* texture = nullptr;
  Node* textureTransform = nullptr;
  bool multiplies = false; // a texture multiplies diffuseColor
  bool byNormal = false;   // a cube map is looked up by the normal
};
struct X3dPictures {
  Textures& textures;
  CubeMaps& cubes;
};

// Returns whether a surface has a MultiTexture, a cube map, a back of its own, pictures in its
// Material, an alphaMode, or is not filled.
bool needsX3dMaterial(const X3dParts& parts);
// Returns whether faces are to be left out (FillProperties).
bool isUnfilled(const nodes::Appearance* appearance);
// Sets all parameters of a shader of the class X3DMaterial.
void setX3dMaterial(ShaderSetup& shader, const X3dParts& parts, const X3dPictures& pictures,
                    World& world, bool linear);

} // namespace xvrml::mapper
