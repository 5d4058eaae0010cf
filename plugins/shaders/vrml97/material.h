// material.h: the first stages of a batch of hits of a VRML97 surface: parameters by lane, textures
// and colours (ISO/IEC 14772-1 clause 4.14). What light does there is in surface.cpp (the lighting
// equation) and global.cpp (lobes). Thread tag [render].
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
};

extern const RtsParam surfaceParams[];
extern const uint32_t surfaceParamCount;

inline const SurfaceParams& paramsOf(const RtsHits* hits, uint32_t lane) {
  return *static_cast<const SurfaceParams*>(hits->params[lane]);
}
inline bool hasAlpha(uint32_t components) { return components == 2 || components == 4; }
bool isTransparent(const RtsHost* host, const SurfaceParams& params);

// The terms of the equation by lane: I = glow + sum over lights of (direct * diffuse * N.L + ...).
// Unlit lanes have no diffuse and specular colour and glow in their own.
struct Terms {
  float* glow[3];     // OE, or the colour of an unlit lane
  float* diffuse[3];  // OD
  float* ambient;     // Oa
  float* specular[3]; // OS
  float* exponent;    // 128 * shininess
  float* alpha;       // A
};

// What the textures and lights stages need to know about a whole batch.
struct Summary {
  bool lit = false, specular = false, textured = false, special = false;
};

// All stages, for a batch of at least one hit: wholeLanes(hits->count) lanes of terms.
Summary makeTerms(const RtsHost* host, RtsBatch* batch, const RtsHits* hits, Terms& out);

// The albedo of a lit lane is its diffuse colour, of an unlit one the colour it shows.
void albedo(const RtsHits* hits, const Terms& t, float* const* out);

// Shadow rays: only 1 - A. A function of RtsClass.
void transmit(const RtsHost* host, RtsBatch* batch, const RtsHits* hits,
              float* const transmission[3]);

} // namespace vrml97
