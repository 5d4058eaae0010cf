// surface_shader.h: the stage that asks the surface shader: emission, albedo, and the lobes that
// are the BSDF of each hit. [render]
#pragma once

#include "render/wave/batch.h"

namespace openrt {

// Runs the `surface` function of a class once for all hits of a batch. The batch gets the lobes.
// albedo: whether the frame has this channel. The arrays lie in the arena.
RtsSurface runSurfaceShader(RtsBatch& batch, const RtsClass& shaderClass, bool albedo = false);

} // namespace openrt
