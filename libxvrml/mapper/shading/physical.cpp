#include "mapper/shading/physical.h"

#include <string>

#include "geometry/node_matrix.h"
#include "mapper/shading/cube_maps.h"
#include "mapper/shading/fill_properties.h"

namespace xvrml::mapper {
namespace {

// Values of the parameter alphaMode.
enum AlphaMode { opaque, mask, blend };

} // namespace

// AUTO blends: an opaque surface then has an alpha of 1 everywhere (ISO/IEC 19775-1:2023 12.4.2).
int alphaModeOf(const nodes::Appearance* appearance, World& world) {
  if (!appearance || appearance->rare.get().alphaMode == "AUTO" ||
      appearance->rare.get().alphaMode == "BLEND")
    return blend;
  if (appearance->rare.get().alphaMode == "OPAQUE") return opaque;
  if (appearance->rare.get().alphaMode == "MASK") return mask;
  world.diagnostics.warn(appearance->source,
                         "alphaMode is \"" + appearance->rare.get().alphaMode +
                             "\", expected AUTO, OPAQUE, MASK or BLEND: AUTO is used");
  return blend;
}

namespace {

// Sets what all materials have.
template <class Material> void setCommon(ShaderSetup& shader, const Material& m,
                                         const AppearanceParts& parts, Textures& textures,
                                         World& world, bool linear) {
  setHatching(shader, parts.plain, linear);
  shader.color("emissiveColor", convert(m.emissiveColor, linear));
  shader.texture("normalTexture", textures.ofData(m.normalTexture.get()));
  shader.number("normalScale", m.normalScale, 0, 100);
  shader.number("transparency", m.transparency, 0, 1);
  shader.integer("alphaMode", alphaModeOf(parts.plain, world));
  shader.number("alphaCutoff", parts.plain ? parts.plain->rare.get().alphaCutoff : 0.5f, 0, 1);
  shader.matrix("textureTransform", textureMatrixOf(firstTransform(parts.textureTransform)));
}

constexpr float standardIndex = 1.5f; // a reflectance of 0.04

void setMaterial(ShaderSetup& shader, const nodes::PhysicalMaterial& m,
                 const AppearanceParts& parts, const LayerPictures& pictures, bool linear) {
  shader.integer("lit", 1);
  shader.integer("irradiance", 1); // ISO/IEC 19775-1:2023 17.2.2.4
  shader.color("baseColor", convert(m.baseColor, linear));
  shader.number("metallic", m.metallic, 0, 1);
  shader.number("roughness", m.roughness, 0, 1);
  shader.number("ior", standardIndex, 1, 5);
  shader.texture("texture", pictures.of(colorTexture(parts)));
  shader.texture("emissiveTexture", pictures.textures.ofNode(m.emissiveTexture.get()));
  shader.texture("metallicRoughnessTexture",
                 pictures.textures.ofData(m.metallicRoughnessTexture.get()));
}

// A surface of glTF that does not reflect at its boundary.
void setMaterial(ShaderSetup& shader, const nodes::Material& m, const AppearanceParts& parts,
                 const LayerPictures& pictures, bool linear) {
  shader.integer("lit", 1);
  shader.integer("irradiance", 1);
  shader.color("baseColor", convert(m.diffuseColor, linear));
  shader.number("metallic", 0, 0, 1);
  shader.number("roughness", 1, 0, 1);
  shader.number("ior", 1, 1, 5);
  shader.texture("texture", pictures.of(colorTexture(parts)));
  shader.texture("emissiveTexture", pictures.textures.ofNode(m.emissiveTexture.get()));
}

// The picture of an UnlitMaterial is its emissiveTexture; an appearance's texture stands for it.
void setUnlit(ShaderSetup& shader, const AppearanceParts& parts, const LayerPictures& pictures) {
  shader.integer("lit", 0);
  shader.texture("emissiveTexture", pictures.of(colorTexture(parts)));
}

} // namespace

void warnOfMappings(const Node& material, std::initializer_list<const std::string*> mappings,
                    World& world) {
  const std::string* first = nullptr;
  for (const std::string* mapping : mappings) {
    if (mapping->empty()) continue;
    if (first && *first != *mapping) {
      world.diagnostics.warn(material.source,
                             material.type().name +
                                 ": pictures with different mappings are not supported; all use "
                                 "the first texture coordinates");
      return;
    }
    first = mapping;
  }
}

bool isPhysical(Node* material) {
  return takesIrradiance(material) || nodeCast<nodes::UnlitMaterial>(material);
}

bool hasPictures(Node& material) {
  if (const auto* m = nodeCast<nodes::Material>(&material))
    return m->ambientTexture || m->emissiveTexture || m->normalTexture || m->shininessTexture ||
           m->specularTexture || (m->diffuseTexture && !isCubeMap(m->diffuseTexture.get()));
  if (const auto* m = nodeCast<nodes::PhysicalMaterial>(&material))
    return m->baseTexture || m->emissiveTexture || m->metallicRoughnessTexture || m->normalTexture;
  if (const auto* m = nodeCast<nodes::UnlitMaterial>(&material)) return bool(m->emissiveTexture);
  return false;
}

void setPhysical(ShaderSetup& shader, const AppearanceParts& parts, const LayerPictures& pictures,
                 World& world, bool linear) {
  if (const auto* m = nodeCast<nodes::PhysicalMaterial>(parts.material)) {
    setCommon(shader, *m, parts, pictures.textures, world, linear);
    setMaterial(shader, *m, parts, pictures, linear);
    if (shader.fresh())
      warnOfMappings(*m,
                     {&m->baseTextureMapping, &m->emissiveTextureMapping,
                      &m->metallicRoughnessTextureMapping, &m->normalTextureMapping},
                     world);
  } else if (const auto* matt = nodeCast<nodes::Material>(parts.material)) {
    setCommon(shader, *matt, parts, pictures.textures, world, linear);
    setMaterial(shader, *matt, parts, pictures, linear);
    const auto& rare = matt->rare.get();
    if (shader.fresh())
      warnOfMappings(
          *matt,
          {&rare.diffuseTextureMapping, &rare.emissiveTextureMapping, &rare.normalTextureMapping},
          world);
  } else if (const auto* flat = nodeCast<nodes::UnlitMaterial>(parts.material)) {
    setCommon(shader, *flat, parts, pictures.textures, world, linear);
    setUnlit(shader, parts, pictures);
  }
}

} // namespace xvrml::mapper
