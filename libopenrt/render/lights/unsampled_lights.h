// unsampled_lights.h: counts the emitted light that only BSDF sampling can find: paths that come
// from a non-specular surface via mirrors or smooth boundaries (UnsampledLight, ledger.h). [render]
#pragma once

#include "render/film/ledger.h"
#include "render/path/path_states.h"
#include "render/render_scene.h"

namespace openrt {

// Returns whether the hits of a camera path on area lights are left to light tracing, so that only
// the sky counts.
inline bool canOnlyReachSky(const RenderScene& scene, PathFlags path) {
  return scene.lightSources && path.pathClass() == PathClass::caustic;
}

class UnsampledLights {
 public:
  UnsampledLights(const RenderScene& scene, Ledger& ledger)
      : scene_(scene), ledger_(ledger), brightest_(scene.emitters.brightest()),
        brightestSky_(scene.emitters.brightestSky()) {}
  // Counts a ray, if light sampling cannot find the emitter that it may hit. unguidedWeight: as in
  // RayState.
  void send(PathFlags path, const Vec3f& throughput, float unguidedWeight = 1) {
    if (path.specularSinceDiffuse())
      countOf(path).send(throughput, brightestFor(path), weightOf(path, unguidedWeight));
  }
  // Counts the emitted radiance that such a ray has hit.
  void meet(PathFlags path, const Vec3f& radiance, float unguidedWeight = 1) {
    if (path.specularSinceDiffuse())
      countOf(path).meet(radiance, brightestFor(path), weightOf(path, unguidedWeight));
  }

 private:
  UnsampledLight& countOf(PathFlags path) {
    return canOnlyReachSky(scene_, path) ? ledger_.unsampledSky : ledger_.unsampled;
  }
  double brightestFor(PathFlags path) const {
    return canOnlyReachSky(scene_, path) ? brightestSky_ : brightest_;
  }
  // No ray is guided to the sky.
  double weightOf(PathFlags path, float unguidedWeight) const {
    return brightestFor(path) > brightestSky_ ? double(unguidedWeight) : 1.0;
  }
  const RenderScene& scene_;
  Ledger& ledger_;
  // Largest radiance of all emitters, and of the sky alone, summed over the colours.
  const double brightest_, brightestSky_;
};

} // namespace openrt
