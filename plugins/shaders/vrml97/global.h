// global.h: the VRML97 surface for global illumination: its lobes and traits. [render]
#pragma once

#include "vrml97/material.h"

namespace vrml97 {

// Returns the traits of a shader that uses scatter().
uint32_t scatterTraits(const SurfaceParams& params);

// Describes hits by lobes (RtsClass.surface).
void scatter(const RtsHost* host, RtsBatch* batch, const RtsHits* hits, RtsSurface* out);

// Describes hits whose terms are known by lobes.
void scatterTerms(const RtsHost* host, RtsBatch* batch, const RtsHits* hits, const Summary& summary,
                  const Terms& t, RtsSurface* out);

} // namespace vrml97
