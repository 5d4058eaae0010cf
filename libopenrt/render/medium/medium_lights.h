// medium_lights.h: which media fill a part of the scene, and which lights shine on those that
// scatter. Between frames.
#pragma once

#include "render/render_scene.h"

namespace openrt {

// Returns whether the medium of a shader has to be known wherever a ray starts: it scatters, or it
// absorbs behind a boundary that is no surface (RTS_MEDIUM_ONLY), so that lamps shine through it.
// Glass that only absorbs is met by its surface. [commit]
bool fillsSpace(const RenderScene& scene, const ShaderSlot& shader);

// Returns whether a medium of the scene absorbs light. [commit]
bool hasAbsorption(const RenderScene& scene);

// Returns by medium the lights that shine on it: those of the first surface that bounds it. Returns
// nothing if no medium fills space, or if the transport does not follow paths. [commit]
std::vector<MediumLights> findMediumLights(const RenderScene& scene);

} // namespace openrt
