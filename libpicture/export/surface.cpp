#include "libpicture/export/surface.h"

#include <algorithm>
#include <cmath>

#include "libpicture/export/vertices.h"
#include "srgb.h"

namespace picture {

using xvrml::AppearanceParts;
using xvrml::Color;
using xvrml::MaterialValues;
using xvrml::nodeCast;
using Model = xvrml::MaterialValues::Model;

namespace {

// Returns a number in its range; one that is none becomes the lower end.
float clamped(float v, float low, float high) { return v > low ? std::min(v, high) : low; }

Color clamped(const Color& c) { return {between0And1(c.r), between0And1(c.g), between0And1(c.b)}; }

Color notNegative(const Color& c) {
  constexpr float most = 1e6f;
  return {clamped(c.r, 0, most), clamped(c.g, 0, most), clamped(c.b, 0, most)};
}

bool isBlack(const Color& c) { return !(c.r > 0 || c.g > 0 || c.b > 0); }

// Returns whether a texture is a cube map or a volume, which files of other formats do not have.
bool isNoPicture(const xvrml::Node& texture) {
  return texture.type().is("environmentTexture") || texture.type().is("texture3D");
}

std::string nameOf(const AppearanceParts& parts) {
  if (!parts.appearance) return "";
  if (!parts.appearance->defName.empty()) return parts.appearance->defName;
  return parts.material ? parts.material->defName : "";
}

// Sets what Phong's model has, and what stands for it.
void setPhong(Surface& surface, const Color& specular, float shininess) {
  surface.specular = specular;
  surface.exponent = 128 * between0And1(shininess);
  surface.isMatt = isBlack(specular);
  surface.roughness = surface.isMatt ? 1 : roughnessOfShininess(shininess);
}

// alphaMode of X3D 4. AUTO blends where anything is transparent.
void setAlpha(const xvrml::nodes::Appearance* appearance, bool transparent, Surface& surface) {
  surface.alpha = transparent ? Surface::Alpha::blend : Surface::Alpha::opaque;
  if (!appearance) return;
  if (appearance->rare.get().alphaMode == "OPAQUE") surface.alpha = Surface::Alpha::opaque;
  if (appearance->rare.get().alphaMode == "MASK") surface.alpha = Surface::Alpha::mask;
  surface.alphaCutoff = between0And1(appearance->rare.get().alphaCutoff);
}

} // namespace

Color linearOf(const Color& code) {
  const Color c = clamped(code);
  return {decodeSrgb(c.r), decodeSrgb(c.g), decodeSrgb(c.b)};
}

Color codeOf(const Color& linear) {
  const Color c = clamped(linear);
  return {between0And1(encodeSrgb(c.r)), between0And1(encodeSrgb(c.g)),
          between0And1(encodeSrgb(c.b))};
}

float roughnessOfShininess(float shininess) {
  return std::pow(2 / (128 * between0And1(shininess) + 2), 0.25f);
}

float reflectanceOf(float n, float k) {
  const double above = (double(n) - 1) * (double(n) - 1) + double(k) * double(k),
               below = (double(n) + 1) * (double(n) + 1) + double(k) * double(k);
  return between0And1(float(above / below));
}

std::optional<SurfacePicture> Surfaces::pictureOf(const AppearanceParts& parts,
                                                  xvrml::Node* texture) {
  if (!texture) return {};
  // The first layer of an appearance with this picture alone has the transform of all pictures.
  AppearanceParts alone = parts;
  alone.material = nullptr;
  alone.texture = texture;
  const std::vector<xvrml::TextureLayer> layers = xvrml::textureLayers(alone);
  if (layers.empty() || !layers[0].texture) return {};
  const xvrml::TextureLayer& first = layers[0];
  if (isNoPicture(*first.texture)) {
    remarks_.leaveOut(first.texture->type().name);
    return {};
  }
  if (layers.size() > 1) remarks_.change("a MultiTexture becomes its first picture");
  const std::optional<size_t> file = pictures_.of(first.texture);
  if (!file) return {};
  SurfacePicture picture;
  picture.node = first.texture;
  picture.file = *file;
  const double* m = first.transform;
  const std::array<float, 6> numbers = {float(m[0]), float(m[1]),  float(m[4]),
                                        float(m[5]), float(m[12]), float(m[13])};
  if (std::all_of(numbers.begin(), numbers.end(), [](float x) { return std::isfinite(x); }))
    picture.transform = numbers;
  return picture;
}

namespace {

// Returns whether the alpha of a picture multiplies that of a Material, as it does where the
// surface has what X3D adds to VRML97. It replaces it elsewhere.
bool alphaMultiplies(const AppearanceParts& parts, const MaterialValues& values) {
  const auto* plain = parts.plain;
  return values.colorTexture || values.emissiveTexture || values.normalTexture ||
         values.specularTexture || values.ambientTexture || values.shininessTexture ||
         xvrml::backValues(parts) ||
         (plain &&
          (plain->rare.get().alphaMode == "OPAQUE" || plain->rare.get().alphaMode == "MASK")) ||
         nodeCast<xvrml::nodes::MultiTexture>(parts.texture) ||
         nodeCast<xvrml::nodes::TwoSidedMaterial>(parts.material);
}

} // namespace

// The picture of the base colour. In VRML97 one with colours replaces the colour of the material
// and of vertices, a grey one multiplies it, and alpha replaces the transparency (4.14.3). In X3D
// all colours multiply.
void Surfaces::setColorPicture(const AppearanceParts& parts, const MaterialValues& values,
                               Surface& surface) {
  surface.picture = pictureOf(parts, xvrml::colorTexture(parts));
  if (!surface.picture) return;
  const PictureSource::Traits file = pictures_.traitsOf(surface.picture->file);
  const bool physical = values.model == Model::physical || values.model == Model::unlit;
  if (file.components >= 3 && !physical && !parts.texturesMultiply()) {
    surface.color = {1, 1, 1};
    surface.showsVertexColors = false;
  }
  const bool hasAlpha = file.components == 2 || file.components == 4;
  if (hasAlpha && !physical && !alphaMultiplies(parts, values)) surface.opacity = 1;
}

void Surfaces::setMaterial(const AppearanceParts& parts, Surface& surface) {
  const MaterialValues values = xvrml::materialValues(parts.material);
  surface.lit = values.model == Model::phong || values.model == Model::physical;
  surface.takesIrradiance = xvrml::takesIrradiance(parts.material);
  surface.color = linearOf(values.color);
  surface.opacity = 1 - between0And1(values.transparency);
  surface.emission = linearOf(values.emissiveColor);
  if (values.model == Model::phong)
    setPhong(surface, linearOf(values.specularColor), values.shininess);
  if (values.model == Model::physical) {
    surface.metallic = between0And1(values.metallic);
    surface.roughness = between0And1(values.roughness);
  }
  setColorPicture(parts, values, surface);
  if (surface.lit) {
    surface.emissivePicture = pictureOf(parts, values.emissiveTexture);
    surface.normalPicture = pictureOf(parts, values.normalTexture);
    surface.normalScale = clamped(values.normalScale, 0, 100);
    surface.metallicRoughnessPicture = pictureOf(parts, values.metallicRoughnessTexture);
    surface.occlusionPicture = pictureOf(parts, values.occlusionTexture);
  }
  const bool transparent =
      surface.opacity < 1 ||
      (surface.picture && pictures_.traitsOf(surface.picture->file).transparent);
  setAlpha(parts.plain, transparent, surface);
  remarkLost(parts, values);
}

void Surfaces::remarkLost(const AppearanceParts& parts, const MaterialValues& values) {
  if (values.specularTexture || values.ambientTexture || values.shininessTexture)
    remarks_.change("pictures of highlights and of ambient light are left out");
  if (xvrml::backValues(parts)) remarks_.change("backs have the material of the front");
}

Surface Surfaces::make(const AppearanceParts& parts, VertexColors colors, bool lines) {
  Surface surface;
  surface.name = nameOf(parts);
  if (lines) {
    surface.lit = false;
    const MaterialValues values = xvrml::materialValues(parts.material);
    surface.color = linearOf(values.lineColor);
    surface.opacity = 1 - between0And1(values.transparency);
    setAlpha(parts.plain, surface.opacity < 1, surface);
    if (parts.plain && (parts.plain->lineProperties || parts.plain->pointProperties))
      remarks_.change("widths and dashes of lines and sizes of points are left out");
  } else {
    setMaterial(parts, surface);
    if (parts.shader) setShader(parts, surface);
    if (parts.plain && parts.plain->fillProperties)
      remarks_.change("faces that are hatched or not filled are filled");
  }
  surface.showsVertexColors = surface.showsVertexColors && colors != VertexColors::none;
  if (!surface.showsVertexColors) return surface;
  surface.color = {1, 1, 1};
  if (colors == VertexColors::transparent) {
    surface.opacity = 1;
    if (surface.alpha == Surface::Alpha::opaque) surface.alpha = Surface::Alpha::blend;
  }
  return surface;
}

namespace {

// Sets what a class of shaders becomes. Parameters of roughness are alpha of GGX, so that the root
// of it is the roughness of glTF.
using Apply = void (*)(const ShaderValues& values, Surface& surface, Remarks& remarks);

void useMaterial(const ShaderValues& v, Surface& s, Remarks&) {
  s.lit = v.number("lit") > 0;
  s.color = clamped(v.color("diffuseColor"));
  s.emission = notNegative(v.color("emissiveColor"));
  setPhong(s, clamped(v.color("specularColor")), v.number("shininess"));
  s.opacity = 1 - between0And1(v.number("transparency"));
}

void useGlass(const ShaderValues& v, Surface& s, Remarks& remarks) {
  s.color = clamped(v.color("tint"));
  s.transmission = 1;
  s.index = clamped(v.number("index"), 1, 10);
  s.roughness = std::sqrt(between0And1(v.number("roughness")));
  s.absorption = notNegative(v.color("absorption"));
  if (const float abbe = v.number("abbe"); abbe > 0) s.dispersion = clamped(20 / abbe, 0, 100);
  if (!isBlack(v.color("scattering"))) remarks.change("glass that scatters light is clear");
  if (!isBlack(v.color("indexByColor"))) remarks.change("glass has one index for all colours");
}

void useMetal(const ShaderValues& v, Surface& s, Remarks& remarks) {
  const Color n = v.color("n"), k = v.color("k");
  s.color = {reflectanceOf(n.r, k.r), reflectanceOf(n.g, k.g), reflectanceOf(n.b, k.b)};
  s.metallic = 1;
  s.roughness = std::sqrt(between0And1(v.number("roughness")));
  if (v.number("lacquer") > 1) s.clearcoat = 1;
  if (v.number("dust") > 0) remarks.change("dust on a Reflector is left out");
}

void useMirror(const ShaderValues& v, Surface& s, Remarks&) {
  s.color = clamped(v.color("reflectance"));
  s.metallic = 1;
  s.roughness = 0;
}

void usePlastic(const ShaderValues& v, Surface& s, Remarks&) {
  s.color = clamped(v.color("color"));
  s.index = clamped(v.number("index"), 1, 10);
  s.roughness = std::sqrt(between0And1(v.number("roughness")));
  s.opacity = 1 - between0And1(v.number("transparency"));
}

void useCarPaint(const ShaderValues& v, Surface& s, Remarks& remarks) {
  s.color = clamped(v.color("color"));
  s.clearcoat = v.number("index") > 1 ? 1 : 0;
  remarks.change("the flakes of CarPaint are left out");
}

void useDiffuse(const ShaderValues& v, Surface& s, Remarks&) {
  s.color = clamped(v.color("reflectance"));
  s.isMatt = true;
  s.emission = notNegative(v.color("emission"));
}

void usePhong(const ShaderValues& v, Surface& s, Remarks&) {
  s.color = clamped(v.color("diffuseColor"));
  setPhong(s, clamped(v.color("specularColor")), v.number("shininess"));
}

void usePhysical(const ShaderValues& v, Surface& s, Remarks&) {
  const float strength = clamped(v.number("emissiveStrength"), 0, 1e6f);
  const Color e = notNegative(v.color("emissiveColor"));
  s.lit = v.number("lit") > 0;
  s.takesIrradiance = v.number("irradiance") > 0;
  s.color = clamped(v.color("baseColor"));
  s.metallic = between0And1(v.number("metallic"));
  s.roughness = between0And1(v.number("roughness"));
  s.index = clamped(v.number("ior"), 1, 10);
  s.emission = notNegative({e.r * strength, e.g * strength, e.b * strength});
  s.alphaCutoff = between0And1(v.number("alphaCutoff"));
  const float mode = v.number("alphaMode");
  s.alpha = mode > 1   ? Surface::Alpha::blend
            : mode > 0 ? Surface::Alpha::mask
                       : Surface::Alpha::opaque;
  if (mode > 0) s.opacity = 1 - between0And1(v.number("transparency"));
}

struct ShaderRow {
  std::string_view name;
  bool showsVertexColors; // the class has a colour per vertex
  Apply apply;
};
constexpr ShaderRow shaderTable[] = {
    {"CarPaint", false, useCarPaint},   {"Diffuse", true, useDiffuse},
    {"Glass", false, useGlass},         {"GlobalIllumination", true, useMaterial},
    {"Metal", false, useMetal},         {"Mirror", false, useMirror},
    {"Phong", true, usePhong},          {"Physical", true, usePhysical},
    {"Plastic", true, usePlastic},      {"Reflector", false, useMetal},
    {"RoughGlass", false, useGlass},    {"VRML97", true, useMaterial},
    {"X3DMaterial", true, useMaterial},
};

} // namespace

// Returns the picture that the shader itself names, else that of the material.
std::optional<SurfacePicture> Surfaces::ownPicture(const AppearanceParts& parts,
                                                   const ShaderValues& values,
                                                   const std::optional<SurfacePicture>& other) {
  const xvrml::ShaderOption* own = values.given("texture");
  if (!own) return other;
  if (own->picture) return pictureOf(parts, own->picture.get());
  remarks_.change("a picture that an ORTShader names by its URL is left out");
  return {};
}

// Replaces the surface of the material by what the shader does.
void Surfaces::setShader(const AppearanceParts& parts, Surface& surface) {
  const std::string& name = parts.shader->name;
  const std::optional<ShaderValues> values = shaders_.valuesOf(parts);
  if (!values) {
    remarks_.change("no plug-in has the shader " + name + ": surfaces have their material");
    return;
  }
  if (name == "Fog") {
    remarks_.leaveOut("Fog of an ORTShader");
    surface.visible = false;
    return;
  }
  const auto* row = std::find_if(std::begin(shaderTable), std::end(shaderTable),
                                 [&](const ShaderRow& one) { return one.name == name; });
  const bool known = row != std::end(shaderTable);
  // These classes draw the material as it is.
  if (known && row->apply == useMaterial && parts.material) return;
  Surface made;
  made.name = surface.name;
  made.showsVertexColors = known && row->showsVertexColors;
  if (values->has("texture")) made.picture = ownPicture(parts, *values, surface.picture);
  const bool transparent = made.picture && pictures_.traitsOf(made.picture->file).transparent;
  if (transparent) made.alpha = Surface::Alpha::blend;
  if (known) {
    row->apply(*values, made, remarks_);
  } else {
    made.color = clamped(values->color(values->firstColor()));
    remarks_.change("the shader " + name + " becomes a matt surface of its first colour");
  }
  if (made.opacity < 1 && made.alpha == Surface::Alpha::opaque) made.alpha = Surface::Alpha::blend;
  surface = made;
}

} // namespace picture
