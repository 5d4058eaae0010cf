// material.h: the first stages of shading a batch of VRML97 hits: parameters by lane, textures and
// colours (ISO/IEC 14772-1 clause 4.14). surface.cpp (lighting equation) and global.cpp (lobes) use
// the result. [render]
#pragma once

#include <cstdint>

#include "openrt/openrts.h"

namespace vrml97 {

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
  int32_t multiplyTexture;
  int32_t vertexAlpha;
};

extern const RtsParam surfaceParams[];
extern const uint32_t surfaceParamCount;

inline const SurfaceParams& paramsOf(const RtsHits* hits, uint32_t lane) {
  return *static_cast<const SurfaceParams*>(hits->params[lane]);
}
inline bool hasAlpha(uint32_t components) { return components == 2 || components == 4; }
bool isTransparent(const RtsHost* host, const SurfaceParams& params);

// The terms of the lighting equation, by lane: I = glow + sum over lights of (direct * diffuse *
// N.L + ...). Unlit lanes have only the term glow, which is their colour.
struct Terms {
  float* glow[3];         // OE, or the colour of an unlit lane
  float* diffuse[3];      // OD
  float* ambient[3];      // Oa; one array for all three where it has no colour
  float* specular[3];     // OS
  float* exponent;        // 128 * shininess
  float* alpha;           // A
  const float* normal[3]; // unit shading normal
  // Not 0 where the diffuse term is the reflectance of a mirror; null: nowhere.
  const uint32_t* mirror = nullptr;
};

// Properties of a whole batch: whether any lane is lit, has a specular colour or a texture, needs
// the colours stage, or has a normal other than that of its hit.
struct Summary {
  bool lit = false, specular = false, textured = false, special = false, bent = false;
};

// Runs all stages for a batch of at least one hit and writes wholeLanes(hits->count) lanes of
// terms.
Summary makeTerms(const RtsHost* host, RtsBatch* batch, const RtsHits* hits, Terms& out);

// Evaluates the lighting equation for the terms of a batch (surface.cpp).
void shadeTerms(const RtsHost* host, RtsBatch* batch, const RtsHits* hits, const Summary& summary,
                const Terms& t, RtsShading* out);

// Writes the albedo: the diffuse colour of lit lanes, the colour of unlit lanes.
void albedo(const RtsHits* hits, const Terms& t, float* const* out);

// Writes 1 - A for shadow rays (RtsClass.transmit).
void transmit(const RtsHost* host, RtsBatch* batch, const RtsHits* hits,
              float* const transmission[3]);

} // namespace vrml97
