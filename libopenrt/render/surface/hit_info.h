// hit_info.h: data about hits that shaders may request beyond RtsHits (defined in openrts.h).
// A batch without hits gets the values that openrts.h promises. [render]
#pragma once

#include <cstdint>

struct RtsBatch;

namespace openrt {

void localOf(const RtsBatch& batch, float* const position[3], float* const normal[3]);
void derivativesOf(const RtsBatch& batch, float* const alongS[3], float* const alongT[3]);
void idsOf(const RtsBatch& batch, uint32_t* name, uint32_t* instance, uint32_t* primitive);
// level: number of surfaces that every ray of the batch has hit before.
void pathsOf(const RtsBatch& batch, uint32_t level, uint32_t* depth, float* const throughput[3]);

} // namespace openrt
