// camera_connections.h: connects vertices of light paths with the camera: a camera subpath of one
// vertex (E. Veach, 1997, chapter 10). [render]
#pragma once

#include <cstdint>

#include "render/wave/batch.h"

namespace openrt {

// Connections of hits of a batch with points on the lens. The arrays are indexed by connection and
// lie in the arena.
struct CameraConnections {
  uint32_t count;
  const uint32_t* hit;            // index of the hit in the batch
  float* xy[2];                   // position on the film, in pixels
  float *direction[3], *distance; // from the hit to the point on the lens; unit
  float* weight;                  // RtsProjection::weight; 0: the hit is not in the picture
  bool parallel;                  // parallel view: the eye is infinitely far away
};

// Projects n hits through the camera. lens: points of the unit square, by hit of the batch.
CameraConnections projectToCamera(const RtsBatch& batch, const uint32_t* hit, uint32_t n,
                                  const float* const lens[2]);
// Writes where the camera sees n points of render space through the middle of its lens
// (RtsHost.pixels). The arrays of xy are whole vectors of lanes. Returns false if it cannot tell.
bool pixelsOf(const RtsBatch& batch, uint32_t n, const float* const position[3],
              float* const xy[2]);
// Returns the pixels that a unit of area covers at n hits, as seen from the middle of the lens.
const float* coveredPixels(const RtsBatch& batch, const uint32_t* hit, uint32_t n);
// Returns the factor from areas in the camera's space to areas in render space.
double cameraArea(const RenderScene& scene);
// Writes what the hits scatter to the camera for a throughput of 1, by colour and connection: the
// BSDF times the weight, with the correction for shading normals. ratio: by connection, the ratio
// of pdfs of the path without the factor `ahead` of the hit (lights/light_path_weights.h), which
// tells the share of light paths; null: it is 1.
void scatterToCamera(const RtsBatch& batch, const CameraConnections& to, const float* ratio,
                     float* const scattered[3]);
// Multiplies colours by the transmittance between the hits and the camera, with that of the fog.
void traceToCamera(const RtsBatch& batch, const CameraConnections& to, float* const colour[3]);

} // namespace openrt
