// texture_groups.h: samples a batch whose lanes may have different textures, with one host call for
// each texture. Called by the surface and the environment. [render]
#pragma once

#include <cstdint>

#include "openrt/openrts.h"

namespace vrml97 {

// The texture and texture coordinates of each of `count` lanes; lanes with texture 0 are skipped.
// If there is a third coordinate, textures may be volumes.
struct TexturePlaces {
  uint32_t count;
  const RtsTexture* texture;
  const float* at[3]; // s, t, and r or null
};

// Writes rgba and the number of components for the lanes that have a texture. Other lanes keep
// their values.
void sampleGroups(const RtsHost* host, RtsBatch* batch, const TexturePlaces& places,
                  float* const rgba[4], uint32_t* components);

} // namespace vrml97
