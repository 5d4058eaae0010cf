#include "mapper/shading/material_parameters.h"

#include "geometry/node_matrix.h"
#include "mapper/shading/cube_maps.h"
#include "xvrml/mapper.h"

namespace xvrml::mapper {
namespace {

// Sets parameters of one shader, where its class has them.
struct Setter {
  ShaderSetup& shader;
  const ShaderClass& shaderClass;
  Textures& textures;
  bool linear;

  bool takes(const char* name, RTenum type) const {
    const auto found = shaderClass.parameters.find(name);
    return found != shaderClass.parameters.end() && found->second == type;
  }
  void color(const char* name, const Color& value) const {
    if (name && takes(name, RT_PARAM_COLOR)) shader.color(name, convert(value, linear));
  }
  void number(const char* name, float value, float high = 1) const {
    if (takes(name, RT_PARAM_FLOAT)) shader.number(name, value, 0, high);
  }
  void data(const char* name, Node* picture) const {
    if (takes(name, RT_PARAM_TEXTURE)) shader.texture(name, textures.ofData(picture));
  }
  void picture(const char* name, Node* picture) const {
    if (takes(name, RT_PARAM_TEXTURE)) shader.texture(name, textures.ofNode(picture));
  }
};

// Material and TwoSidedMaterial, whose front has the same names.
template <class Material> void setLit(const Setter& set, const Material& m) {
  set.color(colorParameterOf(set.shaderClass), m.diffuseColor);
  set.color("emissiveColor", m.emissiveColor);
  set.color("specularColor", m.specularColor);
  set.number("ambientIntensity", m.ambientIntensity);
  set.number("shininess", m.shininess);
  set.number("transparency", m.transparency);
}

// A class with `metallic` has the model of this material, in which roughness is the root of the
// width that other classes call so.
void setPhysical(const Setter& set, const nodes::PhysicalMaterial& m) {
  set.color(colorParameterOf(set.shaderClass), m.baseColor);
  set.color("emissiveColor", m.emissiveColor);
  set.picture("emissiveTexture", m.emissiveTexture.get());
  set.number("transparency", m.transparency);
  set.data("normalTexture", m.normalTexture.get());
  set.number("normalScale", m.normalScale, 100);
  if (!set.takes("metallic", RT_PARAM_FLOAT)) return;
  set.number("metallic", m.metallic);
  set.number("roughness", m.roughness);
  set.data("metallicRoughnessTexture", m.metallicRoughnessTexture.get());
}

} // namespace

const char* colorParameterOf(const ShaderClass& shaderClass) {
  for (const char* name : {"diffuseColor", "baseColor", "color", "reflectance"}) {
    const auto found = shaderClass.parameters.find(name);
    if (found != shaderClass.parameters.end() && found->second == RT_PARAM_COLOR) return name;
  }
  return nullptr;
}

void setMaterialParameters(ShaderSetup& shader, const ShaderClass& shaderClass,
                           const nodes::ORTShader& node, const AppearanceParts& parts,
                           Textures& textures, World& world, bool linear) {
  const Setter set{shader, shaderClass, textures, linear};
  Node* const own = materialValues(parts.material).colorTexture;
  Node* const picture = own && !isCubeMap(own) ? own : parts.texture;
  const RTid texture = textures.ofNode(picture);
  if (set.takes("texture", RT_PARAM_TEXTURE))
    shader.texture("texture", texture);
  else if (picture && shader.fresh())
    world.diagnostics.warn(picture->source,
                           "the shader " + node.name +
                               " has no parameter texture: the picture is not used");
  if (set.takes("textureTransform", RT_PARAM_MATRIX))
    shader.matrix("textureTransform", textureMatrixOf(firstTransform(parts.textureTransform)));
  if (const auto* m = nodeCast<nodes::Material>(parts.material))
    setLit(set, *m);
  else if (const auto* sides = nodeCast<nodes::TwoSidedMaterial>(parts.material))
    setLit(set, *sides);
  else if (const auto* physical = nodeCast<nodes::PhysicalMaterial>(parts.material))
    setPhysical(set, *physical);
  else if (const auto* unlit = nodeCast<nodes::UnlitMaterial>(parts.material))
    set.color(colorParameterOf(shaderClass), unlit->emissiveColor);
}

} // namespace xvrml::mapper

namespace xvrml {

bool takesMaterialColor(const std::string& shaderClass, const std::string& library) {
  return mapper::colorParameterOf(mapper::ShaderClasses().find(shaderClass, library)) != nullptr;
}

} // namespace xvrml
