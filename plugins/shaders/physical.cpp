// physical.cpp: the surface shader Physical, the metallic-roughness material of glTF 2.0 and of
// PhysicalMaterial in X3D 4. [render]
//
// The BRDF is that of the glTF 2.0 specification, appendix B: a mixture by `metallic` of a metal
// and of a diffuse base under a dielectric layer, both with GGX (alpha is the square of
// `roughness`), height-correlated Smith shadowing and Schlick's Fresnel term. Since the terms are
// linear in F0, the two highlights are one lobe whose F0 is mixed.
//
// The appendix leaves open how much light passes the layer, and its example 1 - F(V.H) creates
// energy at grazing angles. Here the base gets what the layer does not reflect, in a form that is
// reciprocal: T(in) T(out) / mean T (C. Kelemen, L. Szirmay-Kalos, "A Microfacet Based Coupled
// Specular-Matte BRDF Model", Eurographics 2001), T = 1 - directional albedo of the layer.
// A white base therefore reflects all light.
#include <algorithm>

#include "coat.h"
#include "hatch.h"
#include "microfacet.h"

namespace {

// Schlick's approximation (C. Schlick, "An Inexpensive BRDF Model", 1994).
float schlickPower(float cosine) {
  const float x = 1 - cosine, x2 = x * x;
  return x2 * x2 * x;
}
struct Schlick {
  rts::Color f0;
  rts::Color operator()(float cosine) const {
    const float s = schlickPower(cosine);
    return (1 - s) * f0 + rts::Color{s, s, s};
  }
};

// The directional albedo of a microfacet layer is F0 x `scale` + `bias` (B. Karis, "Real Shading in
// Unreal Engine 4", SIGGRAPH 2013, the split sum). The means are weighted with the cosine over the
// hemisphere.
struct Albedo {
  float scale, bias;
};

Albedo between(const Albedo& a, const Albedo& b, float t) {
  return {a.scale + t * (b.scale - a.scale), a.bias + t * (b.bias - a.bias)};
}

// Tables of these numbers, evenly spaced in roughness and in the root of the cosine, and linear
// between entries. Made once, on the committing thread.
class AlbedoTable {
 public:
  AlbedoTable() {
    for (int r = 0; r < widths; r++) {
      for (int c = 0; c < cosines; c++) {
        const float root = std::fmax(5e-3f, float(c) / (cosines - 1));
        entries_[r][c] = integrate(float(r) / (widths - 1), root * root);
      }
      means_[r] = meanOf(entries_[r]);
    }
  }
  static const AlbedoTable& get() {
    static const AlbedoTable table;
    return table;
  }
  Albedo at(float roughness, float cosine) const {
    int r = 0, c = 0;
    const float tr = split(roughness, widths, r),
                tc = split(std::sqrt(std::fmax(0.0f, cosine)), cosines, c);
    return between(between(entries_[r][c], entries_[r][c + 1], tc),
                   between(entries_[r + 1][c], entries_[r + 1][c + 1], tc), tr);
  }
  Albedo mean(float roughness) const {
    int r = 0;
    const float t = split(roughness, widths, r);
    return between(means_[r], means_[r + 1], t);
  }

 private:
  static constexpr int widths = 65, cosines = 97;

  // Writes the entry before x (0..1) to `index` and returns the place after it, 0..1.
  static float split(float x, int count, int& index) {
    const float place = std::fmin(1.0f, std::fmax(0.0f, x)) * float(count - 1);
    index = std::min(static_cast<int>(place), count - 2);
    return place - float(index);
  }
  static Albedo integrate(float roughness, float cosine) {
    constexpr int up = 64, around = 24; // samples; half of the circle, because the rest is equal
    if (!(roughness > 0)) {             // polished: the Fresnel term itself
      const float bias = schlickPower(cosine);
      return {1 - bias, bias};
    }
    const microfacet::Ggx ggx{std::fmax(microfacet::minAlpha, roughness * roughness)};
    const rts::Vec3 o{std::sqrt(std::fmax(0.0f, 1 - cosine * cosine)), 0, cosine};
    double scale = 0, bias = 0;
    for (int a = 0; a < around; a++)
      for (int b = 0; b < up; b++) {
        const rts::Vec3 h =
            ggx.sampleVisibleNormal(o, {(float(a) + .5f) / (2 * around), (float(b) + .5f) / up});
        const float oh = std::fmin(1.0f, std::fmax(0.0f, rts::dot(o, h)));
        const rts::Vec3 i = rts::normalize(2 * oh * h - o);
        if (!(i.z > 0)) continue;
        const double seen = double(ggx.g2OverG1(o, i)), s = double(schlickPower(oh));
        scale += seen * (1 - s);
        bias += seen * s;
      }
    return {float(scale / (up * around)), float(bias / (up * around))};
  }
  // Integrates 2 c E(c) dc = 4 r^3 E dr, r being the root of c. Three nodes of Gauss and Legendre
  // are exact between two entries, where this is a polynomial of degree 4.
  static Albedo meanOf(const Albedo (&row)[cosines]) {
    constexpr double places[] = {.1127016653792583, .5, .8872983346207417},
                     weights[] = {5 / 18., 8 / 18., 5 / 18.};
    double scale = 0, bias = 0;
    for (int c = 0; c + 1 < cosines; c++)
      for (int k = 0; k < 3; k++) {
        const double r = (c + places[k]) / (cosines - 1), w = weights[k] * 4 * r * r * r;
        const Albedo e = between(row[c], row[c + 1], float(places[k]));
        scale += w * double(e.scale) / (cosines - 1);
        bias += w * double(e.bias) / (cosines - 1);
      }
    return {float(scale), float(bias)};
  }

