// illumination.h: evaluates the lights of a batch one after the other (RtsHost.lights, illuminate,
// shadow). In path tracing the last one may be a light sampled separately for each hit
// (render/lights/light_sampler.h). [render]
#pragma once

#include "render/wave/batch.h"

namespace openrt {

uint32_t lightCount(RtsBatch& batch);
void illuminateHits(RtsBatch& batch, uint32_t i, const RtsHits& hits, RtsIllumination& out);
void shadowHits(RtsBatch& batch, uint32_t i, const RtsHits& hits, const uint8_t* wanted,
                RtsIllumination& light);

} // namespace openrt
