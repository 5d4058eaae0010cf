// x3d_material.h: surfaces that need what X3D adds to a Material, as parameters of the shader class
// X3DMaterial. All others keep the class VRML97. [the mapper's thread]
#pragma once

#include "mapper/rt.h"
#include "mapper/shading/cube_maps.h"
#include "mapper/shading/textures.h"
#include "mapper/shading/volumes.h"
#include "xvrml/appearance.h"
#include "xvrml/nodes.h"
#include "xvrml/world.h"

namespace xvrml::mapper {

// Says how the pictures of a surface are used.
struct X3dUse {
  bool multiplies = false; // a texture multiplies diffuseColor
  bool byNormal = false;   // a cube map is looked up by the normal
  bool placed = false;     // the geometry has texture coordinates in space
};
struct X3dPictures {
  Textures& textures;
  CubeMaps& cubes;
  Volumes& volumes;
};

// Returns whether a surface has a MultiTexture, a cube map, a volume, a back of its own, pictures
// in its Material, an alphaMode, or FillProperties that the class Physical does not draw.
bool needsX3dMaterial(const AppearanceParts& parts);
// Returns whether a surface shows a volume, alone or in a MultiTexture.
bool showsVolume(const AppearanceParts& parts);
// Sets all parameters of a shader of the class X3DMaterial.
void setX3dMaterial(ShaderSetup& shader, const AppearanceParts& parts, X3dUse use,
                    const X3dPictures& pictures, World& world, bool linear);

} // namespace xvrml::mapper