  Albedo entries_[widths][cosines], means_[widths];
};

// The lobe of a white base under a dielectric layer.
struct LayeredDiffuse {
  float f0, roughness, mean; // mean: of the layer's transmittance

  static LayeredDiffuse of(float f0, float roughness) {
    const Albedo e = AlbedoTable::get().mean(roughness);
    return {f0, roughness, std::fmax(1e-6f, 1 - (f0 * e.scale + e.bias))};
  }
  float transmittance(float cosine) const {
    const Albedo e = AlbedoTable::get().at(roughness, cosine);
    return std::fmax(0.0f, 1 - (f0 * e.scale + e.bias));
  }
  rts::Color evaluate(rts::Vec3 toEye, rts::Vec3 direction, rts::Vec3 normal) const {
    const float in = rts::dot(direction, normal);
    if (!(in > 0)) return {};
    const float out = std::fabs(rts::dot(toEye, normal)); // see MicrofacetLobe::upright
    const float value = transmittance(in) * transmittance(out) * in / (rts::pi * mean);
    return {value, value, value};
  }
  float density(rts::Vec3, rts::Vec3 direction, rts::Vec3 normal) const {
    return coat::cosinePdf(direction, normal);
  }
  rts::Vec3 sample(rts::Vec3, rts::Vec2 square, rts::Vec3 normal) const {
    return coat::sampleCosine(square, normal);
  }
};

rts::Color mix(rts::Color a, rts::Color b, float t) { return (1 - t) * a + t * b; }
float unit(float x) { return std::fmin(1.0f, std::fmax(0.0f, x)); }

enum AlphaMode : int32_t { opaque, mask, blend };

struct Physical : rts::Surface<Physical> {
  static constexpr const char* text =
      "metallic-roughness material of glTF 2.0 and X3D 4, with its textures";
  rts::Param<rts::Color> baseColor{
      "baseColor", {1, 1, 1}, "colour of the diffuse base, or reflectance F0 of the metal, 0..1",
      0,           1,         rts::PerVertex};
  rts::Param<float> metallic{"metallic", 1, "0: dielectric; 1: metal", 0, 1};
  rts::Param<float> roughness{"roughness", 1, "root of the width alpha of GGX; 0: polished", 0, 1};
  rts::Param<float> ior{
      "ior", 1.5f, "index of refraction of the dielectric; 1.5: F0 is 0.04; 1: no boundary", 1, 5};
  rts::Param<rts::Color> emissiveColor{"emissiveColor", {0, 0, 0}, "emitted radiance"};
  rts::Param<float> emissiveStrength{"emissiveStrength", 1, "multiplies emissiveColor", 0, 1e6f};
  rts::Param<float> transparency{"transparency", 0, "1 - alpha; needs alphaMode 1 or 2", 0, 1};
  rts::Param<int32_t> alphaMode{
      "alphaMode", opaque, "0: opaque; 1: mask, nothing where alpha is below alphaCutoff; 2: blend",
      0, 2};
  rts::Param<int32_t> vertexAlpha{"vertexAlpha", 0,
                                  "1: the alpha of the geometry's colours stands in place of "
                                  "1 - transparency; 0: it multiplies it",
                                  0, 1};
  rts::Param<float> alphaCutoff{"alphaCutoff", .5f, "smallest alpha that mode 1 shows", 0, 1};
  rts::Param<int32_t> lit{
      "lit", 1, "0: reflects nothing; emissiveTexture then has the alpha (UnlitMaterial)", 0, 1};
  rts::Param<int32_t> irradiance{
      "irradiance", 0,
      "1: the color x intensity of a light with irradiance 1 is its irradiance here, as in X3D 4 "
      "and glTF; 0: pi times as much",
      0, 1};
  rts::Param<int32_t> hatchStyle{
      "hatchStyle", 0,
      "lines over the surface, in pixels of the picture: a style of hatching of ISO/IEC 9973; 0: "
      "none",
      0, 19};
  rts::Param<rts::Color> hatchColor{"hatchColor", {1, 1, 1}, "colour of these lines in any light"};
  rts::Param<rts::Texture> texture{"texture", "multiplies baseColor; its alpha multiplies alpha"};
  rts::Param<rts::Texture> metallicRoughnessTexture{
      "metallicRoughnessTexture", "green multiplies roughness, blue metallic; linear"};
  rts::Param<rts::Texture> emissiveTexture{"emissiveTexture", "multiplies emissiveColor"};
  rts::Param<rts::Texture> normalTexture{
      "normalTexture", "normals in tangent space, 2 x rgb - 1, green along t; linear"};
  rts::Param<float> normalScale{"normalScale", 1, "multiplies x and y of these normals", -100, 100};
  rts::Param<rts::Matrix> textureTransform{
      "textureTransform",
      {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1},
      "matrix from texture coordinates (s, t, 0, 1) to places in the pictures"};
  rts::Param<int32_t> inSpace{
      "inSpace", 0, "1: all pictures, which may be volumes, are placed by texturePlace", 0, 1};
  rts::Param<rts::Vec4> texturePlace{
      "texturePlace",
      {0, 0, 0, 0},
      "texture coordinates s t r q of vertices; with q 0 the geometry's own s and t count",
      rts::PerVertex};

