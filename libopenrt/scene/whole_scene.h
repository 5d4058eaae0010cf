// whole_scene.h: a scene as one commit, for those who were not there when it came to be: a worker
// that joins late. [any], while nobody changes the scene.
#pragma once

#include <memory>

#include "scene/scene.h"

namespace openrt {

// Applied to an empty scene it makes an equal one: the same ids, the same numbers of arrays (later
// commits may name them again), hence the same pictures. What names something that was deleted
// names nothing instead.
std::shared_ptr<const Commit> wholeScene(const Scene& scene);

} // namespace openrt
