// medium_lights.h: which lights shine on the media that scatter. Between frames.
#pragma once

#include "render/render_scene.h"

namespace openrt {

// Returns by medium the lights that shine on it: those of the first surface that bounds it. Returns
// nothing if no medium of the scene scatters, or if the transport does not follow paths. [commit]
std::vector<MediumLights> findMediumLights(const RenderScene& scene);

} // namespace openrt
