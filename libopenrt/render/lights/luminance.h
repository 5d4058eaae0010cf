// luminance.h: the luminance of radiance, by which emitters are sampled. Pure function.
#pragma once

#include <algorithm>
#include <cmath>

#include "scene/vec3.h"

namespace openrt {

// Returns the luminance of a linear sRGB colour, at most 1e30; 0 if it is negative or not finite.
inline double luminance(const Vec3f& c) {
  const double l = 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z;
  return std::isfinite(l) && l > 0 ? std::min(l, 1e30) : 0;
}

} // namespace openrt
