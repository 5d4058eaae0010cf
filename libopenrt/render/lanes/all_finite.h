// all_finite.h: a quick test of arrays, with vector lanes. [any thread]
#pragma once

#include <cstdint>

namespace openrt {

// Returns whether none of n numbers is NaN or infinite.
bool allFinite(const float* values, uint32_t n);

} // namespace openrt
