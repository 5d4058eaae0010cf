// global.h: a VRML97 surface where light goes from surface to surface. Thread tag [render].
#pragma once

#include "vrml97/material.h"

namespace vrml97 {

// Traits that `scatter` adds to a shader.
uint32_t scatterTraits(const SurfaceParams& params);

// A function of RtsClass (surface).
void scatter(const RtsHost* host, RtsBatch* batch, const RtsHits* hits, RtsSurface* out);

} // namespace vrml97
