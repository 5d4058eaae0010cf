// x3d_hatch.cpp: draws the lines of a hatching where the camera sees them. [render]
#include "vrml97/x3d_hatch.h"

#include <algorithm>

#include "hatch.h"
#include "vrml97/batch.h"

namespace vrml97 {

void drawHatching(const RtsHost* host, RtsBatch* batch, const RtsHits* hits, const Terms& t) {
  const auto isHatched = [hits](uint32_t i) {
    return x3dParamsOf(hits, i).hatchStyle != 0 && !(hits->flags[i] & RTS_HIT_LINE);
  };
  uint32_t first = 0;
  while (first < hits->count && !isHatched(first)) first++;
  if (first == hits->count) return;
  const uint32_t lanes = wholeLanes(hits->count);
  float* const xy[2] = {host->scratch(batch, lanes), host->scratch(batch, lanes)};
  const bool placed = host->pixels(batch, hits->count, hits->position, xy) != 0;
  for (uint32_t i = first; i < lanes; i++) {
    const uint32_t from = std::min(i, hits->count - 1); // the padding repeats the last lane
    const X3dParams& p = x3dParamsOf(hits, from);
    if (!isHatched(from) ||
        !hatch::covers(p.hatchStyle, placed, xy[0][from], xy[1][from], p.filled != 0))
      continue;
    for (int c = 0; c < 3; c++) {
      t.glow[c][i] = p.hatchColor[c];
      t.diffuse[c][i] = t.specular[c][i] = t.ambient[c][i] = 0;
    }
    t.alpha[i] = 1;
  }
}

} // namespace vrml97
