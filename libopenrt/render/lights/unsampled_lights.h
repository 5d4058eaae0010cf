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
      : scene_(scene), ledger_(ledger), brightestShape_(scene.emitters.brightestShape()),
        brightestSky_(scene.emitters.brightestSky()) {}
  // Counts a ray, if light sampling cannot find the emitter that it may hit. unguidedWeight: as in
  // RayState. No ray is guided to the sky.
  void send(PathFlags path, const Vec3f& throughput, float unguidedWeight = 1) {
    if (!path.specularSinceDiffuse()) return;
    ledger_.unsampledSky.send(throughput, brightestSky_);
    if (!canOnlyReachSky(scene_, path))
      ledger_.unsampled.send(throughput, brightestShape_, double(unguidedWeight));
  }
  // Counts the emission of a shape that such a ray has hit.
  void meet(PathFlags path, const Vec3f& radiance, float unguidedWeight) {
    if (path.specularSinceDiffuse() && !canOnlyReachSky(scene_, path))
      ledger_.unsampled.meet(radiance, brightestShape_, double(unguidedWeight));
  }
  // Counts the radiance of the sky that such a ray has reached.
  void meetSky(PathFlags path, const Vec3f& radiance) {
    if (path.specularSinceDiffuse()) ledger_.unsampledSky.meet(radiance, brightestSky_);
  }

 private:
  const RenderScene& scene_;
  Ledger& ledger_;
  // Largest radiances, summed over the colours.
  const double brightestShape_, brightestSky_;
};

} // namespace openrt
