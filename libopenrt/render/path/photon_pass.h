// photon_pass.h: traces the light paths that guide the camera paths of a frame (photon_guide.h).
// Called between frames.
#pragma once

#include <atomic>

#include "render/render_scene.h"

namespace openrt {

// Makes scene.photonGuide. It becomes null if
// * the frame's transport samples no paths, or it takes so few samples that light paths do not pay;
// * the pixels are sensors, or a medium of the scene scatters: guided rays know neither;
// * there is no emissive shape and no sun, or no specular surface, or few light paths end on other
// surfaces;
// * a trial shows that guided rays do not lower the error at equal time (guide_trial.h).
// The result depends on the scene and its frame alone. stop: checked every few thousand paths;
// returns false if it was set. Then there is no guide.
bool guideByPhotons(RenderScene& scene, const std::atomic<bool>& stop);

// Returns a number for the size of the pass, which depends on the samples of a frame.
uint64_t photonsOf(const edit::FrameSettingsT& frame);

} // namespace openrt
