// glossy_trial.h: decides for a frame where light paths by way of glossy surfaces take a part of
// its light (lights/light_path_weights.h): connected to the camera, or to surfaces that it sees by
// way of mirrors and glass. [render]
#pragma once

#include <atomic>

#include "render/render_scene.h"

namespace openrt {

// Sets RenderScene::glossySources, showsGlossy and connectsGlossy of a scene that is ready for a
// frame, where such light paths are expected to lower the product of variance and rays. The trial
// has random numbers of its own, and does not depend on the number of samples or their seed, so
// that the sums of longer pictures and of other seeds can be added. Returns false if `stop` was
// set.
bool tryGlossyPaths(RenderScene& scene, const std::atomic<bool>& stop);

} // namespace openrt
