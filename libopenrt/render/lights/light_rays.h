// light_rays.h: light samples as structure of arrays: their shadow rays, the response of the
// surfaces, and the light that arrives, with vector lanes. [render]
#pragma once

#include "render/lights/emitters.h"
#include "render/rays.h"

struct RtsLobe;

namespace openrt {

struct LobeValues;

// Light samples at the hits of a batch, one for each hit at most, in the order of the hits.
struct LightSamples {
  Rays rays;             // the shadow rays; count: number of samples
  float* distance;       // to the sampled point; infinite for the sky
  float* pdf;            // LightSample::pdf
  uint32_t* shape;       // number of the shape; EmissiveShapes::none: the sky
  uint32_t* hit;         // index of the hit in the batch
  float* response[3];    // BSDF times MIS weight over pdf
  float* coated[3] = {}; // the part of `response` of coats (RtsLobe.coat); null: nobody asks

  // Allocates all arrays but `coated`.
  void allocate(Arena& arena, uint32_t capacity);
  LightSample operator[](uint32_t ray) const {
    return {shape[ray], load(rays.dir, ray), distance[ray], pdf[ray]};
  }
};

// Lists the hits whose emission is not 0 0 0 and returns their number.
uint32_t listEmitting(const float* const emission[3], uint32_t n, uint32_t* hits);

// Starts a shadow ray for every point that has a sample. The rays end as SampledLights::end says.
void startShadowRays(const LightPoints& points, const SampledLights& sampled, LightSamples& out);

// Writes the response of a lobe to the light samples, or adds it if `more`: the MIS weight is that
// of light sampling (balance heuristic). That of a coat is added to `coated`, too. followed: by
// hit, LobeSampling::selectionProbability. share: by ray, cameraPathShares().
void weightByLobe(const RtsLobe& lobe, const float* followed, const LobeValues& values, bool more,
                  const LightSamples& samples, const float* share = nullptr);

// Removes the samples with response 0.
void removeUseless(LightSamples& samples);

// Adds the light of the shapes that emit one radiance to the hits (`radiance`), by their response.
// Lists in `others` the other rays that are not blocked, and returns their number.
uint32_t addOneRadiance(const ShapeArrays& shapes, const LightSamples& samples,
                        const float* const response[3], const uint8_t* blocked,
                        float* const radiance[3], uint32_t* others);

} // namespace openrt
