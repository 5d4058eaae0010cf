// unsampled_lights.h: counts the emitted light that only BSDF sampling can find: paths that come
// from a non-specular surface via mirrors, smooth boundaries or whatever light samples do not pass
// straight (UnsampledLight, ledger.h). [render]
#pragma once

#include "render/film/ledger.h"
#include "render/lights/emitters.h"
#include "render/render_scene.h"
#include "render/wave/path_states.h"

namespace openrt {

// Returns whether the hits of a camera path on area lights and on the sun are left to light
// tracing, so that only the rest of the sky counts.
inline bool canOnlyReachSky(const RenderScene& scene, PathFlags path) {
  return scene.lightSources && path.pathClass() == PathClass::caustic;
}

class UnsampledLights {
 public:
  UnsampledLights(const RenderScene& scene, Ledger& ledger)
      : scene_(scene), ledger_(ledger), brightestShape_(scene.emitters->brightestShape()),
        brightestSky_(scene.emitters->brightestSky()), hasSun_(scene.emitters->hasSun()) {}
  // Counts a ray, if light sampling cannot find the emitter that it may hit. unguidedWeight: as in
  // RayState. A sky without sun has no brighter part that rays could be guided to. Without its sun
  // a sky has none that rays could miss.
  void send(PathFlags path, const Vec3f& throughput, float unguidedWeight = 1) {
    if (!path.unsampled()) return;
    if (!path.specularSinceDiffuse()) unguidedWeight = 1; // guided rays find light of mirrors only
    const bool reachesLights = !canOnlyReachSky(scene_, path);
    if (reachesLights || !hasSun_)
      ledger_.unsampledSky.send(throughput, brightestSky_, hasSun_ ? double(unguidedWeight) : 1);
    if (reachesLights) ledger_.unsampled.send(throughput, brightestShape_, double(unguidedWeight));
  }
  // Counts the emission of a shape that such a ray has hit.
  void meet(PathFlags path, const Vec3f& radiance, float unguidedWeight) {
    if (!path.unsampled() || canOnlyReachSky(scene_, path)) return;
    if (!path.specularSinceDiffuse()) unguidedWeight = 1;
    ledger_.unsampled.meet(radiance, brightestShape_, double(unguidedWeight));
  }
  // Counts the radiance of the sky that such a ray has reached.
  void meetSky(PathFlags path, const Vec3f& radiance, float unguidedWeight) {
    if (!path.unsampled() || (hasSun_ && canOnlyReachSky(scene_, path))) return;
    if (!path.specularSinceDiffuse()) unguidedWeight = 1;
    ledger_.unsampledSky.meet(radiance, brightestSky_, hasSun_ ? double(unguidedWeight) : 1);
  }

 private:
  const RenderScene& scene_;
  Ledger& ledger_;
  // Largest radiances, summed over the colours.
  const double brightestShape_, brightestSky_;
  const bool hasSun_;
};

} // namespace openrt
