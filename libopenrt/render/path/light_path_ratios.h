// light_path_ratios.h: keeps account, surface by surface, of how often light paths make what a path
// has passed, over how often camera paths do (lights/light_path_weights.h). Camera paths begin at
// the first surface, light paths at the last one. [render]
#pragma once

#include "render/lights/light_sources.h"
#include "render/surface/projected_pdfs.h"
#include "render/surface/sample_arrays.h"

namespace openrt {

// Returns the ratio that a path has before it has reached the first surface, for one light path of
// the picture to a camera path: pixels of the picture. 0 if camera paths share no light with those
// that are connected to the camera. lightPathRatio() and mirrorPathRatio() count the light paths.
float firstRatio(const RenderScene& scene);

// Computes the ratios of the rays that camera paths spawn, sample by sample, after chooseSamples().
void countCameraPaths(const RtsBatch& batch, BsdfSampleArrays& samples);

// Pairs of a hit of a batch and a direction; no hit occurs twice.
struct HitDirections {
  uint32_t count;
  const uint32_t* hit;
  const float* const* direction;
};
// The light rays with which light paths have started that no non-specular lobe has scattered yet,
// by hit; null: one has.
struct LightStarts {
  const LightSources& sources;
  const LightSources::LightRay* const* ray;
};
// Returns by pair the factors of the ratios of light paths that leave the hits by a lobe. to: by
// pair, what the surface has for `back`. pdfs: of the lobe; the camera's side is that of the
// direction, so `ahead` and `back` have changed places.
const float* lightPathFactors(const RtsBatch& batch, const RtsLobe& lobe,
                              const HitDirections& pairs, const ProjectedPdfs& pdfs,
                              const float* to, const LightStarts& starts);
// Returns by hit the factor of the ratio of a light path that follows the sample, for the hits
// whose number[] is `selected`.
const float* countLightPaths(const RtsBatch& batch, const SampleArrays& sample,
                             const uint32_t* number, uint32_t selected, const LightStarts& starts);

// Computes the shares of light paths (lightPathShare) for hits that are the first surface that the
// camera sees. pdf: of the lobe, by pair of a hit and a direction to the camera. ratio: infinite
// where light paths make all.
void firstSurfaceShares(const RtsBatch& batch, const RtsLobe& lobe, uint32_t n, const uint32_t* hit,
                        const float* const direction[3], const float* pdf, const float* ratio,
                        float* share);

} // namespace openrt
