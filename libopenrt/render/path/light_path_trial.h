// light_path_trial.h: decides for a frame which light camera paths and light paths share
// (lights/light_path_weights.h), and how many light paths there are. [render]
#pragma once

#include <atomic>

#include "render/render_scene.h"

namespace openrt {

// Sets RenderScene::lightPathsOfCameraPath, sharesMirrors, glossySources, showsGlossy and
// connectsGlossy of a scene that is ready for a frame, where that is expected to lower the product
// of variance and rays. The trial
// has random numbers of its own, and does not depend on the number of samples or their seed, so
// that the sums of longer pictures and of other seeds can be added. Returns false if `stop` was
// set.
bool tryLightPaths(RenderScene& scene, const std::atomic<bool>& stop);

} // namespace openrt
