// projected_pdfs.h: the pdfs of lobes for both directions of a path, per projected solid angle (E.
// Veach, 1997, chapter 3): the pdf per solid angle over the cosine at the lobe's normal. [render]
#pragma once

#include "render/wave/batch.h"

namespace openrt {

// For pairs of a hit and a direction, by pair.
struct ProjectedPdfs {
  // ahead: pdf of the direction, for a path that arrives along the hit's ray. back: pdf of the
  // direction to the ray's origin, for a path that arrives from `direction`.
  float *ahead, *back;
};

// Computes the pdfs of a non-specular lobe for n pairs, in which no hit occurs twice. pdf: of the
// direction per solid angle, by pair. A direction behind the surface has the pdfs of a Lambert
// lobe: nobody knows the lobe that the shader declares on the other side.
ProjectedPdfs projectedPdfs(const RtsBatch& batch, const RtsLobe& lobe, uint32_t n,
                            const uint32_t* hit, const float* const direction[3], const float* pdf);

} // namespace openrt
