// photon_pass.h: traces the light paths that guide the camera paths of a frame (photon_guide.h).
// Called between frames.
#pragma once

#include <memory>

#include "render/render_scene.h"

namespace openrt {

// Returns null if the frame's transport samples no paths, if no emissive shape or no specular
// surface is there, if too few light paths end on other surfaces, or if the frame takes so few
// samples that light paths do not pay. before: a snapshot with everything in the same places, or
// null. The result depends on the scene and its frame alone.
std::shared_ptr<const PhotonGuide> makePhotonGuide(const RenderScene& scene,
                                                   const RenderScene* before);

} // namespace openrt
