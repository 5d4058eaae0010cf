// x3d_material.cpp: Material with the slots of X3D 4 (ISO/IEC 19775-1:2023 12.4.5),
// TwoSidedMaterial (ISO/IEC 19775-1 12.4.6) and Appearance.backMaterial as parameters.
#include "mapper/shading/x3d_material.h"

#include <algorithm>
#include <string>

#include "mapper/shading/fill_properties.h"
#include "mapper/shading/layers.h"
#include "mapper/shading/physical.h"

namespace xvrml::mapper {
namespace {

// The names of the parameters of a side.
struct SideNames {
  const char *diffuse, *emissive, *specular, *ambient, *shininess, *transparency;
  const char *ambientTexture, *emissiveTexture, *specularTexture, *shininessTexture, *normalTexture,
      *normalScale;
};
constexpr SideNames front = {"diffuseColor",     "emissiveColor",   "specularColor",
                             "ambientIntensity", "shininess",       "transparency",
                             "ambientTexture",   "emissiveTexture", "specularTexture",
                             "shininessTexture", "normalTexture",   "normalScale"};
constexpr SideNames back = {"backDiffuseColor",     "backEmissiveColor",   "backSpecularColor",
                            "backAmbientIntensity", "backShininess",       "backTransparency",
                            "backAmbientTexture",   "backEmissiveTexture", "backSpecularTexture",
                            "backShininessTexture", "backNormalTexture",   "backNormalScale"};

struct Values {
  Color diffuse, emissive, specular;
  float ambient, shininess, transparency;
};

void setValues(ShaderSetup& shader, const SideNames& side, const Values& v, bool linear) {
  shader.color(side.diffuse, convert(v.diffuse, linear));
  shader.color(side.emissive, convert(v.emissive, linear));
  shader.color(side.specular, convert(v.specular, linear));
  shader.number(side.ambient, v.ambient, 0, 1);
  shader.number(side.shininess, v.shininess, 0, 1);
  shader.number(side.transparency, v.transparency, 0, 1);
}

void setMaterial(ShaderSetup& shader, const SideNames& side, const nodes::Material& m,
                 Textures& textures, bool linear) {
  setValues(shader, side,
            {m.diffuseColor, m.emissiveColor, m.specularColor, m.ambientIntensity, m.shininess,
             m.transparency},
            linear);
  const auto picture = [&](const char* name, const NodeRef& node, bool data = false) {
    const RTid id = data ? textures.ofData(node.get()) : textures.ofNode(node.get());
    if (id != 0 || !shader.fresh()) shader.texture(name, id);
  };
  picture(side.ambientTexture, m.ambientTexture);
  picture(side.emissiveTexture, m.emissiveTexture);
  picture(side.specularTexture, m.specularTexture);
  picture(side.shininessTexture, m.shininessTexture, true);
  picture(side.normalTexture, m.normalTexture, true);
  shader.number(side.normalScale, m.normalScale, 0, 100);
}

void setNoPictures(ShaderSetup& shader, const SideNames& side) {
  if (shader.fresh()) return;
  for (const char* name : {side.ambientTexture, side.emissiveTexture, side.specularTexture,
                           side.shininessTexture, side.normalTexture})
    shader.texture(name, 0);
}

void warnOfMaterialMappings(const nodes::Material& m, World& world) {
  const auto& rare = m.rare.get();
  warnOfMappings(m,
                 {&rare.ambientTextureMapping, &rare.diffuseTextureMapping,
                  &rare.emissiveTextureMapping, &rare.normalTextureMapping,
                  &rare.shininessTextureMapping, &rare.specularTextureMapping},
                 world);
}

// Sets the back of a surface whose appearance has a backMaterial.
void setBack(ShaderSetup& shader, const nodes::Material& m, const AppearanceParts& parts,
             Textures& textures, World& world, bool linear) {
  shader.integer("twoSided", 1);
  setMaterial(shader, back, m, textures, linear);
  // The back without a diffuseTexture has the appearance's texture, which the layers are unless
  // the front has a diffuseTexture.
  Node* own = renderedNode(m.diffuseTexture.get());
  const auto& frontMaterial = static_cast<const nodes::Material&>(*parts.material);
  const bool differs = own != renderedNode(frontMaterial.diffuseTexture.get());
  shader.integer("backPicture", differs ? 1 : 0);
  if (differs) shader.texture("backTexture", textures.ofNode(own ? own : parts.texture));
  if (shader.fresh()) warnOfMaterialMappings(m, world);
}

bool isTransparentMode(const nodes::Appearance* appearance) {
  return !appearance || appearance->rare.get().alphaMode == "AUTO" ||
         appearance->rare.get().alphaMode == "BLEND";
}

} // namespace

bool showsVolume(const AppearanceParts& parts) {
  if (parts.shader) return false;
  Node* texture = renderedNode(colorTexture(parts));
  const auto* multi = nodeCast<nodes::MultiTexture>(texture);
  if (!multi) return isVolume(texture);
  // Only the class X3DMaterial has layers.
  return !isPhysical(parts.material) &&
         std::any_of(multi->texture.begin(), multi->texture.end(),
                     [](const NodeRef& layer) { return isVolume(layer.get()); });
}

bool needsX3dMaterial(const AppearanceParts& parts) {
  if (isUnfilled(parts.plain)) return true;
  if (isPhysical(parts.material)) return false;
  if (isHatched(parts.plain)) return true;
  if (nodeCast<nodes::MultiTexture>(parts.texture) || isCubeMap(parts.texture) ||
      isVolume(parts.texture))
    return true;
  if (nodeCast<nodes::TwoSidedMaterial>(parts.material)) return true;
  const auto* m = nodeCast<nodes::Material>(parts.material);
  if (!m) return false;
  return m->diffuseTexture || hasPictures(*parts.material) || parts.backMaterial ||
         !isTransparentMode(parts.plain);
}

void setX3dMaterial(ShaderSetup& shader, const AppearanceParts& parts, X3dUse use,
                    const X3dPictures& pictures, World& world, bool linear) {
  Textures& textures = pictures.textures;
  shader.integer("inSpace", use.placed || showsVolume(parts) ? 1 : 0);
  shader.integer("filled", isUnfilled(parts.plain) ? 0 : 1);
  setHatching(shader, parts.plain, linear);
  shader.integer("lit", parts.material ? 1 : 0);
  shader.integer("alphaMode", alphaModeOf(parts.plain, world));
  shader.number("alphaCutoff", parts.plain ? parts.plain->rare.get().alphaCutoff : 0.5f, 0, 1);
  Node* texture = parts.texture;
  bool twoSided = false;
  setNoPictures(shader, front);
  setNoPictures(shader, back);
  if (const auto* m = nodeCast<nodes::Material>(parts.material)) {
    setMaterial(shader, front, *m, textures, linear);
    texture = colorTexture(parts);
    if (shader.fresh()) warnOfMaterialMappings(*m, world);
    if (parts.backMaterial) {
      setBack(shader, *parts.backMaterial, parts, textures, world, linear);
      twoSided = true;
    }
  } else if (const auto* both = nodeCast<nodes::TwoSidedMaterial>(parts.material)) {
    setValues(shader, front,
              {both->diffuseColor, both->emissiveColor, both->specularColor, both->ambientIntensity,
               both->shininess, both->transparency},
              linear);
    setValues(shader, back,
              {both->backDiffuseColor, both->backEmissiveColor, both->backSpecularColor,
               both->backAmbientIntensity, both->backShininess, both->backTransparency},
              linear);
    twoSided = both->separateBackColor;
    shader.integer("backPicture", 0);
  }
  shader.integer("twoSided", twoSided ? 1 : 0);
  if (setCubeLayer(shader, texture, pictures.cubes, use.byNormal)) texture = nullptr;
  setLayers(shader, texture, parts.textureTransform, materialValues(parts.material).mapping,
            use.multiplies, {textures, pictures.volumes}, world, linear);
}

} // namespace xvrml::mapper
