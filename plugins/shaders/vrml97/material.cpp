// material.cpp: Computes parameters, textures and colours of VRML97 surfaces for each lane. The
// alpha of the geometry's colours is used only where `vertexAlpha` asks for it, because VRML97 has
// none. [render]
#include "vrml97/material.h"

#include <algorithm>
#include <cstddef>

#include "vrml97/batch.h"
#include "vrml97/classes.h"
#include "vrml97/texture_groups.h"

namespace vrml97 {

const RtsParam surfaceParams[] = {
    {"diffuseColor",
     RTS_COLOR,
     offsetof(SurfaceParams, diffuseColor),
     {0.8f, 0.8f, 0.8f},
     0.0f,
     0.0f,
     "diffuse reflectance"},
    {"emissiveColor",
     RTS_COLOR,
     offsetof(SurfaceParams, emissiveColor),
     {0.0f, 0.0f, 0.0f},
     0.0f,
     0.0f,
     "emitted radiance"},
    {"specularColor",
     RTS_COLOR,
     offsetof(SurfaceParams, specularColor),
     {0.0f, 0.0f, 0.0f},
     0.0f,
     0.0f,
     "colour of highlights"},
    {"ambientIntensity",
     RTS_FLOAT,
     offsetof(SurfaceParams, ambientIntensity),
     {0.2f},
     0.0f,
     noLimit,
     "share of the lights' ambient part"},
    {"shininess",
     RTS_FLOAT,
     offsetof(SurfaceParams, shininess),
     {0.2f},
     0.0f,
     noLimit,
     "exponent of highlights over 128"},
    {"transparency",
     RTS_FLOAT,
     offsetof(SurfaceParams, transparency),
     {0.0f},
     0.0f,
     1.0f,
     "share of the light from behind that passes through"},
    {"lit",
     RTS_INT,
     offsetof(SurfaceParams, lit),
     {1.0f},
     0.0f,
     1.0f,
     "0: no material; the surface shows its own colour in any light"},
    {"texture",
     RTS_TEXTURE,
     offsetof(SurfaceParams, texture),
     {},
     0.0f,
     0.0f,
     "picture on the surface"},
    {"textureTransform",
     RTS_MATRIX,
     offsetof(SurfaceParams, textureTransform),
     {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1},
     0.0f,
     0.0f,
     "matrix from texture coordinates (s, t, 0, 1) to places in the picture"},
    {"multiplyTexture",
     RTS_INT,
     offsetof(SurfaceParams, multiplyTexture),
     {0.0f},
     0.0f,
     1.0f,
     "1: a colour texture multiplies diffuseColor, as in X3D; 0: it replaces diffuseColor"},
    {"vertexAlpha",
     RTS_INT,
     offsetof(SurfaceParams, vertexAlpha),
     {0.0f},
     0.0f,
     1.0f,
     "1: the alpha of the geometry's colours stands in place of 1 - transparency, as ColorRGBA of "
     "X3D asks; 0: it is not used"},
};
const uint32_t surfaceParamCount = sizeof(surfaceParams) / sizeof(surfaceParams[0]);

bool isTransparent(const RtsHost* host, const SurfaceParams& p) {
  return p.transparency > 0.0f || p.vertexAlpha ||
         (p.texture != 0 && hasAlpha(host->components(host, p.texture)));
}

namespace {

Terms allocate(const RtsHost* host, RtsBatch* batch, uint32_t lanes) {
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
  t.ambient[0] = t.ambient[1] = t.ambient[2] = next();
  t.exponent = next();
  t.alpha = next();
  return t;
}

// The texels of a batch. Lanes without a texture have 0 components.
struct Texels {
  float* rgba[4];
  uint32_t* components;
};

// Copies one set of parameters to a lane or to a block of lanes.
template <uint32_t count> VRML97_INLINE void spread(const SurfaceParams& p, uint32_t first,
                                                    const Terms& t, Summary& summary) {
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
  fill(t.ambient[0], p.ambientIntensity);
  fill(t.exponent, 128.0f * p.shininess);
  fill(t.alpha, 1.0f - p.transparency);
  summary.lit |= lit;
  summary.textured |= p.texture != 0;
}

// Fills the terms from the parameters. Neighbouring lanes usually have the same parameters, so most
// blocks are filled from one set.
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
      for (uint32_t k = 0; k < RTS_LANES; k++)
        spread<1>(paramsOf(hits, first + std::min(k, used - 1)), first + k, t, summary);
  }
  summary.special = summary.textured || (flags & (RTS_HIT_COLOR | RTS_HIT_LINE)) != 0;
  return summary;
}

