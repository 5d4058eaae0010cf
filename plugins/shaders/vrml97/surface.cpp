// surface.cpp: the lighting equation of ISO/IEC 14772-1 clause 4.14, for batches. [render]
//
// A batch passes four stages, each a loop over arrays: materials (parameters by lane), textures
// (both in material.cpp), lights, and the result. Where the standard does not say:
//   normals, not colours, are interpolated over a face
//   there is no highlight where N.L <= 0; elsewhere a shininess of 0 gives a factor of 1
//   shadows remove the direct part of a light, never the ambient part
#include <algorithm>

#include "vrml97/batch.h"
#include "vrml97/classes.h"
#include "vrml97/global.h"

namespace vrml97 {
namespace {

uint32_t traits(const RtsHost* host, const void* params) {
  const auto& p = *static_cast<const SurfaceParams*>(params);
  return (isTransparent(host, p) ? uint32_t(RTS_TRANSPARENT) : 0u) |
         (p.lit ? 0u : uint32_t(RTS_UNLIT)) | scatterTraits(p);
}

// Writes N.L to `cosine`, and to `wanted` whether a lane needs a shadow ray: it faces the light,
// the light reaches it, and it reflects light. Returns whether any lane needs one.
VRML97_CLONES uint32_t cosinesAndWanted(uint32_t n, const float* const* normalIn,
                                        const RtsIllumination& light, const Terms& t,
                                        float* __restrict cosine, uint8_t* __restrict wanted) {
  const float* __restrict nx = normalIn[0];
  const float* __restrict ny = normalIn[1];
  const float* __restrict nz = normalIn[2];
  const float* __restrict lx = light.toLight[0];
  const float* __restrict ly = light.toLight[1];
  const float* __restrict lz = light.toLight[2];
  const float* __restrict r = light.color[0];
  const float* __restrict g = light.color[1];
  const float* __restrict b = light.color[2];
  const float* __restrict dr = t.diffuse[0];
  const float* __restrict dg = t.diffuse[1];
  const float* __restrict db = t.diffuse[2];
  const float* __restrict sr = t.specular[0];
  const float* __restrict sg = t.specular[1];
  const float* __restrict sb = t.specular[2];
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

VRML97_CLONES void addDiffuse(uint32_t n, const float* __restrict cosine,
                              const float* __restrict direct, const float* __restrict ambientLight,
                              const float* __restrict diffuse, const float* __restrict ambient,
                              float* __restrict radiance) {
  for (uint32_t i = 0; i < n; i++)
    radiance[i] += diffuse[i] * (direct[i] * cosine[i] + ambientLight[i] * ambient[i]);
}

// Writes max(N.H, 0) to the power of the exponent, 0 where N.L <= 0. It uses the sine of the angle
// between N and H, which is more precise than the cosine near the peak of a highlight, where high
// exponents need it.
VRML97_CLONES void highlights(uint32_t n, const float* const* normalIn,
                              const float* const* directionIn, float* const* toLight,
                              const float* __restrict cosine, const float* __restrict exponent,
                              float* __restrict factor) {
  const float* __restrict nx = normalIn[0];
  const float* __restrict ny = normalIn[1];
  const float* __restrict nz = normalIn[2];
  const float* __restrict vx = directionIn[0];
  const float* __restrict vy = directionIn[1];
  const float* __restrict vz = directionIn[2];
  const float* __restrict lx = toLight[0];
  const float* __restrict ly = toLight[1];
  const float* __restrict lz = toLight[2];
  for (uint32_t i = 0; i < n; i++) {
    const float hx = lx[i] - vx[i], hy = ly[i] - vy[i], hz = lz[i] - vz[i]; // L + V, not unit
    const float cx = ny[i] * hz - nz[i] * hy, cy = nz[i] * hx - nx[i] * hz,
                cz = nx[i] * hy - ny[i] * hx;
    const float length2 = larger(hx * hx + hy * hy + hz * hz, 1e-30f);
    const float sine2 = smaller((cx * cx + cy * cy + cz * cz) / length2, 1.0f);
    const float nh = nx[i] * hx + ny[i] * hy + nz[i] * hz;
    // The logarithm of cos^exponent; 0 for exponent 0 at any angle.
    const float power = 0.5f * exponent[i] * logOneMinus(sine2);
    const float back = nh > 0.0f ? 0.0f : larger(-exponent[i] * 1e30f, vanishing);
    const float dark = cosine[i] > 0.0f ? 0.0f : vanishing;
    factor[i] = expNegative(power + back + dark);
  }
}

VRML97_CLONES void addSpecular(uint32_t n, const float* __restrict factor,
                               const float* __restrict direct, const float* __restrict specular,
                               float* __restrict radiance) {
  for (uint32_t i = 0; i < n; i++) radiance[i] += direct[i] * specular[i] * factor[i];
}

void lights(const RtsHost* host, RtsBatch* batch, const RtsHits* hits, const Summary& summary,
            const Terms& t, float* const* radiance) {
  const uint32_t n = wholeLanes(hits->count), count = host->lights(batch);
  if (count == 0) return;
  float *cosine = host->scratch(batch, n),
        *factor = summary.specular ? host->scratch(batch, n) : nullptr;
  auto* wanted = reinterpret_cast<uint8_t*>(host->scratch(batch, n));
  for (uint32_t k = 0; k < count; k++) {
    RtsIllumination light{};
    host->illuminate(batch, k, hits, &light);
    if (cosinesAndWanted(n, t.normal, light, t, cosine, wanted))
      host->shadow(batch, k, hits, wanted, &light);
    for (int c = 0; c < 3; c++)
      addDiffuse(n, cosine, light.color[c], light.ambient[c], t.diffuse[c], t.ambient[c],
                 radiance[c]);
    if (!summary.specular) continue;
    highlights(n, t.normal, hits->direction, light.toLight, cosine, t.exponent, factor);
    for (int c = 0; c < 3; c++) addSpecular(n, factor, light.color[c], t.specular[c], radiance[c]);
  }
}

VRML97_CLONES void finish(uint32_t n, const float* __restrict alpha, float* __restrict radiance,
                          float* __restrict transmission) {
  for (uint32_t i = 0; i < n; i++) {
    radiance[i] = radiance[i] * alpha[i];
    transmission[i] = 1.0f - alpha[i];
  }
}

} // namespace

void shadeTerms(const RtsHost* host, RtsBatch* batch, const RtsHits* hits, const Summary& summary,
                const Terms& t, RtsShading* out) {
  const uint32_t n = wholeLanes(hits->count);
  if (out->albedo[0]) albedo(hits, t, out->albedo);
  for (int c = 0; c < 3; c++) std::copy_n(t.glow[c], n, out->radiance[c]);
  if (summary.lit) lights(host, batch, hits, summary, t, out->radiance);
  for (int c = 0; c < 3; c++) finish(n, t.alpha, out->radiance[c], out->transmission[c]);
}

namespace {

void shade(const RtsHost* host, RtsBatch* batch, const RtsHits* hits, RtsShading* out) {
  if (hits->count == 0) return;
  Terms t;
  const Summary summary = makeTerms(host, batch, hits, t);
  shadeTerms(host, batch, hits, summary, t, out);
}

RtsClass makeSurfaceClass() {
  RtsClass c{};
  c.size = sizeof(RtsClass);
  c.kind = RTS_SURFACE;
  c.name = "VRML97";
  c.text = "the material and texture of VRML97, by its lighting equation";
  c.paramSize = sizeof(SurfaceParams);
  c.paramCount = surfaceParamCount;
  c.params = surfaceParams;
  c.traits = traits;
  c.shade = shade;
  c.transmit = transmit;
  c.surface = scatter;
  return c;
}

} // namespace

const RtsClass surfaceClass = makeSurfaceClass();

} // namespace vrml97
