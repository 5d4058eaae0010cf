// lamps.h: the stage that adds the direct light of the light shaders at surfaces that are described
// by lobes. [render]
#pragma once

#include "render/surface/sent_light.h"
#include "render/wave/batch.h"

namespace openrt {

// Adds the light of the batch's light shaders to what the hits send back. Casts the shadow rays.
void addLamps(RtsBatch& batch, const SentLight& sent);

} // namespace openrt
