// lamps.h: the stage that adds the direct light of the light shaders at surfaces that are described
// by lobes. [render]
#pragma once

#include "render/surface/batch.h"

namespace openrt {

// Adds the light of the batch's light shaders to `radiance`, by hit. Casts the shadow rays.
void addLamps(RtsBatch& batch, float* const radiance[3]);

} // namespace openrt
