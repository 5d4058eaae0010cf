// texture_groups.h: samples a batch whose lanes may have different textures with one host call a
// texture. Called by the surface and the environment. Thread tag [render].
#pragma once

#include <cstdint>

#include "openrt/openrts.h"

namespace vrml97 {

// Where and with which texture each lane looks; texture 0: the lane is left alone. count lanes.
struct TexturePlaces {
  uint32_t count;
  const RtsTexture* texture;
  const float* uv[2];
};

// Writes rgba and the number of components of the lanes that have a texture; other lanes keep what
// they hold.
void sampleGroups(const RtsHost* host, RtsBatch* batch, const TexturePlaces& places,
                  float* const rgba[4], uint32_t* components);

} // namespace vrml97
