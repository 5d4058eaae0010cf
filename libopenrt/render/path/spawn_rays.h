// spawn_rays.h: the stage that continues camera paths: selects BSDF samples, applies Russian
// roulette and queues the next rays. [render]
#pragma once

#include "render/lights/unsampled_lights.h"
#include "render/surface/sample_lobes.h"
#include "render/wave/boundaries.h"
#include "render/wave/random_numbers.h"

namespace openrt {

// The camera paths at the hits of a batch.
struct CameraPaths {
  const RtsBatch& batch; // its points, path states and lobes
  uint32_t level;        // number of surfaces that the paths have hit before
  const PathSamples& samples;
  UnsampledLights& unsampled;
  Ledger& ledger;
  RayQueue& next; // gets the spawned rays
};

// Spawns the rays of all hits. Transports:
// * Direct: follows only straight transmission.
// * Whitted: follows every specular reflection and refraction deterministically until a branch
//   carries less than the frame's energy cut.
// * Path: also follows the directions sampled from non-specular lobes. Russian roulette terminates
//   paths that carry little. Once a path has split several times, one sample is selected with a
//   probability proportional to what it carries.
// The order of the spawned rays is fixed and the same on all instruction sets: the rays of one
// sample (SampleArrays) in the order of the hits, then those of the next; at last those that pass
// hidden boundaries. The sums over the rays of a path and those of the ledger follow this order.
void spawnRays(const CameraPaths& paths, const LobeSampling& sampling,
               const Boundaries& boundaries);

// How rays of other kinds pass where a ray goes straight on.
struct Passage {
  bool guided;  // rays that photons guide do
  bool sampled; // light samples do, so that the ray keeps the pdf of its direction
};
// Spawns a ray that goes straight on from hit i, with its throughput multiplied by `weight`.
void spawnStraightRay(const CameraPaths& paths, uint32_t i, const Vec3f& weight,
                      const MediaStack& media, const Passage& passage);
// Returns the shader of the surface at hit i.
const ShaderSlot& shaderAt(const RtsBatch& batch, uint32_t i);

} // namespace openrt
