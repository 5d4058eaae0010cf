// scatter_in_media.h: the stage of path tracing for media that scatter: collisions are shaded like
// surfaces that have the phase function as their only lobe. [render]
#pragma once

#include "render/path/path_tracer.h"

namespace openrt {

// Samples where rays of a wave collide with media, gathers the light there, and spawns the rays
// that go on. Takes the rays that collide from wave.met.
void scatterInMedia(PathTracer& tracer, Wave& wave, PixelSamples& found);

} // namespace openrt
