// global.cpp: a VRML97 surface as a sum of lobes. Path tracing uses it for the class VRML97, and it
// is all of the class GlobalIllumination, which requests path tracing. [render]
//
// The lighting equation (ISO/IEC 14772-1 clause 4.14) neither conserves energy nor is reciprocal.
// It is replaced by a Lambertian lobe and, for highlights, the reciprocal OS (N.H)^e (N.L), which
// is as bright at its peak. Where both together would reflect more than all light, they are scaled.
// The ambient terms are left out: they approximate the indirect light that path tracing computes.
#include "vrml97/global.h"

#include <algorithm>

#include "blinn_phong.h"
#include "vrml97/batch.h"
#include "vrml97/classes.h"

namespace vrml97 {
namespace {

struct Lobes {
  RtsLobe *diffuse, *mirror, *highlight, *behind; // null if no hit of the batch has the lobe
};

float atLeast0(float x) { return larger(x, 0.0f); }

void fill(const RtsHits* hits, const Summary& summary, const Terms& t, const Lobes& lobes) {
  for (uint32_t i = 0; i < hits->count; i++) {
    const float alpha = smaller(atLeast0(t.alpha[i]), 1.0f),
                exponent = smaller(atLeast0(t.exponent[i]), blinn_phong::sharpest);
    RtsLobe* base = t.mirror && t.mirror[i] ? lobes.mirror : lobes.diffuse;
    const float peakReflectance = lobes.highlight ? blinn_phong::reflectance(exponent) : 0.0f;
    for (int c = 0; c < 3; c++) {
      const float diffuse = atLeast0(t.diffuse[c][i]),
                  highlight = peakReflectance * atLeast0(t.specular[c][i]),
                  both = diffuse + highlight;
      const float scale = alpha * (both > 1.0f ? 1.0f / both : 1.0f);
      if (base) base->weight[c][i] = scale * diffuse;
      if (lobes.highlight) lobes.highlight->weight[c][i] = scale * highlight;
      if (lobes.behind) lobes.behind->weight[c][i] = 1.0f - alpha;
    }
    if (lobes.highlight) lobes.highlight->data[0][i] = exponent;
    if (summary.bent)
      for (RtsLobe* lobe : {lobes.diffuse, lobes.mirror, lobes.highlight})
        for (int c = 0; c < 3 && lobe; c++) lobe->normal[c][i] = t.normal[c][i];
  }
}

uint32_t traits(const RtsHost* host, const void* params) {
  const auto& p = *static_cast<const SurfaceParams*>(params);
  return RTS_GLOBAL | (isTransparent(host, p) ? uint32_t(RTS_TRANSPARENT) : 0u) | scatterTraits(p);
}

RtsClass makeGlobalIlluminationClass() {
  RtsClass c{};
  c.size = sizeof(RtsClass);
  c.kind = RTS_SURFACE;
  c.name = "GlobalIllumination";
  c.text = "the material and texture of VRML97, also lit by all other surfaces";
  c.paramSize = sizeof(SurfaceParams);
  c.paramCount = surfaceParamCount;
  c.params = surfaceParams;
  c.traits = traits;
  c.transmit = transmit;
  c.surface = scatter;
  return c;
}

} // namespace

uint32_t scatterTraits(const SurfaceParams& p) {
  const auto any = [](const float c[3]) { return c[0] > 0.0f || c[1] > 0.0f || c[2] > 0.0f; };
  return (p.lit ? 0u : uint32_t(RTS_NO_SCATTER)) |
         (p.lit && any(p.specularColor) ? uint32_t(RTS_GLOSSY) : 0u) |
         (!p.lit || any(p.emissiveColor) ? uint32_t(RTS_EMISSIVE) : 0u) |
         // Colours of vertices do not change the emission of lit surfaces, but their alpha
         // and that of a texture do.
         (p.lit && any(p.emissiveColor) && !p.texture && !p.vertexAlpha
              ? uint32_t(RTS_UNIFORM_EMISSION)
              : 0u);
}

void scatter(const RtsHost* host, RtsBatch* batch, const RtsHits* hits, RtsSurface* out) {
  if (hits->count == 0) return;
  Terms t;
  const Summary summary = makeTerms(host, batch, hits, t);
  scatterTerms(host, batch, hits, summary, t, out);
}

void scatterTerms(const RtsHost* host, RtsBatch* batch, const RtsHits* hits, const Summary& summary,
                  const Terms& t, RtsSurface* out) {
  if (out->albedo[0]) albedo(hits, t, out->albedo);
  bool clear = false;
  for (uint32_t i = 0; i < hits->count; i++) {
    clear |= t.alpha[i] < 1.0f;
    for (int c = 0; c < 3; c++) out->emission[c][i] = t.alpha[i] * t.glow[c][i];
  }
  Lobes lobes{};
  if (summary.lit) lobes.diffuse = host->lobe(batch, RTS_LOBE_DIFFUSE);
  if (t.mirror) lobes.mirror = host->lobe(batch, RTS_LOBE_REFLECTION);
  if (summary.specular) {
    lobes.highlight = host->customLobe(batch, rts::lobeFunctions<blinn_phong::Lobe>(), 1);
    if (lobes.highlight) lobes.highlight->coat = 1;
  }
  if (clear) lobes.behind = host->lobe(batch, RTS_LOBE_TRANSPARENT);
  fill(hits, summary, t, lobes);
}

const RtsClass globalIlluminationClass = makeGlobalIlluminationClass();

} // namespace vrml97
