// x3d_material.cpp: the class X3DMaterial: the lighting equation of VRML97 with what X3D adds to a
// Material. Its terms are computed here; surface.cpp and global.cpp evaluate them. A class of its
// own keeps VRML97 as fast as it is. [render]
//
// Layers start from the diffuse colour (of an unlit surface: white) and the alpha of the material,
// and their result is the colour that light is reflected in. So a layer with REPLACE is lit, as is
// a texture that replaces diffuseColor in VRML97 (ISO/IEC 14772-1 4.14.3).
#include <algorithm>

#include "vrml97/batch.h"
#include "vrml97/classes.h"
#include "vrml97/global.h"
#include "vrml97/layers.h"
#include "vrml97/texture_groups.h"
#include "vrml97/x3d_cube.h"
#include "vrml97/x3d_hatch.h"
#include "vrml97/x3d_params.h"

namespace vrml97 {
namespace {

// Describes the hit of a lane: its parameters, its side, and what it is made of.
struct Lane {
  const X3dParams& p;
  uint32_t from, side;
  bool lit, line, colored;
};

Lane laneOf(const RtsHits* hits, uint32_t i) {
  const uint32_t from = std::min(i, hits->count - 1), flags = hits->flags[from];
  const X3dParams& p = x3dParamsOf(hits, from);
  return {p,
          from,
          sideOf(p, flags),
          p.front.lit != 0,
          (flags & RTS_HIT_LINE) != 0,
          (flags & RTS_HIT_COLOR) != 0};
}

// Returns the alpha of a lane before any picture. That of the geometry's colours stands in place of
// the material's where vertexAlpha asks for it.
float alphaOf(const Lane& lane, const RtsHits* hits) {
  if (lane.colored && lane.p.front.vertexAlpha)
    return std::clamp(hits->color[3][lane.from], 0.0f, 1.0f);
  if (!lane.lit) return 1;
  return 1 - (lane.side == 1 ? lane.p.backTransparency : lane.p.front.transparency);
}

// Fills the terms from parameters and colours of the geometry.
Summary materials(const RtsHits* hits, uint32_t lanes, const Terms& t) {
  Summary summary;
  for (uint32_t i = 0; i < lanes; i++) {
    const Lane lane = laneOf(hits, i);
    const X3dParams& p = lane.p;
    const bool back = lane.side == 1;
    const float* diffuse = back ? p.backDiffuseColor : p.front.diffuseColor;
    const float* emissive = back ? p.backEmissiveColor : p.front.emissiveColor;
    const float* specular = back ? p.backSpecularColor : p.front.specularColor;
    for (int c = 0; c < 3; c++) {
      const float own = lane.colored ? hits->color[c][lane.from] : 1.0f;
      const bool surface = lane.lit && !lane.line;
      t.glow[c][i] = lane.lit && !(lane.line && lane.colored) ? emissive[c] : own;
      t.diffuse[c][i] = !surface ? 0.0f : lane.colored ? own : diffuse[c];
      t.specular[c][i] = surface ? specular[c] : 0.0f;
      t.ambient[c][i] = back ? p.backAmbientIntensity : p.front.ambientIntensity;
      summary.specular |= t.specular[c][i] != 0.0f;
    }
    t.exponent[i] = 128.0f * (back ? p.backShininess : p.front.shininess);
    t.alpha[i] = alphaOf(lane, hits);
    summary.lit |= lane.lit;
  }
  return summary;
}

// Samples one picture of each lane. choose(lane) returns its texture. Returns false, without
// texels, if no lane has a picture.
class Pictures {
 public:
  Pictures(const RtsHost* host, RtsBatch* batch, const RtsHits* hits, uint32_t lanes)
      : host_(host), batch_(batch), hits_(hits), lanes_(lanes) {
    for (float*& c : rgba) c = host->scratch(batch, lanes);
    components = reinterpret_cast<uint32_t*>(host->scratch(batch, lanes));
    texture_ = reinterpret_cast<RtsTexture*>(host->scratch(batch, lanes));
    for (float*& c : at_) c = host->scratch(batch, lanes);
    for (uint32_t i = 0; i < hits->count; i++) inSpace_ |= isInSpace(x3dParamsOf(hits, i));
  }
  // cubeNormal: unless null, lanes whose layer is a cube map are looked up with this normal.
  template <class Choose>
  bool sample(uint32_t layer, const Choose& choose, const float* const* cubeNormal = nullptr) {
    RtsTexture any = 0;
    for (uint32_t i = 0; i < lanes_; i++) {
      const Lane lane = laneOf(hits_, i);
      any |= texture_[i] = lane.line ? 0 : choose(lane);
      if (isInSpace(lane.p))
        placeInSpace(lane, matrixOf(lane.p, layer), i);
      else
        placeOnPicture(lane, matrixOf(lane.p, layer), i);
    }
    if (cubeNormal) {
      placeInCubes(host_, batch_, hits_, cubeNormal, texture_, at_);
      for (uint32_t i = 0; i < hits_->count; i++) any |= texture_[i];
      for (uint32_t i = hits_->count; i < lanes_; i++) { // the padding repeats the last lane
        texture_[i] = texture_[hits_->count - 1];
        for (float* c : at_) c[i] = c[hits_->count - 1];
      }
    }
    if (any == 0) return false;
    std::fill_n(components, lanes_, 0u);
    sampleGroups(host_, batch_,
                 {hits_->count, texture_, {at_[0], at_[1], inSpace_ ? at_[2] : nullptr}}, rgba,
                 components);
    return true;
  }
  float* rgba[4];
  uint32_t* components; // 0 where a lane has no picture

