// materials.cpp: Material, PhysicalMaterial, UnlitMaterial and ImageTexture of glTF's materials,
// and ORTShader for clear bodies.
#include "parse/mesh/gltf/materials.h"

#include <algorithm>
#include <span>

#include <fmt/format.h>

#include "base64.h"
#include "srgb.h"

namespace xvrml::gltf {
namespace {

// KHR_materials_pbrSpecularGlossiness, which older programs write beside or instead of the
// metallic-roughness model.
Item glossiness(const Item& material) {
  return material.extension("KHR_materials_pbrSpecularGlossiness");
}

bool usesGlossiness(const Item& material) {
  return !material.has("pbrMetallicRoughness") && glossiness(material);
}

std::vector<double> baseFactor(const Item& material) {
  return usesGlossiness(material)
             ? glossiness(material).numbers("diffuseFactor", 4)
             : material.object("pbrMetallicRoughness").numbers("baseColorFactor", 4);
}

TexCoordUse useOf(const Item& texture) {
  TexCoordUse use;
  use.set = size_t(texture.count("texCoord", 0));
  const Item transform = texture.extension("KHR_texture_transform");
  if (!transform) return use;
  use.set = size_t(transform.count("texCoord", use.set));
  const auto offset = transform.numbers("offset", 2), scale = transform.numbers("scale", 2);
  if (!offset.empty()) std::copy(offset.begin(), offset.end(), use.offset);
  if (!scale.empty()) std::copy(scale.begin(), scale.end(), use.scale);
  use.rotation = transform.number("rotation", 0);
  return use;
}

float inUnit(double value) { return float(std::clamp(value, 0.0, 1.0)); }

} // namespace

Color encoded(const Color& linear) {
  const auto part = [](float v) { return float(encodeSrgb(double(v))); };
  return {part(linear.r), part(linear.g), part(linear.b)};
}

Materials::Materials(const MeshFile& file, NodeStream& nodes, const Item& root,
                     Accessors& accessors)
    : file_(file), nodes_(nodes), accessors_(accessors), materials_(root.list("materials")),
      textures_(root.list("textures")), images_(root.list("images")),
      samplers_(root.list("samplers")), surfaces_(materials_.size()) {}

bool Materials::isDoubleSided(std::optional<size_t> material) const {
  return material && materials_[*material].boolean("doubleSided", false);
}

bool Materials::isUnlit(const Item& material) const {
  return bool(material.extension("KHR_materials_unlit"));
}

std::string Materials::mappingName(size_t texCoordUse) { return fmt::format("UV{}", texCoordUse); }

// The pictures of a material, with the fields of PhysicalMaterial that show them.
std::vector<Materials::Picture> Materials::picturesOf(const Item& material) const {
  const Item pbr = material.object("pbrMetallicRoughness");
  std::vector<Picture> all = {{"baseTexture", usesGlossiness(material)
                                                  ? glossiness(material).object("diffuseTexture")
                                                  : pbr.object("baseColorTexture")},
                              {"metallicRoughnessTexture", pbr.object("metallicRoughnessTexture")},
                              {"normalTexture", material.object("normalTexture")},
                              {"occlusionTexture", material.object("occlusionTexture")},
                              {"emissiveTexture", material.object("emissiveTexture")}};
  std::erase_if(all, [](const Picture& picture) { return !picture.texture; });
  return all;
}

std::vector<TexCoordUse> Materials::texCoords(std::optional<size_t> material) const {
  return material ? texCoordsOf(materials_[*material]) : std::vector<TexCoordUse>();
}

std::vector<TexCoordUse> Materials::texCoordsOf(const Item& material) const {
  std::vector<TexCoordUse> uses;
  for (const Picture& picture : picturesOf(material)) {
    const TexCoordUse use = useOf(picture.texture);
    if (std::find(uses.begin(), uses.end(), use) == uses.end()) uses.push_back(use);
  }
  return uses;
}

Color Materials::baseColor(std::optional<size_t> material) const {
  return material ? baseColor(materials_[*material]) : Color{1, 1, 1};
}

std::optional<float> Materials::baseAlpha(std::optional<size_t> material) const {
  if (!material) return {};
  const std::string mode = materials_[*material].text("alphaMode");
  if (mode != "BLEND" && mode != "MASK") return {};
  return 1 - transparencyOf(materials_[*material]);
}

Color Materials::baseColor(const Item& material) const {
  return colorOf(baseFactor(material), {1, 1, 1});
}

bool Materials::hasPhysical() const {
  return nodes_.knows("PhysicalMaterial") && nodes_.knows("UnlitMaterial");
}

void Materials::writeSurface(std::optional<size_t> material) {
  if (!material && !hasPhysical()) {
    nodes_.openIn("appearance", "Appearance");
    nodes_.openIn("material", "Material");
    nodes_.closeIn();
    nodes_.closeIn();
    return;
  }
  if (!material) { // the defaults of both standards are the same (glTF 2.0, 3.9.6)
    nodes_.openIn("appearance", "Appearance");
    nodes_.openIn("material", "PhysicalMaterial");
    nodes_.closeIn();
    nodes_.closeIn();
    return;
  }
  std::string_view& def = surfaces_[*material];
  if (!def.empty()) return nodes_.useIn("appearance", def);
  const Item& item = materials_[*material];
  def = nodes_.define(item.text("name"), "Material");
  const std::optional<ClearBody> body = clearBodyOf(item);
  const bool clear = body && nodes_.knows("ORTAppearance");
  nodes_.openIn("appearance", clear ? "ORTAppearance" : "Appearance", def);
  clear ? writeClearBody(item, *body) : writeAppearance(item);
  nodes_.closeIn();
}

void Materials::writeAppearance(const Item& material) {
  if (!hasPhysical())
    writePhong(material);
  else
    isUnlit(material)  ? writeFlat(material)
    : isMatt(material) ? writeMatt(material)
                       : writePhysical(material);
  writeAlpha(material);
  warnOfExtensions(material);
}

void Materials::writeClearBody(const Item& material, const ClearBody& body) {
  const bool polished = body.alpha == 0;
  MFString options = {fmt::format("1f index {}", body.index),
                      fmt::format("3f tint {} {} {}", body.tint.r, body.tint.g, body.tint.b),
                      fmt::format("3f absorption {} {} {}", body.absorption.r, body.absorption.g,
                                  body.absorption.b)};
  if (!polished) options.push_back(fmt::format("1f roughness {}", body.alpha));
  if (polished && body.abbe > 0) options.push_back(fmt::format("1f abbe {}", body.abbe));
  nodes_.openIn("shader", "ORTShader");
  nodes_.set("name", std::string(polished ? "Glass" : "RoughGlass"));
  nodes_.set("file", std::string(polished ? "glass" : "roughglass"));
  nodes_.set("options", std::move(options));
  nodes_.closeIn();
  if (!picturesOf(material).empty())
    material.warn("pictures of a clear body are not supported: they are left out");
  warnOfExtensions(material);
}

// The nearest that VRML97 has: the base colour with its picture. Metals, which have no diffuse
// reflection, become coloured surfaces.
void Materials::writePhong(const Item& material) {
  if (!isUnlit(material)) {
    nodes_.openIn("material", "Material");
    nodes_.set("diffuseColor", encoded(baseColor(material)));
    nodes_.set("emissiveColor", encoded(emissionOf(material)));
    nodes_.set("transparency", transparencyOf(material));
    nodes_.closeIn();
  } else if (!material.object("pbrMetallicRoughness").has("baseColorTexture")) {
    nodes_.openIn("material", "Material");
    nodes_.set("diffuseColor", Color{0, 0, 0});
    nodes_.set("emissiveColor", encoded(baseColor(material)));
    nodes_.set("transparency", transparencyOf(material));
    nodes_.closeIn();
  }
  for (const Picture& picture : picturesOf(material))
    if (picture.field == "baseTexture") writePicture(material, {"texture", picture.texture});
}

void Materials::writeUnlit(std::optional<size_t> material) {
  nodes_.openIn("appearance", "Appearance");
  nodes_.openIn("material", hasPhysical() ? "UnlitMaterial" : "Material");
  nodes_.set("emissiveColor", encoded(baseColor(material)));
  if (material) nodes_.set("transparency", transparencyOf(materials_[*material]));
  nodes_.closeIn();
  nodes_.closeIn();
}

float Materials::transparencyOf(const Item& material) const {
  const std::string mode = material.text("alphaMode");
  if (mode != "BLEND" && mode != "MASK") return 0;
  const std::vector<double> factor = baseFactor(material);
  return factor.empty() ? 0 : inUnit(1 - factor[3]);
}

void Materials::writeAlpha(const Item& material) {
  if (!nodes_.knows("Appearance", "alphaMode")) return;
  const std::string mode = material.text("alphaMode");
  const bool known = mode == "MASK" || mode == "BLEND";
  nodes_.set("alphaMode", known ? mode : std::string("OPAQUE"));
  if (mode == "MASK") nodes_.set("alphaCutoff", inUnit(material.number("alphaCutoff", 0.5)));
}

// KHR_materials_emissive_strength multiplies. Fields of colours end at 1.
Color Materials::emissionOf(const Item& material) {
  const Color factor = colorOf(material.numbers("emissiveFactor", 3), {0, 0, 0});
  const double strength =
      material.extension("KHR_materials_emissive_strength").number("emissiveStrength", 1);
  if (std::max({factor.r, factor.g, factor.b}) * strength > 1)
    material.warn("an emission of more than 1 is not supported: 1 is used");
  const auto part = [&](float value) { return inUnit(double(value) * strength); };
  return {part(factor.r), part(factor.g), part(factor.b)};
}

void Materials::writePhysical(const Item& material) {
  const Item pbr = material.object("pbrMetallicRoughness");
  nodes_.openIn("material", "PhysicalMaterial");
  nodes_.set("baseColor", encoded(baseColor(material)));
  const bool glossy = usesGlossiness(material);
  nodes_.set("metallic", glossy ? 0.0f : inUnit(pbr.number("metallicFactor", 1)));
  nodes_.set("roughness", glossy ? inUnit(1 - glossiness(material).number("glossinessFactor", 1))
                                 : inUnit(pbr.number("roughnessFactor", 1)));
  writeLit(material);
  writePictures(material, {"baseTexture", "metallicRoughnessTexture", "normalTexture",
                           "occlusionTexture", "emissiveTexture"});
  nodes_.closeIn();
}

// Sets what Material and PhysicalMaterial have in common.
void Materials::writeLit(const Item& material) {
  nodes_.set("emissiveColor", encoded(emissionOf(material)));
  nodes_.set("transparency", transparencyOf(material));
  if (const Item normal = material.object("normalTexture")) {
    const double scale = normal.number("scale", 1);
    if (scale < 0) normal.warn("a scale below 0 is not supported: 0 is used");
    nodes_.set("normalScale", float(std::max(0.0, scale)));
  }
  if (const Item occlusion = material.object("occlusionTexture"))
    nodes_.set("occlusionStrength", inUnit(occlusion.number("strength", 1)));
}

// A Material without a specularColor scatters light evenly, as such a surface does.
void Materials::writeMatt(const Item& material) {
  nodes_.openIn("material", "Material");
  nodes_.set("diffuseColor", encoded(baseColor(material)));
  writeLit(material);
  writePictures(material, {"baseTexture", "normalTexture", "occlusionTexture", "emissiveTexture"});
  nodes_.closeIn();
}

// Returns the field of the material's node that shows a picture.
std::string_view Materials::fieldOf(const Item& material, const Picture& picture) const {
  if (picture.field != "baseTexture" || !hasPhysical()) return picture.field;
  return isUnlit(material)  ? "emissiveTexture"
         : isMatt(material) ? "diffuseTexture"
                            : picture.field;
}

// KHR_materials_unlit: the base colour is what is seen.
void Materials::writeFlat(const Item& material) {
  nodes_.openIn("material", "UnlitMaterial");
  nodes_.set("emissiveColor", encoded(baseColor(material)));
  nodes_.set("transparency", transparencyOf(material));
  writePictures(material, {"baseTexture"});
  nodes_.closeIn();
}

void Materials::writePictures(const Item& material,
                              std::initializer_list<std::string_view> fields) {
  for (const Picture& picture : picturesOf(material))
    if (std::find(fields.begin(), fields.end(), picture.field) != fields.end())
      writePicture(material, picture);
}

void Materials::writePicture(const Item& material, const Picture& picture) {
  const auto number = picture.texture.index("index", textures_.size());
  if (!number) return;
  const Item& texture = textures_[*number];
  const std::string_view field = fieldOf(material, picture);
  const std::string url = urlOf(texture);
  if (url.empty()) return;
  // A texture that several materials show is one node.
  const std::string key = fmt::format("{}", *number);
  if (const auto known = shared_.find(key); known != shared_.end()) {
    nodes_.useIn(field, known->second);
  } else {
    const std::string_view def = nodes_.define(texture.text("name"), "Texture");
    shared_.emplace(key, def);
    nodes_.openIn(field, "ImageTexture", def);
    nodes_.setUrl(url);
    writeSampler(texture);
    nodes_.closeIn();
  }
  const std::vector<TexCoordUse> uses = texCoordsOf(material);
  if (uses.size() < 2) return;
  const auto use = std::find(uses.begin(), uses.end(), useOf(picture.texture));
  constexpr std::pair<std::string_view, std::string_view> mappings[] = {
      {"baseTexture", "baseTextureMapping"},
      {"diffuseTexture", "diffuseTextureMapping"},
      {"metallicRoughnessTexture", "metallicRoughnessTextureMapping"},
      {"normalTexture", "normalTextureMapping"},
      {"occlusionTexture", "occlusionTextureMapping"},
      {"emissiveTexture", "emissiveTextureMapping"}};
  for (const auto& [of, mapping] : mappings)
    if (of == field) nodes_.set(mapping, mappingName(size_t(use - uses.begin())));
}

// Pictures in other files keep their URL. Those in the file become data: URLs.
std::string Materials::urlOf(const Item& texture) {
  size_t number = 0;
  if (const auto source = texture.index("source", images_.size())) {
    number = *source;
  } else {
    texture.warn("the texture has no picture that can be read (PNG or JPEG)");
    return {};
  }
  const Item& image = images_[number];
  if (const std::string* uri = image.longText("uri")) return *uri;
  const auto view = image.index("bufferView", accessors_.viewCount());
  const std::string_view bytes = view ? accessors_.viewBytes(*view) : std::string_view();
  if (bytes.empty()) return {};
  std::string url = "data:" + image.text("mimeType") + ";base64,";
  Scratch scratch(file_.budget);
  scratch.take(bytes.size() / 3 * 4 + 4);
  accessors_.spend(bytes.size());
  appendBase64(bytes, url);
  return url;
}

// Filters are hints (3.8.4.1), of which magFilter is followed. It and mirroring need
// TextureProperties, which then say all.
void Materials::writeSampler(const Item& texture) {
  constexpr uint64_t nearest = 9728, clampToEdge = 33071, mirroredRepeat = 33648;
  const auto number = texture.index("sampler", samplers_.size());
  if (!number) return;
  const Item& sampler = samplers_[*number];
  const uint64_t s = sampler.count("wrapS", 0), t = sampler.count("wrapT", 0);
  const bool blocks = sampler.count("magFilter", 0) == nearest,
             mirrored = s == mirroredRepeat || t == mirroredRepeat;
  if (s == clampToEdge) nodes_.set("repeatS", false);
  if (t == clampToEdge) nodes_.set("repeatT", false);
  if (!blocks && !mirrored) return;
  const auto mode = [](uint64_t wrap) {
    return std::string(wrap == clampToEdge      ? "CLAMP_TO_EDGE"
                       : wrap == mirroredRepeat ? "MIRRORED_REPEAT"
                                                : "REPEAT");
  };
  nodes_.openIn("textureProperties", "TextureProperties");
  nodes_.set("boundaryModeS", mode(s));
  nodes_.set("boundaryModeT", mode(t));
  if (blocks) nodes_.set("magnificationFilter", std::string("NEAREST_PIXEL"));
  nodes_.closeIn();
}

void Materials::warnOfExtensions(const Item& material) {
  constexpr std::string_view known[] = {"KHR_materials_unlit", "KHR_materials_emissive_strength",
                                        "KHR_materials_pbrSpecularGlossiness"};
  constexpr std::string_view clear[] = {"KHR_materials_transmission", "KHR_materials_volume",
                                        "KHR_materials_dispersion", "KHR_materials_ior"};
  constexpr std::string_view matt[] = {"KHR_materials_specular", "KHR_materials_ior"};
  const auto has = [](std::span<const std::string_view> list, const std::string& name) {
    return std::find(list.begin(), list.end(), name) != list.end();
  };
  const bool isClear = clearBodyOf(material).has_value(), scatters = isMatt(material);
  for (const std::string& name : material.object("extensions").keys()) {
    if (has(known, name) || (isClear && has(clear, name)) || (scatters && has(matt, name)))
      continue;
    if (warned_.emplace(name, true).second)
      material.warn(fmt::format("{} is not supported: it is left out here and below", name));
  }
}

} // namespace xvrml::gltf
