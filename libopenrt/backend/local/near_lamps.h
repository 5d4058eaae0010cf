// near_lamps.h: emitting shapes so near to what they light that the step by which rays leave a
// surface counts beside the distance. Called between frames.
#pragma once

#include <string>

#include "render/render_scene.h"

namespace openrt {

// A message about the nearest such lamp, with its distance and the one that is needed; empty if
// there is none. Looks along the normals of up to 1024 shapes: lamps that face what they light.
// Those that touch it send no light there and do not count.
std::string warnOfNearLamps(const RenderScene& scene);

} // namespace openrt
