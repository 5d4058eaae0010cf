// appearance.cpp: finds what an appearance consists of.
#include "xvrml/appearance.h"

#include "geometry/node_matrix.h"

namespace xvrml {
namespace {

Node* pictureIn(const NodeRef& field) { return renderedNode(field.get()); }

template <class T> void setSurface(const T& appearance, AppearanceParts& parts) {
  parts.material = renderedNode(appearance.material.get());
  parts.texture = renderedNode(appearance.texture.get());
  parts.textureTransform = renderedNode(appearance.textureTransform.get());
}

// Returns the first mapping that a picture of a Material names.
std::string_view mappingOf(const nodes::Material& m) {
  const auto& rare = m.rare.get();
  for (const std::string* mapping :
       {&rare.diffuseTextureMapping, &rare.emissiveTextureMapping, &rare.ambientTextureMapping,
        &rare.normalTextureMapping, &rare.shininessTextureMapping, &rare.specularTextureMapping})
    if (!mapping->empty()) return *mapping;
  return {};
}

// Material and TwoSidedMaterial, whose front has the same names.
template <class T> MaterialValues phongValues(const T& m) {
  MaterialValues values;
  values.model = MaterialValues::Model::phong;
  values.color = m.diffuseColor;
  values.emissiveColor = values.lineColor = m.emissiveColor;
  values.specularColor = m.specularColor;
  values.ambientIntensity = m.ambientIntensity;
  values.shininess = m.shininess;
  values.transparency = m.transparency;
  return values;
}

MaterialValues valuesOf(const nodes::Material& m) {
  MaterialValues values = phongValues(m);
  values.normalScale = m.normalScale;
  values.colorTexture = pictureIn(m.diffuseTexture);
  values.emissiveTexture = pictureIn(m.emissiveTexture);
  values.specularTexture = pictureIn(m.specularTexture);
  values.ambientTexture = pictureIn(m.ambientTexture);
  values.shininessTexture = pictureIn(m.shininessTexture);
  values.normalTexture = pictureIn(m.normalTexture);
  values.occlusionTexture = pictureIn(m.occlusionTexture);
  values.mapping = mappingOf(m);
  return values;
}

MaterialValues valuesOf(const nodes::PhysicalMaterial& m) {
  MaterialValues values;
  values.model = MaterialValues::Model::physical;
  values.color = m.baseColor;
  values.emissiveColor = values.lineColor = m.emissiveColor;
  values.metallic = m.metallic;
  values.roughness = m.roughness;
  values.transparency = m.transparency;
  values.normalScale = m.normalScale;
  values.colorTexture = pictureIn(m.baseTexture);
  values.emissiveTexture = pictureIn(m.emissiveTexture);
  values.normalTexture = pictureIn(m.normalTexture);
  values.metallicRoughnessTexture = pictureIn(m.metallicRoughnessTexture);
  values.occlusionTexture = pictureIn(m.occlusionTexture);
  return values;
}

MaterialValues valuesOf(const nodes::UnlitMaterial& m) {
  MaterialValues values;
  values.model = MaterialValues::Model::unlit;
  values.color = values.lineColor = m.emissiveColor;
  values.transparency = m.transparency;
  values.normalScale = m.normalScale;
  values.colorTexture = pictureIn(m.emissiveTexture);
  values.normalTexture = pictureIn(m.normalTexture);
  return values;
}

} // namespace

bool AppearanceParts::texturesMultiply() const {
  return appearance && versionOf(*appearance).texturesMultiply();
}

AppearanceParts resolveAppearance(Node* appearance) {
  AppearanceParts parts;
  parts.appearance = renderedNode(appearance);
  if (auto* plain = nodeCast<nodes::Appearance>(parts.appearance)) {
    setSurface(*plain, parts);
    parts.plain = plain;
    if (nodeCast<nodes::Material>(parts.material))
      parts.backMaterial = nodeCast<nodes::Material>(renderedNode(plain->backMaterial.get()));
  } else if (auto* custom = nodeCast<nodes::ORTAppearance>(parts.appearance)) {
    setSurface(*custom, parts);
    parts.shader = nodeCast<nodes::ORTShader>(renderedNode(custom->shader.get()));
  }
  return parts;
}

bool takesIrradiance(const Node* material) {
  if (nodeCast<nodes::PhysicalMaterial>(material)) return true;
  const auto* matt = nodeCast<nodes::Material>(material);
  return matt && versionOf(*matt).encoding == Encoding::gltf;
}

MaterialValues materialValues(Node* material) {
  Node* node = renderedNode(material);
  if (const auto* m = nodeCast<nodes::Material>(node)) return valuesOf(*m);
  if (const auto* m = nodeCast<nodes::TwoSidedMaterial>(node)) return phongValues(*m);
  if (const auto* m = nodeCast<nodes::PhysicalMaterial>(node)) return valuesOf(*m);
  if (const auto* m = nodeCast<nodes::UnlitMaterial>(node)) return valuesOf(*m);
  return {};
}

std::optional<MaterialValues> backValues(const AppearanceParts& parts) {
  if (parts.backMaterial) return valuesOf(*parts.backMaterial);
  const auto* both = nodeCast<nodes::TwoSidedMaterial>(parts.material);
  if (!both || !both->separateBackColor) return {};
  MaterialValues values = phongValues(*both);
  values.color = both->backDiffuseColor;
  values.emissiveColor = both->backEmissiveColor;
  values.specularColor = both->backSpecularColor;
  values.ambientIntensity = both->backAmbientIntensity;
  values.shininess = both->backShininess;
  values.transparency = both->backTransparency;
  return values;
}

namespace {

// Returns a node if it transforms texture coordinates by a matrix, else null.
const Node* singleTransform(Node* node) {
  Node* rendered = renderedNode(node);
  const bool single = nodeCast<nodes::TextureTransform>(rendered) ||
                      nodeCast<nodes::TextureTransform3D>(rendered) ||
                      nodeCast<nodes::TextureTransformMatrix3D>(rendered);
  return single ? rendered : nullptr;
}

std::string_view mappingOf(const Node* transform) {
  if (const auto* t = nodeCast<nodes::TextureTransform>(transform)) return t->mapping;
  if (const auto* t = nodeCast<nodes::TextureTransform3D>(transform)) return t->mapping;
  if (const auto* t = nodeCast<nodes::TextureTransformMatrix3D>(transform)) return t->mapping;
  return {};
}

} // namespace

const Node* firstTransform(Node* textureTransform, std::string_view mapping) {
  Node* node = renderedNode(textureTransform);
  const auto* multi = nodeCast<nodes::MultiTextureTransform>(node);
  if (!multi) return singleTransform(node);
  if (!mapping.empty())
    for (const NodeRef& part : multi->textureTransform)
      if (const Node* t = singleTransform(part.get()); t && mappingOf(t) == mapping) return t;
  if (multi->textureTransform.empty()) return nullptr;
  return singleTransform(multi->textureTransform[0].get());
}

const Node* layerTransform(Node* textureTransform, size_t layer, std::string_view mapping) {
  if (layer == 0) return firstTransform(textureTransform, mapping);
  const auto* multi = nodeCast<nodes::MultiTextureTransform>(renderedNode(textureTransform));
  if (!multi || layer >= multi->textureTransform.size()) return nullptr;
  return singleTransform(multi->textureTransform[layer].get());
}

namespace {

TextureLayer layerOf(Node* texture, const Node* transform) {
  TextureLayer layer;
  layer.texture = texture;
  const Matrix matrix = textureMatrixOf(transform);
  if (finite(matrix)) toArray(matrix, layer.transform);
  return layer;
}

std::string wordAt(const MFString& words, size_t i) {
  return i < words.size() ? words[i] : std::string();
}

} // namespace

Node* colorTexture(const AppearanceParts& parts) {
  Node* own = materialValues(parts.material).colorTexture;
  return own ? own : parts.texture;
}

std::vector<TextureLayer> textureLayers(const AppearanceParts& parts) {
  Node* texture = colorTexture(parts);
  if (!texture) return {};
  const std::string_view mapping = materialValues(parts.material).mapping;
  const auto transform = [&](size_t layer) {
    return layerTransform(parts.textureTransform, layer, mapping);
  };
  const auto* multi = nodeCast<nodes::MultiTexture>(texture);
  if (!multi) return {layerOf(texture, transform(0))};
  std::vector<TextureLayer> layers;
  for (size_t i = 0; i < multi->texture.size(); ++i) {
    TextureLayer& layer =
        layers.emplace_back(layerOf(renderedNode(multi->texture[i].get()), transform(i)));
    layer.mode = wordAt(multi->mode, i);
    layer.source = wordAt(multi->source, i);
    layer.function = wordAt(multi->function, i);
  }
  return layers;
}

} // namespace xvrml
