// glossy_trial.h: decides for a frame whether light paths by way of glossy surfaces take a part of
// its light (lights/light_path_weights.h). [render]
#pragma once

#include <atomic>

#include "render/render_scene.h"

namespace openrt {

// Sets RenderScene::glossySources of a scene that is ready for a frame, if such light paths are
// expected to lower the product of variance and rays. The trial has random numbers of its own, and
// does not depend on the number of samples or their seed, so that the sums of longer pictures and
// of other seeds can be added. Returns false if `stop` was set.
bool tryGlossyPaths(RenderScene& scene, const std::atomic<bool>& stop);

} // namespace openrt
