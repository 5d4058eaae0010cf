// x3d_hatch.h: the hatching of a surface (FillProperties, ISO/IEC 19775-1 12.4.2). [render]
#pragma once

#include "vrml97/x3d_params.h"

namespace vrml97 {

// Draws the lines of the hatching over the finished terms of a batch: their colour glows, and they
// are opaque. Lanes between lines, and without hatching, keep their terms.
void drawHatching(const RtsHost* host, RtsBatch* batch, const RtsHits* hits, const Terms& t);

} // namespace vrml97
