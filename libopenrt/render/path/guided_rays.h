// guided_rays.h: rays of camera paths that photons guide from non-specular surfaces by way of
// mirrors and smooth glass to emissive shapes and to the sun (photon_guide.h). Light sampling
// cannot connect such surfaces to the light, and BSDF sampling finds small lamps with a low
// probability. Each hit near photons sends one more ray, which follows specular surfaces only and
// counts the emission alone. It is combined with BSDF sampling by MIS (E. Veach, L. Guibas,
// SIGGRAPH 1995, balance heuristic). One instance per path tracer.
#pragma once

#include "render/lights/photon_guide.h"
#include "render/path/guide_trial.h"
#include "render/path/spawn_rays.h"
#include "render/wave/pixel_samples.h"
#include "render/wave/wave.h"

namespace openrt {

struct SampleArrays;

// Returns whether a path may send guided rays from a surface that scatters. Light tracing has the
// light of paths whose first surface scatters.
bool isGuided(const RenderScene& scene, PathFlags path);
// Returns the cell of the guide from which rays are sent at a point of a path; PhotonGuide::none if
// the path sends none there.
uint32_t guideCellAt(const RenderScene& scene, PathFlags path, const Vec3f& position);

// Writes the MIS weight of BSDF sampling to the states of the paths that BSDF samples of
// non-specular lobes have led to the hits of a batch, if they may go on by way of specular lobes.
void weightUnguided(const RtsBatch& batch, const Boundaries& boundaries);

class GuidedRays {
 public:
  // context: as that of the path tracer.
  explicit GuidedRays(const StageContext& context) : context_(context) {}

  // Tells a trial about all rays from now on.
  void observe(GuideTrial* trial) { trial_ = trial; }
  GuideTrial* trial() const { return trial_; }
  // Queues a ray for each hit near photons that has a non-specular lobe.
  void start(const CameraPaths& paths, const LobeSampling& sampling, const Boundaries& boundaries);
  bool empty() const { return next_.empty(); }
  // Follows all rays of the queue, as far as the depth limit lets them, to their next surface and
  // adds the light that they find there.
  // level: number of surfaces that the paths have hit before.
  void follow(const PathSamples& samples, uint32_t level, PixelSamples& found);

 private:
  struct Stage { // what the hits of a wave need
    const PathSamples& samples;
    uint32_t level;
    PixelSamples& found;
  };
  void visit(const Stage& stage, const Points& points, const Bucket& bucket,
             const PathStates& states);
  void addSun(const Stage& stage, const Wave& wave);
  void addLight(const Stage& stage, const RayState& state, const Vec3f& radiance);
  void addEmission(const Stage& stage, const RtsBatch& batch, const RtsSurface& surface,
                   const Boundaries& boundaries);
  void spawnRay(const RtsBatch& batch, uint32_t i, const SampleArrays& sample, float probability,
                const Boundaries& boundaries);

  const StageContext context_;
  GuideTrial* trial_ = nullptr;
  RayQueue queue_, next_; // rays of the current wave, and of the next one
};

} // namespace openrt
