// size_groups.h: splits what moves together into groups that single precision can hold. The frame
// of an Embree scene is rounded relative to its size, so a small thing would vanish in the frame of
// one that is far away. Pure functions; called by Survey.
#pragma once

#include <cstdint>
#include <vector>

#include "backend/local/accel/bake.h"

namespace openrt {

inline constexpr uint32_t mostGroups = 64; // the last ones may hold too much

// Returns the number of the group of each box. A group is at most `largestToSmallest` times as
// large as its smallest member; boxes without a size follow the others.
std::vector<uint32_t> groupBySize(const std::vector<Box>& boxes);

} // namespace openrt