  uint32_t needs() const {
    const bool polished = roughness * roughness <= microfacet::minAlpha;
    uint32_t traits = isMatt() ? 0u : uint32_t(RTS_GLOSSY);
    if (!isMatt() && (polished || metallicRoughnessTexture->id)) traits |= RTS_SPECULAR;
    if (irradiance) traits |= RTS_IRRADIANCE;
    return traits;
  }
  bool emits() const {
    return hatchStyle == 0 && glows(); // light samples need what does not depend on the camera
  }
  const char* prepare() {
    AlbedoTable::get();
    return nullptr;
  }
  rts::Color transmit(const rts::Hit& hit) const {
    const bool blocked = alphaMode == opaque || isHatched(hit);
    const float through = blocked ? 0 : 1 - opacity(hit, pattern(hit));
    return {through, through, through};
  }
  void surface(const rts::Hit& hit, rts::Closures& out) const {
    if (isHatched(hit)) {
      out.albedo(*hatchColor);
      return out.emission(*hatchColor);
    }
    const rts::Vec4 t = pattern(hit);
    const rts::Color own = ownColor(hit, *baseColor);
    const rts::Color base{unit(own.r * t.x), unit(own.g * t.y), unit(own.b * t.z)};
    const float shown = opacity(hit, t);
    const rts::Color shine = lit ? *emissiveColor : ownColor(hit, *emissiveColor);
    out.albedo(lit ? base : shine * rts::Color{t.x, t.y, t.z});
    if (shown < 1) out.transparent({1 - shown, 1 - shown, 1 - shown});
    if (!(shown > 0)) return;
    if (glows()) {
      const rts::Vec4 e = texel(hit, emissiveTexture);
      out.emission(shown * *emissiveStrength * shine * rts::Color{e.x, e.y, e.z});
    }
    if (lit) addLobes(hit, base, shown, out);
  }

 private:
  // Returns whether nothing is reflected before the diffuse base: where the indices on both sides
  // are equal, there is no boundary. Schlick's approximation would reflect at grazing angles.
  bool isMatt() const { return ior == 1 && metallic == 0; }

  bool glows() const {
    return emissiveStrength > 0 &&
           (!lit || emissiveColor->r > 0 || emissiveColor->g > 0 || emissiveColor->b > 0);
  }
  // Returns whether the hit is on a line of the hatching.
  bool isHatched(const rts::Hit& hit) const {
    if (hatchStyle == 0 || hit.line()) return false;
    rts::Vec2 at;
    const bool placed = hit.pixel(at);
    return hatch::covers(hatchStyle, placed, at.x, at.y, true);
  }

  void addLobes(const rts::Hit& hit, rts::Color base, float shown, rts::Closures& out) const {
    const rts::Vec4 factors = texel(hit, metallicRoughnessTexture);
    const float metal = unit(metallic * factors.z), rough = unit(roughness * factors.y);
    const float root = (ior - 1) / (ior + 1), f0 = root * root;
    const Schlick fresnel{mix({f0, f0, f0}, base, metal)};
    rts::Vec3 normal = hit.normal;
    if (normalTexture->id && !hit.line()) {
      normal = mapped(hit);
      out.normal(normal);
    }
    if (isMatt()) return out.diffuse(shown * base);
    out.coat(metal < .5f); // a dielectric's highlight does not have the colour of the surface
    if (rough * rough > microfacet::minAlpha)
      out.custom({shown, shown, shown},
                 microfacet::MicrofacetLobe<Schlick>{rough * rough, fresnel});
    else
      out.reflection(shown * fresnel(unit(-rts::dot(hit.direction, normal))));
    out.coat(false);
    if (metal < 1) out.custom(shown * (1 - metal) * base, LayeredDiffuse::of(f0, rough));
  }

