// emitted.h: light of emitters and of the sky at non-specular surfaces: one light sample and one
// shadow ray per hit, combined with BSDF sampling by MIS. [render]
#pragma once

#include "render/lights/light_rays.h"
#include "render/lights/unsampled_lights.h"
#include "render/surface/sample_lobes.h"
#include "render/surface/sent_light.h"
#include "render/wave/boundaries.h"

namespace openrt {

// Returns the reference point for light sampling at a hit. twoSided: emitters behind the surface
// count as well.
LightSampleContext lightSampleContext(const Points& points, uint32_t i, bool twoSided);

// Returns whether light paths start on the surface at hit i, on the side that the ray has hit.
bool startsLightPaths(const RtsBatch& batch, uint32_t i);

// Multiplies the emission of the hits by the MIS weight of BSDF sampling; light sampling or light
// tracing contributes the rest. Emission behind an invisible boundary becomes 0.
void weightEmission(const RtsBatch& batch, const Boundaries& boundaries, UnsampledLights& unsampled,
                    float* const emission[3]);

// Samples an emitter for each hit with a non-specular lobe.
LightSamples chooseLightSamples(const RtsBatch& batch, const LobeSampling& sampling);
// Computes the BSDF response of the hits to their light samples, with the MIS weight of light
// sampling (balance heuristic). Removes the samples with response 0.
void weightLightSamples(const RtsBatch& batch, const LobeSampling& sampling, LightSamples& samples);

// Adds the light of one light sample at each hit: chooses the samples, weights them, traces the
// shadow rays and evaluates the emission.
void sampleEmitters(const RtsBatch& batch, const LobeSampling& sampling,
                    const Boundaries& boundaries, const SentLight& sent);

} // namespace openrt
