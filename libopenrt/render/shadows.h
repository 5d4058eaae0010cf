// shadows.h: visibility of one light from the points of a batch. [render]
#pragma once

#include "render/batch.h"

namespace openrt {

// Multiplies light.color by what is let through between the points and the light last looked at, where wanted.
void castShadows(RtsBatch& batch, const uint8_t* wanted, RtsIllumination& light);

} // namespace openrt
