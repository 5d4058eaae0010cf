// near_lamps.h: finds emitting shapes that are so near to a surface that the offset of spawned rays
// is not small compared to the distance between them. Called between frames by LocalBackend.
#pragma once

#include <string>

#include "render/render_scene.h"

namespace openrt {

// Returns a warning about the worst such lamp, with its distance and the distance that is needed;
// empty if there is none. Traces rays along the normals of up to 1024 shapes, so it finds lamps
// that face the surface they light. Lamps that touch the surface send no light there and do not
// count.
std::string warnOfNearLamps(const RenderScene& scene);

// Returns a warning if a quadric or an asphere emits light, which is not sampled; else an empty
// text.
std::string warnOfAnalyticLamps(const RenderScene& scene);

} // namespace openrt