 private:
  static bool isInSpace(const X3dParams& p) { return p.inSpace != 0 && p.texturePlace[3] != 0; }
  static const float* matrixOf(const X3dParams& p, uint32_t layer) {
    return layer > 0 && p.layerTransforms.count >= numbersPerMatrix * layer
               ? p.layerTransforms.data + numbersPerMatrix * (layer - 1)
               : p.front.textureTransform;
  }
  // The geometry's pair is (s, t, 0, 1), which an affine matrix transforms.
  void placeOnPicture(const Lane& lane, const float* m, uint32_t i) {
    const float u = hits_->uv[0][lane.from], v = hits_->uv[1][lane.from];
    at_[0][i] = m[0] * u + m[4] * v + m[12];
    at_[1][i] = m[1] * u + m[5] * v + m[13];
    at_[2][i] = m[2] * u + m[6] * v + m[14];
  }
  // Coordinates are homogeneous. A point at infinity has no place; textures take it for 0.
  void placeInSpace(const Lane& lane, const float* m, uint32_t i) {
    const float* p = lane.p.texturePlace;
    float place[4];
    for (int k = 0; k < 4; k++)
      place[k] = m[k] * p[0] + m[4 + k] * p[1] + m[8 + k] * p[2] + m[12 + k] * p[3];
    for (int k = 0; k < 3; k++) at_[k][i] = place[k] / place[3];
  }
  const RtsHost* host_;
  RtsBatch* batch_;
  const RtsHits* hits_;
  uint32_t lanes_;
  bool inSpace_ = false; // any lane has three coordinates
  RtsTexture* texture_;
  float* at_[3];
};

bool hasOwnPicture(const Lane& lane) { return lane.side == 1 && lane.p.backPicture != 0; }

RtsTexture layerTexture(const Lane& lane, uint32_t layer) {
  if (hasOwnPicture(lane)) return layer == 0 ? lane.p.backTexture : 0;
  return layer == 0 ? lane.p.front.texture : lane.p.further[layer - 1];
}

// The number of layers of which any lane may have a picture, and whether the first of any lane is a
// cube map.
struct LayerUse {
  uint32_t count = 0;
  bool cubes = false;
};
LayerUse layerUse(const RtsHits* hits) {
  LayerUse use;
  uint32_t& count = use.count;
  const X3dParams* last = nullptr;
  for (uint32_t i = 0; i < hits->count; i++) {
    const X3dParams& p = x3dParamsOf(hits, i);
    if (&p == last) continue;
    last = &p;
    use.cubes |= p.cubeLookup != noCube;
    for (uint32_t k = maxLayers; k > count; k--)
      if ((k == 1 ? p.front.texture | p.backTexture : p.further[k - 2]) != 0) count = k;
  }
  if (use.cubes) count = std::max(count, 1u);
  return use;
}

// Combines the layers. The result is in t.diffuse or, for unlit lanes, t.glow, and in t.alpha.
void combineLayers(const RtsHits* hits, uint32_t lanes, Pictures& pictures, const Terms& t) {
  const LayerUse use = layerUse(hits);
  if (use.count == 0) return;
  for (uint32_t layer = 0; layer < use.count; layer++) {
    if (!pictures.sample(
            layer, [layer](const Lane& lane) { return layerTexture(lane, layer); },
            use.cubes && layer == 0 ? t.normal : nullptr))
      continue;
    for (uint32_t i = 0; i < hits->count; i++) {
      const uint32_t components = pictures.components[i];
      if (components == 0) continue;
      const Lane lane = laneOf(hits, i);
      const X3dParams& p = lane.p;
      const bool back = lane.side == 1;
      float* const* base = lane.lit ? t.diffuse : t.glow;
      LayerColors colors{};
      for (int c = 0; c < 3; c++) {
        colors.current.c[c] = base[c][i];
        colors.diffuse.c[c] = lane.colored ? hits->color[c][i]
                              : !lane.lit  ? 1.0f
                              : back       ? p.backDiffuseColor[c]
                                           : p.front.diffuseColor[c];
        colors.specular.c[c] = !lane.lit ? 1.0f
                               : back    ? p.backSpecularColor[c]
                                         : p.front.specularColor[c];
        colors.factor.c[c] = p.factor[c];
      }
      colors.current.a = t.alpha[i];
      colors.diffuse.a = colors.specular.a = alphaOf(lane, hits);
      colors.factor.a = p.factor[3];
      const Rgba texel = {{pictures.rgba[0][i], pictures.rgba[1][i], pictures.rgba[2][i]},
                          pictures.rgba[3][i]};
      const Rgba result = combined(hasOwnPicture(lane) ? Layer() : layerOf(p, layer, components),
                                   texel, hasAlpha(components), colors);
      for (int c = 0; c < 3; c++) base[c][i] = result.c[c];
      t.alpha[i] = result.a;
    }
  }
  for (uint32_t i = hits->count; i < lanes; i++) t.alpha[i] = t.alpha[hits->count - 1];
}

// Multiplies a term by the picture that each side has for it.
template <class Use> void multiply(const RtsHits* hits, Pictures& pictures,
                                   RtsTexture TermPictures::*picture, const Use& use) {
  if (!pictures.sample(0, [&](const Lane& lane) { return lane.p.pictures[lane.side].*picture; }))
    return;
  for (uint32_t i = 0; i < hits->count; i++)
    if (pictures.components[i] != 0) use(i);
}

// Finishes alpha as Appearance.alphaMode says (ISO/IEC 19775-1:2023 12.4.2).
void finishAlpha(const RtsHits* hits, uint32_t lanes, const Terms& t) {
  for (uint32_t i = 0; i < lanes; i++) {
    const X3dParams& p = laneOf(hits, i).p;
    if (p.alphaMode == alphaOpaque) t.alpha[i] = 1;
    if (p.alphaMode == alphaMask) t.alpha[i] = t.alpha[i] >= p.alphaCutoff ? 1.0f : 0.0f;
    if (!p.filled) t.alpha[i] = 0;
  }
}

struct Vector {
  float x, y, z;
};
Vector operator*(float s, Vector v) { return {s * v.x, s * v.y, s * v.z}; }
Vector operator+(Vector a, Vector b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
Vector operator-(Vector a, Vector b) { return a + -1.0f * b; }
float dot(Vector a, Vector b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Vector cross(Vector a, Vector b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
Vector unit(Vector v) {
  const float length2 = dot(v, v);
  return length2 > 1e-30f && length2 < 1e30f ? 1 / squareRoot(length2) * v : Vector{0, 0, 0};
}

// Returns the normal n, bent by a texel of a normal map. Tangent and bitangent run along the
// picture's axes; on the back the whole normal is reversed, as in the class Physical.
Vector bentNormal(const X3dParams& p, const Vector n, const Vector geometric, Vector alongS,
                  Vector alongT, const Vector map) {
  const float* m = p.front.textureTransform;
  const float side = m[0] * m[5] - m[1] * m[4] < 0 ? -1.0f : 1.0f;
  const Vector s = side * (m[5] * alongS - m[1] * alongT),
               t = side * (m[0] * alongT - m[4] * alongS);
  const Vector tangent = unit(unit(s) - dot(unit(s), n) * n);
  if (dot(tangent, tangent) < .5f) return n; // no texture coordinates
  Vector bitangent = cross(n, tangent);
  if (dot(bitangent, t) < 0) bitangent = -1.0f * bitangent;
  const Vector bent = unit(map.x * tangent + map.y * bitangent + larger(0.0f, map.z) * n);
  // A normal on the far side of the surface is brought to this side.
  const float above = dot(bent, geometric);
  if (above > 1e-3f) return bent;
  const Vector lifted = unit(bent + (2e-3f - above) * geometric);
  return dot(lifted, geometric) > 0 ? lifted : n;
}

void bendNormals(const RtsHost* host, RtsBatch* batch, const RtsHits* hits, uint32_t lanes,
                 Pictures& pictures, Terms& t, Summary& summary) {
  if (!pictures.sample(0, [](const Lane& lane) { return lane.p.pictures[lane.side].normal; }))
    return;
  float *along[6], *bent[3];
  for (float*& a : along) a = host->scratch(batch, lanes);
  for (float*& b : bent) b = host->scratch(batch, lanes);
  host->derivatives(batch, along, along + 3);
  for (int c = 0; c < 3; c++) std::copy_n(hits->normal[c], lanes, bent[c]);
  const auto vector = [](const float* const* v, uint32_t i) {
    return Vector{v[0][i], v[1][i], v[2][i]};
  };
  for (uint32_t i = 0; i < hits->count; i++) {
    if (pictures.components[i] == 0) continue;
    const Lane lane = laneOf(hits, i);
    const float scale =
        (hits->flags[i] & RTS_HIT_BACK ? -1.0f : 1.0f) * lane.p.normalScale[lane.side];
    const Vector texel = vector(pictures.rgba, i);
    const Vector n =
        bentNormal(lane.p, vector(hits->normal, i), vector(hits->geometric, i), vector(along, i),
                   vector(along + 3, i),
                   {scale * (2 * texel.x - 1), scale * (2 * texel.y - 1), 2 * texel.z - 1});
    bent[0][i] = n.x;
    bent[1][i] = n.y;
    bent[2][i] = n.z;
  }
  for (int c = 0; c < 3; c++) t.normal[c] = bent[c];
  summary.bent = true;
}

Terms allocate(const RtsHost* host, RtsBatch* batch, const RtsHits* hits, uint32_t lanes) {
  Terms t;
  for (int c = 0; c < 3; c++) {
    for (float** term : {&t.glow[c], &t.diffuse[c], &t.specular[c], &t.ambient[c]})
      *term = host->scratch(batch, lanes);
    t.normal[c] = hits->normal[c];
  }
  t.exponent = host->scratch(batch, lanes);
  t.alpha = host->scratch(batch, lanes);
  return t;
}

Summary makeX3dTerms(const RtsHost* host, RtsBatch* batch, const RtsHits* hits, Terms& t) {
  const uint32_t lanes = wholeLanes(hits->count);
  t = allocate(host, batch, hits, lanes);
  Summary summary = materials(hits, lanes, t);
  Pictures pictures(host, batch, hits, lanes);
  if (summary.lit) bendNormals(host, batch, hits, lanes, pictures, t, summary);
  combineLayers(hits, lanes, pictures, t);
  const auto byColor = [&](float* const* term) {
    return [&pictures, term](uint32_t i) {
      for (int c = 0; c < 3; c++) term[c][i] *= pictures.rgba[c][i];
    };
  };
  if (summary.lit) {
    multiply(hits, pictures, &TermPictures::emissive, byColor(t.glow));
    multiply(hits, pictures, &TermPictures::ambient, byColor(t.ambient));
    multiply(hits, pictures, &TermPictures::specular, byColor(t.specular));
    multiply(hits, pictures, &TermPictures::shininess,
             [&](uint32_t i) { t.exponent[i] *= pictures.rgba[3][i]; });
  }
  finishAlpha(hits, lanes, t);
  findMirrors(host, batch, hits, t);
  drawHatching(host, batch, hits, t);
  return summary;
}

bool any(const float c[3]) { return c[0] > 0 || c[1] > 0 || c[2] > 0; }

// Returns whether alpha may be below 1 somewhere.
bool maybeTransparent(const RtsHost* host, const X3dParams& p) {
  if (!p.filled) return true;
  if (p.alphaMode == alphaOpaque) return false;
  bool clear = p.front.vertexAlpha != 0;
  clear |= p.front.lit && (p.front.transparency > 0 || (p.twoSided && p.backTransparency > 0));
  const auto alpha = [&](RtsTexture t) { return t != 0 && hasAlpha(host->components(host, t)); };
  clear |= alpha(p.front.texture) || (p.twoSided && alpha(p.backTexture));
  for (const RtsTexture t : p.further) clear |= alpha(t);
  if (p.cubeLookup != noCube) {
    clear |= alpha(p.cubeMap);
    for (const RtsTexture t : p.cube) clear |= alpha(t);
  }
  for (uint32_t k = 0; k < maxLayers; k++)
    clear |= layerOf(p, k, 0).source == LayerSource::factor && p.factor[3] < 1;
  return clear;
}

uint32_t traits(const RtsHost* host, const void* params) {
  const auto& p = *static_cast<const X3dParams*>(params);
  const bool lit = p.front.lit != 0;
  const bool shiny = any(p.front.specularColor) || (p.twoSided && any(p.backSpecularColor)),
             glows = any(p.front.emissiveColor) || (p.twoSided && any(p.backEmissiveColor));
  return (maybeTransparent(host, p) ? uint32_t(RTS_TRANSPARENT) : 0u) |
         (lit ? 0u : uint32_t(RTS_UNLIT) | uint32_t(RTS_NO_SCATTER)) |
         (lit && shiny ? uint32_t(RTS_GLOSSY) : 0u) |
         // Light samples need an emission that does not depend on the camera.
         (((!lit && !p.mirror) || glows) && p.hatchStyle == 0 ? uint32_t(RTS_EMISSIVE) : 0u) |
         (p.mirror ? uint32_t(RTS_SPECULAR) : 0u);
}

// Writes the albedo of mirrors, which is their reflectance.
void showMirrors(const RtsHits* hits, const Terms& t, const float* const reflectance[3],
                 float* const albedo[3]) {
  if (!albedo[0]) return;
  for (uint32_t i = 0; i < hits->count; i++)
    for (int c = 0; c < 3 && t.mirror[i]; c++) albedo[c][i] = reflectance[c][i];
}

void shade(const RtsHost* host, RtsBatch* batch, const RtsHits* hits, RtsShading* out) {
  if (hits->count == 0) return;
  Terms t;
  const Summary summary = makeX3dTerms(host, batch, hits, t);
  const MirrorColors mirrored = takeMirrors(host, batch, hits, t);
  shadeTerms(host, batch, hits, summary, t, out);
  if (!t.mirror) return;
  addMirrored(host, batch, hits, t, mirrored, out->radiance);
  showMirrors(hits, t, mirrored.c, out->albedo);
}

void scatterX3d(const RtsHost* host, RtsBatch* batch, const RtsHits* hits, RtsSurface* out) {
  if (hits->count == 0) return;
  Terms t;
  const Summary summary = makeX3dTerms(host, batch, hits, t);
  scatterTerms(host, batch, hits, summary, t, out);
  if (t.mirror) showMirrors(hits, t, t.diffuse, out->albedo);
}

void transmitX3d(const RtsHost* host, RtsBatch* batch, const RtsHits* hits,
                 float* const transmission[3]) {
  if (hits->count == 0) return;
  const uint32_t lanes = wholeLanes(hits->count);
  const Terms t = allocate(host, batch, hits, lanes);
  materials(hits, lanes, t);
  Pictures pictures(host, batch, hits, lanes);
  combineLayers(hits, lanes, pictures, t);
  finishAlpha(hits, lanes, t);
  drawHatching(host, batch, hits, t);
  for (uint32_t i = 0; i < hits->count; i++)
    for (int c = 0; c < 3; c++) transmission[c][i] = 1.0f - t.alpha[i];
}

RtsClass makeX3dMaterialClass() {
  RtsClass c{};
  const ParamList params = x3dParams();
  c.size = sizeof(RtsClass);
  c.kind = RTS_SURFACE;
  c.name = "X3DMaterial";
  c.text =
      "the material of VRML97 with layers of pictures, pictures of terms and a back of its own";
  c.paramSize = sizeof(X3dParams);
  c.paramCount = params.count;
  c.params = params.data;
  c.frequency = params.frequency;
  c.traits = traits;
  c.shade = shade;
  c.transmit = transmitX3d;
  c.surface = scatterX3d;
  return c;
}

} // namespace

const RtsClass x3dMaterialClass = makeX3dMaterialClass();

} // namespace vrml97
