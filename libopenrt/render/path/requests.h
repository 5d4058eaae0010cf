// requests.h: what shaders and transport shaders request from the renderer (RtsHost): radiance
// along rays, hits, occlusion. Called by the host's functions (host.cpp) for batches that have a
// tracer. [render]
#pragma once

#include "render/wave/batch.h"

namespace openrt {

// Traces the rays of a request like the camera rays of a small wave, with a path tracer of their
// own. Writes radiance and alpha.
void traceRequest(RtsBatch& batch, const RtsRequest& request, float* const rgba[4]);
// Finds the nearest hits of the rays of a request.
void findRequest(const RtsBatch& batch, const RtsRequest& request, RtsFound& out);
// Writes the transmittance along the rays of a request.
void occludeRequest(const RtsBatch& batch, const RtsRequest& request, float* const transmission[3]);

} // namespace openrt
