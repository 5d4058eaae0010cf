#include "libpicture/export/gltf/materials.h"

#include <algorithm>
#include <cmath>

namespace picture::gltf {

using xvrml::Color;
using xvrml::nodeCast;

namespace {

Json jsonOf(const Color& c) { return Json::array({c.r, c.g, c.b}); }

bool isWhite(const Color& c) { return c.r == 1 && c.g == 1 && c.b == 1; }

float largestOf(const Color& c) { return std::max({c.r, c.g, c.b}); }

bool isPlain(const std::array<float, 6>& transform) {
  return transform == std::array<float, 6>{1, 0, 0, 1, 0, 0};
}

// Adds an extension to an object and to the document.
void extend(Json& object, const char* name, Json content, Document& document) {
  document.use(name);
  object["extensions"][name] = std::move(content);
}

// emissiveFactor ends at 1; a strength multiplies it.
void setEmission(const Surface& surface, Json& material, Document& document) {
  const Color& e = surface.emission;
  const float largest = largestOf(e);
  if (!(largest > 0)) return;
  const float strength = std::max(largest, 1.0f);
  material["emissiveFactor"] = jsonOf({e.r / strength, e.g / strength, e.b / strength});
  if (strength > 1)
    extend(material, "KHR_materials_emissive_strength", {{"emissiveStrength", strength}}, document);
}

// Light that passes through a body. Its colour after the mean free path of the colour that is
// absorbed most is attenuationColor.
void setTransmission(const Surface& surface, float thickness, Json& material, Document& document) {
  if (!(surface.transmission > 0)) return;
  extend(material, "KHR_materials_transmission", {{"transmissionFactor", surface.transmission}},
         document);
  Json volume = {{"thicknessFactor", thickness}};
  const Color& a = surface.absorption;
  if (const float most = largestOf(a); most > 0) {
    volume["attenuationDistance"] = 1 / most;
    volume["attenuationColor"] =
        jsonOf({std::exp(-a.r / most), std::exp(-a.g / most), std::exp(-a.b / most)});
  }
  extend(material, "KHR_materials_volume", std::move(volume), document);
  if (surface.dispersion > 0)
    extend(material, "KHR_materials_dispersion", {{"dispersion", surface.dispersion}}, document);
}

constexpr int clampToEdge = 33071, mirroredRepeat = 33648, repeat = 10497;

int wrapOf(bool repeats) { return repeats ? repeat : clampToEdge; }

int wrapOf(const std::string& mode) {
  return mode == "REPEAT" ? repeat : mode == "MIRRORED_REPEAT" ? mirroredRepeat : clampToEdge;
}

// How a texture node goes on beyond its edges, and how it is enlarged.
struct Sampling {
  int s = repeat, t = repeat;
  bool nearest = false;
};

template <class T> bool samplingOf(const xvrml::Node& node, Sampling& sampling) {
  const auto* texture = nodeCast<T>(&node);
  if (!texture) return false;
  sampling.s = wrapOf(texture->repeatS);
  sampling.t = wrapOf(texture->repeatT);
  const auto* own = nodeCast<xvrml::nodes::TextureProperties>(
      xvrml::renderedNode(texture->textureProperties.get()));
  if (own)
    sampling = {wrapOf(own->boundaryModeS), wrapOf(own->boundaryModeT),
                own->magnificationFilter == "NEAREST_PIXEL"};
  return true;
}

} // namespace

// With D = diag(1, -1) and e = (0, 1), u v = D (s t) + e. So s t -> A (s t) + b is u v -> D A D (u
// v)
// + D (A e + b) + e. The columns of D A D are those of a rotation times the scales.
std::optional<TextureTransform> textureTransformOf(const std::array<float, 6>& transform) {
  const auto& [a, b, c, d, e, f] = transform;
  const double x[2] = {a, -double(b)}, y[2] = {-double(c), d};
  const double xLength = std::hypot(x[0], x[1]), yLength = std::hypot(y[0], y[1]);
  TextureTransform out;
  out.offset[0] = c + e;
  out.offset[1] = 1 - (d + f);
  // The first column is (cos, -sin) times its scale, the second one (sin, cos) times its own.
  const double angle = xLength > 0 ? std::atan2(-x[1], x[0]) : std::atan2(y[0], y[1]);
  const double sine = std::sin(angle), cosine = std::cos(angle);
  if (std::abs(y[0] * cosine - y[1] * sine) > 1e-5 * std::max(yLength, 1e-30)) return {};
  out.rotation = float(angle);
  out.scale[0] = float(xLength);
  out.scale[1] = float(y[0] * sine + y[1] * cosine);
  return out;
}

Json materialOf(const Surface& surface, bool doubleSided, float thickness, Document& document) {
  Json pbr = {{"metallicFactor", surface.metallic}, {"roughnessFactor", surface.roughness}};
  if (!isWhite(surface.color) || surface.opacity < 1)
    pbr["baseColorFactor"] = {surface.color.r, surface.color.g, surface.color.b, surface.opacity};
  Json material = {{"pbrMetallicRoughness", std::move(pbr)}};
  if (!surface.name.empty()) material["name"] = surface.name;
  // KHR_materials_volume wants bodies whose faces have one side.
  if (doubleSided && !(surface.transmission > 0)) material["doubleSided"] = true;
  if (surface.alpha == Surface::Alpha::blend) material["alphaMode"] = "BLEND";
  if (surface.alpha == Surface::Alpha::mask) {
    material["alphaMode"] = "MASK";
    material["alphaCutoff"] = surface.alphaCutoff;
  }
  if (!surface.lit) {
    extend(material, "KHR_materials_unlit", Json::object(), document);
    return material;
  }
  setEmission(surface, material, document);
  setTransmission(surface, thickness, material, document);
  if (surface.index != 1.5f)
    extend(material, "KHR_materials_ior", {{"ior", surface.index}}, document);
  if (surface.isMatt) extend(material, "KHR_materials_specular", {{"specularFactor", 0}}, document);
  if (surface.clearcoat > 0)
    extend(material, "KHR_materials_clearcoat", {{"clearcoatFactor", surface.clearcoat}}, document);
  return material;
}

size_t Materials::samplerOf(const xvrml::Node& texture) {
  Sampling sampling;
  (void)(samplingOf<xvrml::nodes::ImageTexture>(texture, sampling) ||
         samplingOf<xvrml::nodes::PixelTexture>(texture, sampling) ||
         samplingOf<xvrml::nodes::MovieTexture>(texture, sampling));
  constexpr int nearest = 9728, linear = 9729, linearMipmapLinear = 9987;
  const Json sampler = {{"wrapS", sampling.s},
                        {"wrapT", sampling.t},
                        {"magFilter", sampling.nearest ? nearest : linear},
                        {"minFilter", linearMipmapLinear}};
  const auto [found, fresh] = samplers_.try_emplace(textOf(sampler));
  if (fresh) found->second = document_.add("samplers", sampler);
  return found->second;
}

// Returns the object that refers to a texture.
Json Materials::textureOf(const SurfacePicture& picture) {
  const size_t sampler = samplerOf(*picture.node);
  const auto [found, fresh] = textures_.try_emplace({picture.file, sampler});
  if (fresh)
    found->second = document_.add("textures", {{"source", picture.file}, {"sampler", sampler}});
  Json info = {{"index", found->second}};
  const auto t = textureTransformOf(picture.transform);
  if (!t || isPlain(picture.transform)) return info;
  Json transform = Json::object();
  if (t->offset[0] != 0 || t->offset[1] != 0) transform["offset"] = {t->offset[0], t->offset[1]};
  if (t->rotation != 0) transform["rotation"] = t->rotation;
  if (t->scale[0] != 1 || t->scale[1] != 1) transform["scale"] = {t->scale[0], t->scale[1]};
  extend(info, "KHR_texture_transform", std::move(transform), document_);
  return info;
}

MaterialUse Materials::write(const Surface& surface, bool doubleSided, float thickness) {
  MaterialUse use;
  if (!surface.visible) return use;
  use.showsVertexColors = surface.showsVertexColors;
  Json material = materialOf(surface, doubleSided, thickness, document_);
  const auto show = [&](const std::optional<SurfacePicture>& picture, const char* name,
                        Json& object) -> Json* {
    if (!picture) return nullptr;
    use.textured = true;
    // All pictures of an appearance have one transform.
    if (!textureTransformOf(picture->transform)) use.bakedTransform = picture->transform;
    return &(object[name] = textureOf(*picture));
  };
  Json& pbr = material["pbrMetallicRoughness"];
  show(surface.picture, "baseColorTexture", pbr);
  show(surface.metallicRoughnessPicture, "metallicRoughnessTexture", pbr);
  show(surface.emissivePicture, "emissiveTexture", material);
  if (Json* normal = show(surface.normalPicture, "normalTexture", material))
    (*normal)["scale"] = surface.normalScale;
  if (Json* occlusion = show(surface.occlusionPicture, "occlusionTexture", material))
    (*occlusion)["strength"] = surface.occlusionStrength;
  use.material = document_.add("materials", material);
  return use;
}

MaterialUse Materials::use(const xvrml::AppearanceParts& parts, VertexColors colors, bool lines,
                           bool doubleSided, float thickness) {
  const auto [found, fresh] = known_.try_emplace({parts.appearance, colors, lines, doubleSided});
  if (fresh) found->second = write(surfaces_.make(parts, colors, lines), doubleSided, thickness);
  return found->second;
}

} // namespace picture::gltf
