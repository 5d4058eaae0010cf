// weld.h: finds equal vertices of triangles that do not share them. Pure functions, any thread.
#pragma once

#include <cstdint>
#include <vector>

#include "xvrml/types.h"

namespace xvrml {

// Returns the bytes that weldPoints() needs for that many points, beside them.
uint64_t weldBytes(uint64_t points);
// Removes points that equal earlier ones exactly (0 equals -0). Returns for each former point its
// number among those that are left. At most 2^31 - 1 points.
std::vector<uint32_t> weldPoints(std::vector<Vec3f>& points);

} // namespace xvrml
