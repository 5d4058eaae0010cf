// whole_scene.h: writes a scene as one commit, for a worker that joins late. [any], while the scene
// does not change.
#pragma once

#include <memory>

#include "scene/scene.h"

namespace openrt {

// Returns a commit that makes an equal scene when applied to an empty one: the same ids and array
// numbers (later commits may use them again), hence the same pictures. References to deleted things
// become null.
std::shared_ptr<const Commit> wholeScene(const Scene& scene);

} // namespace openrt
