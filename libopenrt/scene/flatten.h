// flatten.h: from nested instances to a flat list of placements: one for every path from the scene to an object that has
// geometry of its own. Ray kernels know one level of instances; the user's objects nest to any depth.
#pragma once

#include <cstdint>
#include <vector>

#include "scene/scene.h"

namespace openrt {

struct Placement {
  uint32_t object = 0;
  uint32_t instance = 0; // outermost
  uint32_t shader = 0;   // override: the outermost one on the path
  uint32_t lightSet = 0; // index into Flattened::lightSets
  uint32_t name = 0;     // of the innermost instance that has one
  uint64_t userData = 0; // of the innermost instance that has any
  Matrix4d matrix;       // object to world
};

struct Flattened {
  std::vector<Placement> placements;
  std::vector<std::vector<uint32_t>> lightSets; // ids of the lights that shine on a placement; set 0: the unscoped ones
  uint64_t rejected = 0;                        // placements whose matrix is not usable
  bool truncated = false;                       // more than maxPlacements
};

inline constexpr size_t maxPlacements = 4'000'000;

// Ids of the lights that shine on everything: light set 0.
std::vector<uint32_t> unscopedLights(const Scene& scene);

Flattened flatten(const Scene& scene);

} // namespace openrt