  rts::Vec2 place(const rts::Hit& hit) const {
    const float* m = textureTransform->m;
    return {m[0] * hit.uv.x + m[4] * hit.uv.y + m[12], m[1] * hit.uv.x + m[5] * hit.uv.y + m[13]};
  }
  rts::Vec4 texel(const rts::Hit& hit, rts::Texture from) const {
    if (!from.id || hit.line()) return {1, 1, 1, 1};
    if (inSpace && texturePlace->w != 0) return hit.sampleVolume(from, placeInSpace());
    return hit.sample(from, place(hit));
  }
  // Coordinates are homogeneous. A point at infinity has no place; textures take it for 0.
  rts::Vec3 placeInSpace() const {
    const float* m = textureTransform->m;
    const rts::Vec4 p = *texturePlace;
    const auto row = [&](int i) {
      return m[i] * p.x + m[4 + i] * p.y + m[8 + i] * p.z + m[12 + i] * p.w;
    };
    const float q = row(3);
    return {row(0) / q, row(1) / q, row(2) / q};
  }
  // The colours of a geometry stand in place of the material's (ISO/IEC 19775-1:2023 11.4.2).
  static rts::Color ownColor(const rts::Hit& hit, rts::Color ofMaterial) {
    if ((hit.flags & RTS_HIT_COLOR) == 0) return ofMaterial;
    return {hit.color.x, hit.color.y, hit.color.z};
  }
  // Colours of hits without RTS_HIT_COLOR are not set where the engine calls transmit().
  static float alphaOf(const rts::Hit& hit) {
    return (hit.flags & RTS_HIT_COLOR) != 0 ? hit.color.w : 1.f;
  }
  // Returns the texel that has the alpha.
  rts::Vec4 pattern(const rts::Hit& hit) const {
    return texel(hit, lit ? *texture : *emissiveTexture);
  }
  float opacity(const rts::Hit& hit, rts::Vec4 texel) const {
    if (alphaMode == opaque) return 1;
    const bool replaced = vertexAlpha && (hit.flags & RTS_HIT_COLOR) != 0;
    const float own = replaced ? 1.f : 1 - transparency;
    const float alpha = unit(own * texel.w * alphaOf(hit));
    if (alphaMode == mask) return alpha >= alphaCutoff ? 1 : 0;
    return alpha;
  }

  // Returns the normal of the normal map. Tangent and bitangent run along the picture's axes, as
  // section 3.7.2.1 of glTF 2.0 says where a mesh has no tangents. On the back the whole normal is
  // reversed (3.9.3).
  rts::Vec3 mapped(const rts::Hit& hit) const {
    const rts::Hit::Derivatives d = hit.derivatives();
    const float* m = textureTransform->m;
    const float side = m[0] * m[5] - m[1] * m[4] < 0 ? -1.f : 1.f;
    // Columns of the inverse of the matrix, up to its determinant's size.
    const rts::Vec3 alongS = side * (m[5] * d.alongS - m[1] * d.alongT),
                    alongT = side * (m[0] * d.alongT - m[4] * d.alongS);
    const rts::Vec3 n = hit.normal, tangent = rts::normalize(alongS - rts::dot(alongS, n) * n);
    if (!(rts::length(tangent) > .5f)) return n; // no texture coordinates
    rts::Vec3 bitangent = rts::cross(n, tangent);
    if (rts::dot(bitangent, alongT) < 0) bitangent = -bitangent;
    const rts::Vec4 t = texel(hit, normalTexture);
    const float turned = (hit.back() ? -1.f : 1.f) * normalScale;
    const rts::Vec3 bent =
        rts::normalize(turned * (2 * t.x - 1) * tangent + turned * (2 * t.y - 1) * bitangent +
                       std::fmax(0.f, 2 * t.z - 1) * n);
    // A normal on the far side of the surface is brought to this side.
    const float above = rts::dot(bent, hit.geometric);
    if (above > 1e-3f) return bent;
    const rts::Vec3 lifted = rts::normalize(bent + (2e-3f - above) * hit.geometric);
    return rts::dot(lifted, hit.geometric) > 0 ? lifted : n;
  }
};

} // namespace

RTS_PLUGIN(Physical)
