// surface.cpp: the lighting equation of ISO/IEC 14772-1 clause 4.14, for batches. Thread tag [render].
//
// A batch passes four stages, each a loop over arrays: materials (parameters by lane), textures, lights, result. Where the
// standard is silent: normals are interpolated by pixel, not colours; there is no highlight where N.L <= 0, and a shininess of
// 0 then means one everywhere; shadows take the direct part, never the ambient one. A colour's alpha is no part of VRML97.
#include <algorithm>

#include "vrml97/batch.h"
#include "vrml97/classes.h"
#include "vrml97/texture_groups.h"

namespace vrml97 {
namespace {

struct SurfaceParams {
  float diffuseColor[3];
  float emissiveColor[3];
  float specularColor[3];
  float ambientIntensity;
  float shininess;
  float transparency;
  int32_t lit;
  RtsTexture texture;
  float textureTransform[16];
};

const RtsParam surfaceParams[] = {
    {"diffuseColor",
     RTS_COLOR,
     offsetof(SurfaceParams, diffuseColor),
     {0.8f, 0.8f, 0.8f},
     0.0f,
     0.0f,
     "share of the light that is scattered evenly"},
    {"emissiveColor", RTS_COLOR, offsetof(SurfaceParams, emissiveColor), {0.0f, 0.0f, 0.0f}, 0.0f, 0.0f, "radiance of its own"},
    {"specularColor", RTS_COLOR, offsetof(SurfaceParams, specularColor), {0.0f, 0.0f, 0.0f}, 0.0f, 0.0f, "colour of highlights"},
    {"ambientIntensity",
     RTS_FLOAT,
     offsetof(SurfaceParams, ambientIntensity),
     {0.2f},
     0.0f,
     noLimit,
     "share of the lights' ambient part"},
    {"shininess", RTS_FLOAT, offsetof(SurfaceParams, shininess), {0.2f}, 0.0f, noLimit, "exponent of highlights over 128"},
    {"transparency",
     RTS_FLOAT,
     offsetof(SurfaceParams, transparency),
     {0.0f},
     0.0f,
     1.0f,
     "share of the light behind that is let through"},
    {"lit",
     RTS_INT,
     offsetof(SurfaceParams, lit),
     {1.0f},
     0.0f,
     1.0f,
     "0: no material, the surface has its own colour in any light"},
    {"texture", RTS_TEXTURE, offsetof(SurfaceParams, texture), {}, 0.0f, 0.0f, "picture on the surface"},
    {"textureTransform",
     RTS_MATRIX,
     offsetof(SurfaceParams, textureTransform),
     {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1},
     0.0f,
     0.0f,
     "from texture coordinates (s, t, 0, 1) to places in the picture"},
};

const SurfaceParams& paramsOf(const RtsHits* hits, uint32_t lane) {
  return *static_cast<const SurfaceParams*>(hits->params[lane]);
}

bool hasAlpha(uint32_t components) { return components == 2 || components == 4; }

uint32_t traits(const RtsHost* host, const void* params) {
  const auto& p = *static_cast<const SurfaceParams*>(params);
  const bool transparent = (p.lit && p.transparency > 0.0f) || (p.texture != 0 && hasAlpha(host->components(host, p.texture)));
  return (transparent ? uint32_t(RTS_TRANSPARENT) : 0u) | (p.lit ? 0u : uint32_t(RTS_UNLIT));
}

// The terms of the equation by lane: I = glow + sum over lights of (direct * diffuse * N.L + ...). Unlit lanes have no
// diffuse and specular colour and glow in their own.
struct Terms {
  float* glow[3];     // OE, or the colour of an unlit lane
  float* diffuse[3];  // OD
  float* ambient;     // Oa
  float* specular[3]; // OS
  float* exponent;    // 128 * shininess
  float* alpha;       // A
};

Terms makeTerms(const RtsHost* host, RtsBatch* batch, uint32_t lanes) {
  Terms t;
  float* memory = host->scratch(batch, 12 * lanes);
  const auto next = [&] {
    float* array = memory;
    memory += lanes;
    return array;
  };
  for (int c = 0; c < 3; c++) {
    t.glow[c] = next();
    t.diffuse[c] = next();
    t.specular[c] = next();
  }
  t.ambient = next();
  t.exponent = next();
  t.alpha = next();
  return t;
}

// What the textures and lights stages need to know about a whole batch.
struct Summary {
  bool lit = false, specular = false, textured = false, special = false;
};

// Parameters of one lane, or the same ones of a block of lanes.
template <uint32_t count> VRML97_INLINE void spread(const SurfaceParams& p, uint32_t first, const Terms& t, Summary& summary) {
  const auto fill = [first](float* array, float value) {
    for (uint32_t k = 0; k < count; k++) array[first + k] = value;
  };
  const bool lit = p.lit != 0;
  for (int c = 0; c < 3; c++) {
    fill(t.glow[c], lit ? p.emissiveColor[c] : 1.0f);
    fill(t.diffuse[c], lit ? p.diffuseColor[c] : 0.0f);
    fill(t.specular[c], lit ? p.specularColor[c] : 0.0f);
    summary.specular |= lit & (p.specularColor[c] != 0.0f);
  }
  fill(t.ambient, p.ambientIntensity);
  fill(t.exponent, 128.0f * p.shininess);
  fill(t.alpha, lit ? 1.0f - p.transparency : 1.0f);
  summary.lit |= lit;
  summary.textured |= p.texture != 0;
}

// Lanes of the same parameters usually lie side by side: most blocks are filled from one set.
Summary materials(const RtsHits* hits, uint32_t lanes, const Terms& t) {
  Summary summary;
  uint32_t flags = 0;
  for (uint32_t first = 0; first < lanes; first += RTS_LANES) {
    const void* const* params = hits->params + first;
    const uint32_t used = std::min<uint32_t>(hits->count - first, RTS_LANES);
    bool same = true;
    for (uint32_t k = 0; k < used; k++) {
      same &= params[k] == params[0];
      flags |= hits->flags[first + k];
    }
    if (same)
      spread<RTS_LANES>(paramsOf(hits, first), first, t, summary);
    else
      for (uint32_t k = 0; k < RTS_LANES; k++) spread<1>(paramsOf(hits, first + std::min(k, used - 1)), first + k, t, summary);
  }
  summary.special = summary.textured || (flags & (RTS_HIT_COLOR | RTS_HIT_LINE)) != 0;
  return summary;
}

// The texture of each lane, or 0, and its transformed coordinates. Lines and points are never textured.
TexturePlaces texturePlaces(const RtsHost* host, RtsBatch* batch, const RtsHits* hits, uint32_t lanes) {
  float *s = host->scratch(batch, lanes), *t = host->scratch(batch, lanes);
  auto* texture = reinterpret_cast<RtsTexture*>(host->scratch(batch, lanes));
  for (uint32_t i = 0; i < lanes; i++) {
    const uint32_t from = std::min(i, hits->count - 1);
    const SurfaceParams& p = paramsOf(hits, from);
    const float* m = p.textureTransform;
    const float u = hits->uv[0][from], v = hits->uv[1][from];
    texture[i] = hits->flags[from] & RTS_HIT_LINE ? 0 : p.texture;
    s[i] = m[0] * u + m[4] * v + m[12];
    t[i] = m[1] * u + m[5] * v + m[13];
  }
  return {hits->count, texture, {s, t}};
}

// Texels of a batch: rgba, and components 0 where there is no texture.
struct Texels {
  float* rgba[4];
  uint32_t* components;
};

Texels fetch(const RtsHost* host, RtsBatch* batch, const RtsHits* hits, uint32_t lanes) {
  Texels texels;
  for (float*& c : texels.rgba) c = host->scratch(batch, lanes);
  texels.components = reinterpret_cast<uint32_t*>(host->scratch(batch, lanes));
  std::fill_n(texels.components, lanes, 0u);
  sampleGroups(host, batch, texturePlaces(host, batch, hits, lanes), texels.rgba, texels.components);
  return texels;
}

// Clause 4.14.3, tables 4.5 (unlit) and 4.6 (lit), and the colours of lines and points (clauses 6.24, 6.36).
void colours(const RtsHits* hits, const Summary& summary, const Texels& texels, const Terms& t) {
  for (uint32_t i = 0; i < hits->count; i++) {
    const bool lit = paramsOf(hits, i).lit != 0, own = (hits->flags[i] & RTS_HIT_COLOR) != 0;
    if (hits->flags[i] & RTS_HIT_LINE) {
      for (int c = 0; c < 3; c++) {
        if (own) t.glow[c][i] = hits->color[c][i];
        t.diffuse[c][i] = t.specular[c][i] = 0.0f;
      }
      continue;
    }
    const uint32_t components = summary.textured ? texels.components[i] : 0;
    float* const* base = lit ? t.diffuse : t.glow;
    for (int c = 0; c < 3; c++) {
      const float plain = own ? hits->color[c][i] : base[c][i];
      base[c][i] = components == 0 ? plain : components <= 2 ? plain * texels.rgba[c][i] : texels.rgba[c][i];
    }
    if (hasAlpha(components)) t.alpha[i] = texels.rgba[3][i];
  }
}

// N.L by lane into cosine, and where a shadow ray is worth its time: lit side, some light, something to reflect it.
// Returns whether any lane is.
VRML97_CLONES uint32_t facing(uint32_t n, const float* const* normalIn, const RtsIllumination& light, const Terms& t,
                              float* __restrict cosine, uint8_t* __restrict wanted) {
  const float* __restrict nx = normalIn[0], * __restrict ny = normalIn[1], * __restrict nz = normalIn[2];
  const float* __restrict lx = light.toLight[0], * __restrict ly = light.toLight[1], * __restrict lz = light.toLight[2];
  const float* __restrict r = light.color[0], * __restrict g = light.color[1], * __restrict b = light.color[2];
  const float* __restrict dr = t.diffuse[0], * __restrict dg = t.diffuse[1], * __restrict db = t.diffuse[2];
  const float* __restrict sr = t.specular[0], * __restrict sg = t.specular[1], * __restrict sb = t.specular[2];
  uint32_t any = 0;
  for (uint32_t i = 0; i < n; i++) {
    const float nl = larger(nx[i] * lx[i] + ny[i] * ly[i] + nz[i] * lz[i], 0.0f);
    const float reach = nl * (r[i] + g[i] + b[i]) * (dr[i] + dg[i] + db[i] + sr[i] + sg[i] + sb[i]);
    const uint32_t want = reach > 0.0f ? 1 : 0;
    cosine[i] = nl;
    wanted[i] = static_cast<uint8_t>(want);
    any |= want;
  }
  return any;
}

VRML97_CLONES void addDiffuse(uint32_t n, const float* __restrict cosine, const float* __restrict direct,
                              const float* __restrict ambientLight, const float* __restrict diffuse,
                              const float* __restrict ambient, float* __restrict radiance) {
  for (uint32_t i = 0; i < n; i++) radiance[i] += diffuse[i] * (direct[i] * cosine[i] + ambientLight[i] * ambient[i]);
}

// max(N.H, 0) to the power of the exponent, 0 where N.L <= 0. The sine of the angle between N and H is used, because its
// square keeps the digits that the cosine loses near the top of a highlight, where high exponents need them.
VRML97_CLONES void highlights(uint32_t n, const float* const* normalIn, const float* const* directionIn, float* const* toLight,
                              const float* __restrict cosine, const float* __restrict exponent, float* __restrict factor) {
  const float* __restrict nx = normalIn[0], * __restrict ny = normalIn[1], * __restrict nz = normalIn[2];
  const float* __restrict vx = directionIn[0], * __restrict vy = directionIn[1], * __restrict vz = directionIn[2];
  const float* __restrict lx = toLight[0], * __restrict ly = toLight[1], * __restrict lz = toLight[2];
  for (uint32_t i = 0; i < n; i++) {
    const float hx = lx[i] - vx[i], hy = ly[i] - vy[i], hz = lz[i] - vz[i]; // L + V, not unit
    const float cx = ny[i] * hz - nz[i] * hy, cy = nz[i] * hx - nx[i] * hz, cz = nx[i] * hy - ny[i] * hx;
    const float length2 = larger(hx * hx + hy * hy + hz * hz, 1e-30f);
    const float sine2 = smaller((cx * cx + cy * cy + cz * cz) / length2, 1.0f);
    const float nh = nx[i] * hx + ny[i] * hy + nz[i] * hz;
    const float power = 0.5f * exponent[i] * logOneMinus(sine2); // of cos^2; 0 for exponent 0, whatever the angle
    const float back = nh > 0.0f ? 0.0f : larger(-exponent[i] * 1e30f, vanishing);
    const float dark = cosine[i] > 0.0f ? 0.0f : vanishing;
    factor[i] = expNegative(power + back + dark);
  }
}

VRML97_CLONES void addSpecular(uint32_t n, const float* __restrict factor, const float* __restrict direct,
                               const float* __restrict specular, float* __restrict radiance) {
  for (uint32_t i = 0; i < n; i++) radiance[i] += direct[i] * specular[i] * factor[i];
}

void lights(const RtsHost* host, RtsBatch* batch, const RtsHits* hits, const Summary& summary, const Terms& t,
            float* const* radiance) {
  const uint32_t n = wholeLanes(hits->count), count = host->lights(batch);
  if (count == 0) return;
  float *cosine = host->scratch(batch, n), *factor = summary.specular ? host->scratch(batch, n) : nullptr;
  auto* wanted = reinterpret_cast<uint8_t*>(host->scratch(batch, n));
  for (uint32_t k = 0; k < count; k++) {
    RtsIllumination light{};
    host->illuminate(batch, k, hits, &light);
    if (facing(n, hits->normal, light, t, cosine, wanted)) host->shadow(batch, k, hits, wanted, &light);
    for (int c = 0; c < 3; c++) addDiffuse(n, cosine, light.color[c], light.ambient[c], t.diffuse[c], t.ambient, radiance[c]);
    if (!summary.specular) continue;
    highlights(n, hits->normal, hits->direction, light.toLight, cosine, t.exponent, factor);
    for (int c = 0; c < 3; c++) addSpecular(n, factor, light.color[c], t.specular[c], radiance[c]);
  }
}

VRML97_CLONES void finish(uint32_t n, const float* __restrict alpha, float* __restrict radiance, float* __restrict transmission) {
  for (uint32_t i = 0; i < n; i++) {
    radiance[i] = radiance[i] * alpha[i];
    transmission[i] = 1.0f - alpha[i];
  }
}

// The albedo of a lit lane is its diffuse colour, of an unlit one the colour it shows.
void albedo(const RtsHits* hits, const Terms& t, float* const* out) {
  for (uint32_t i = 0; i < hits->count; i++) {
    const bool lit = paramsOf(hits, i).lit && !(hits->flags[i] & RTS_HIT_LINE);
    for (int c = 0; c < 3; c++) out[c][i] = lit ? t.diffuse[c][i] : t.glow[c][i];
  }
}

void shade(const RtsHost* host, RtsBatch* batch, const RtsHits* hits, RtsShading* out) {
  if (hits->count == 0) return;
  const uint32_t n = wholeLanes(hits->count);
  const Terms t = makeTerms(host, batch, n);
  const Summary summary = materials(hits, n, t);
  if (summary.special) colours(hits, summary, summary.textured ? fetch(host, batch, hits, n) : Texels{}, t);
  if (out->albedo[0]) albedo(hits, t, out->albedo);
  for (int c = 0; c < 3; c++) std::copy_n(t.glow[c], n, out->radiance[c]);
  if (summary.lit) lights(host, batch, hits, summary, t, out->radiance);
  for (int c = 0; c < 3; c++) finish(n, t.alpha, out->radiance[c], out->transmission[c]);
}

// Shadow rays: only 1 - A.
void transmit(const RtsHost* host, RtsBatch* batch, const RtsHits* hits, float* const transmission[3]) {
  if (hits->count == 0) return;
  const uint32_t lanes = wholeLanes(hits->count);
  const TexturePlaces places = texturePlaces(host, batch, hits, lanes);
  const bool textured = std::any_of(places.texture, places.texture + hits->count, [](RtsTexture t) { return t != 0; });
  const Texels texels = textured ? fetch(host, batch, hits, lanes) : Texels{};
  for (uint32_t i = 0; i < hits->count; i++) {
    const SurfaceParams& p = paramsOf(hits, i);
    const float untextured = p.lit ? p.transparency : 0.0f;
    const float through = textured && hasAlpha(texels.components[i]) ? 1.0f - texels.rgba[3][i] : untextured;
    for (int c = 0; c < 3; c++) transmission[c][i] = through;
  }
}

constexpr RtsClass makeSurfaceClass() {
  RtsClass c{};
  c.size = sizeof(RtsClass);
  c.kind = RTS_SURFACE;
  c.name = "VRML97";
  c.text = "the material and texture of VRML97, by its lighting equation";
  c.paramSize = sizeof(SurfaceParams);
  c.paramCount = sizeof(surfaceParams) / sizeof(surfaceParams[0]);
  c.params = surfaceParams;
  c.traits = traits;
  c.shade = shade;
  c.transmit = transmit;
  return c;
}

} // namespace

const RtsClass surfaceClass = makeSurfaceClass();

} // namespace vrml97
