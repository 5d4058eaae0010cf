// x3d_cube.h: cube maps of a surface (ISO/IEC 19775-1 clause 34): its first layer is looked up by a
// direction, or it mirrors what is really around it. [render]
#pragma once

#include "vrml97/x3d_params.h"

namespace vrml97 {

// Places the lanes whose first layer is a cube map: writes their texture and texture coordinates.
// Other lanes keep theirs. A back with a picture of its own has no cube map.
void placeInCubes(const RtsHost* host, RtsBatch* batch, const RtsHits* hits,
                  const float* const normal[3], RtsTexture* texture, float* const uv[2]);

// Makes the lanes of mirrors such: their reflectance becomes t.diffuse, and t.mirror leads to them,
// null if there are none.
void findMirrors(const RtsHost* host, RtsBatch* batch, const RtsHits* hits, Terms& t);

// Adds what mirrors show, for transports that call `shade`: traces one ray for each. reflectance:
// the diffuse term, which is then 0 there, so that no light is diffused.
struct MirrorColors {
  float* c[3] = {};
};
MirrorColors takeMirrors(const RtsHost* host, RtsBatch* batch, const RtsHits* hits, const Terms& t);
void addMirrored(const RtsHost* host, RtsBatch* batch, const RtsHits* hits, const Terms& t,
                 const MirrorColors& reflectance, float* const radiance[3]);

} // namespace vrml97
