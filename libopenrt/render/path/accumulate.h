// accumulate.h: the last stage at a hit: adds radiance and alpha to the samples, behind the fog,
// and records first surfaces. [render]
#pragma once

#include "render/lights/environment.h"
#include "render/path/spawn_rays.h"
#include "render/surface/sent_light.h"
#include "render/wave/pixel_samples.h"

namespace openrt {

// Adds what `shade` has returned for the hits of the paths, and spawns rays through transparent
// surfaces.
void addShading(const CameraPaths& paths, const RtsShading& shaded, const Fog& fog,
                PixelSamples& found);

// Adds the light that surfaces send back that are described by lobes.
void addSurface(const RtsBatch& batch, const RtsSurface& surface, const SentLight& sent,
                const Boundaries& boundaries, const Fog& fog, PixelSamples& found);

} // namespace openrt
