// openings.h: the luminous openings of lights (RtsClass.opening), as camera paths see them before
// their first non-specular surface: straight, in mirrors and through glass. Behind that surface
// light samples find the light itself, so nothing counts twice. [render]
#pragma once

#include <span>

#include "render/wave/pixel_samples.h"
#include "render/wave/wave.h"

namespace openrt {

// The rays of a wave that see an opening. The arrays lie in the arena.
struct SeenOpenings {
  std::span<const uint32_t> lanes; // in their order
  float* radiance[3] = {};         // by lane
};

// Ends the rays of a wave of camera paths that meet an opening: they get its distance, and hit
// nothing. To be called between findHits() and goToHits().
SeenOpenings meetOpenings(const StageContext& context, const Wave& wave);
// Adds what these rays see, and removes them from wave.missed: they do not see the sky.
void addOpenings(const StageContext& context, const SeenOpenings& seen, Wave& wave,
                 PixelSamples& found);

} // namespace openrt
