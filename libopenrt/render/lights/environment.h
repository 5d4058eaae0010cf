// environment.h: the environment: the radiance of the sky along rays, and the fog between the eye
// and hits. [render]
#pragma once

#include "render/lights/unsampled_lights.h"
#include "render/wave/pixel_samples.h"
#include "render/wave/wave.h"

namespace openrt {

// The sky along rays. Arrays are padded and lie in the arena.
struct SkyAlongRays {
  float *direction[3], *rgba[4]; // direction: unit, in the environment's local space
};
// Evaluates the environment's shader in the directions of n rays. straight: by ray, 1 where the
// camera looks straight at the environment; null: nowhere.
SkyAlongRays evaluateSky(const StageContext& context, const Rays& rays, const uint32_t* lanes,
                         uint32_t n, const uint32_t* straight = nullptr);

// Adds the sky that the missed rays of a wave see, with the MIS weight of BSDF sampling.
void addEnvironment(const StageContext& context, const Wave& wave, UnsampledLights& unsampled,
                    PixelSamples& found);

struct Fog {                                         // by hit
  float *airlight[3] = {}, *transmittance = nullptr; // null: there is no fog

  // Returns one colour of the light of hit i that arrives through the fog. seen: share that the
  // surface shows of what lies beyond it. That part already has the airlight of the whole path.
  float attenuate(uint32_t i, int colour, float light, float seen) const {
    if (!transmittance) return light;
    return transmittance[i] * light + (1 - transmittance[i]) * airlight[colour][i] * (1 - seen);
  }
};
// Evaluate the fog in front of the hits of a batch: that of camera paths, and that of hits which
// the eye sees straight. On mirrored and refracted paths the fog has the whole path length, in the
// direction of the current ray. A fog coordinate of the geometry replaces the length: it is the
// share of what an endless way takes away. The fog belongs to what is seen (decision 101): there is
// none behind the first surface that scatters a path, and none on the way of the light.
Fog fogAt(const RtsBatch& batch);
Fog fogBeforeEye(const RtsBatch& batch);

} // namespace openrt