// Returns the texture of each lane, or 0, and its transformed coordinates. Lines and points have no
// texture.
TexturePlaces texturePlaces(const RtsHost* host, RtsBatch* batch, const RtsHits* hits,
                            uint32_t lanes) {
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

Texels fetch(const RtsHost* host, RtsBatch* batch, const RtsHits* hits, uint32_t lanes) {
  Texels texels;
  for (float*& c : texels.rgba) c = host->scratch(batch, lanes);
  texels.components = reinterpret_cast<uint32_t*>(host->scratch(batch, lanes));
  std::fill_n(texels.components, lanes, 0u);
  sampleGroups(host, batch, texturePlaces(host, batch, hits, lanes), texels.rgba,
               texels.components);
  return texels;
}

float opacityOf(const RtsHits* hits, uint32_t lane) {
  return smaller(larger(hits->color[3][lane], 0.0f), 1.0f);
}

// Combines material, geometry and texture colours by clauses 4.14.2 and 4.14.3, tables 4.5 (unlit)
// and 4.6 (lit). Lines and points follow clauses 6.24 and 6.36.
void colours(const RtsHits* hits, const Summary& summary, const Texels& texels, const Terms& t) {
  for (uint32_t i = 0; i < hits->count; i++) {
    const bool lit = paramsOf(hits, i).lit != 0, own = (hits->flags[i] & RTS_HIT_COLOR) != 0;
    const bool ownAlpha = own && paramsOf(hits, i).vertexAlpha != 0;
    if (ownAlpha) t.alpha[i] = opacityOf(hits, i);
    if (hits->flags[i] & RTS_HIT_LINE) {
      for (int c = 0; c < 3; c++) {
        if (own) t.glow[c][i] = hits->color[c][i];
        t.diffuse[c][i] = t.specular[c][i] = 0.0f;
      }
      continue;
    }
    const uint32_t components = summary.textured ? texels.components[i] : 0;
    const bool multiplies = components <= 2 || paramsOf(hits, i).multiplyTexture != 0;
    float* const* base = lit ? t.diffuse : t.glow;
    for (int c = 0; c < 3; c++) {
      const float plain = own ? hits->color[c][i] : base[c][i];
      base[c][i] = components == 0 ? plain
                   : multiplies    ? plain * texels.rgba[c][i]
                                   : texels.rgba[c][i];
    }
    if (hasAlpha(components))
      t.alpha[i] = ownAlpha ? t.alpha[i] * texels.rgba[3][i] : texels.rgba[3][i];
  }
}

} // namespace

Summary makeTerms(const RtsHost* host, RtsBatch* batch, const RtsHits* hits, Terms& t) {
  const uint32_t n = wholeLanes(hits->count);
  t = allocate(host, batch, n);
  std::copy_n(hits->normal, 3, t.normal);
  const Summary summary = materials(hits, n, t);
  if (summary.special)
    colours(hits, summary, summary.textured ? fetch(host, batch, hits, n) : Texels{}, t);
  return summary;
}

void albedo(const RtsHits* hits, const Terms& t, float* const* out) {
  for (uint32_t i = 0; i < hits->count; i++) {
    const bool lit = paramsOf(hits, i).lit && !(hits->flags[i] & RTS_HIT_LINE);
    for (int c = 0; c < 3; c++) out[c][i] = lit ? t.diffuse[c][i] : t.glow[c][i];
  }
}

void transmit(const RtsHost* host, RtsBatch* batch, const RtsHits* hits,
              float* const transmission[3]) {
  if (hits->count == 0) return;
  const uint32_t lanes = wholeLanes(hits->count);
  const TexturePlaces places = texturePlaces(host, batch, hits, lanes);
  const bool textured = std::any_of(places.texture, places.texture + hits->count,
                                    [](RtsTexture t) { return t != 0; });
  const Texels texels = textured ? fetch(host, batch, hits, lanes) : Texels{};
  for (uint32_t i = 0; i < hits->count; i++) {
    const SurfaceParams& p = paramsOf(hits, i);
    const bool ownAlpha = p.vertexAlpha && (hits->flags[i] & RTS_HIT_COLOR) != 0;
    const float own = ownAlpha ? opacityOf(hits, i) : 1.0f;
    const float untextured = ownAlpha ? 1.0f - own : p.transparency;
    const float through =
        textured && hasAlpha(texels.components[i]) ? 1.0f - own * texels.rgba[3][i] : untextured;
    for (int c = 0; c < 3; c++) transmission[c][i] = through;
  }
}

} // namespace vrml97
