// lambert.h: the functions of diffuse lobes, with vector lanes. [render]
#pragma once

#include "openrt/openrts.h"

namespace openrt {

// Implement RtsLobeFunctions for diffuse lobes (Lambert's law: value = cosine / pi, and the pdf of
// sampling is the same).
void evaluateLambert(const RtsLobe* lobe, const RtsHits* hits, uint32_t n, const uint32_t* hit,
                     const float* const direction[3], float* const value[3], float* pdf);
void sampleLambert(const RtsLobe* lobe, const RtsHits* hits, uint32_t n, const uint32_t* hit,
                   const float* const square[2], float* const direction[3],
                   float* const quotient[3], float* pdf);

} // namespace openrt
