// adjoint.h: importance transport: what differs at a surface if a path comes from a light. [render]
#pragma once

#include <cmath>

#include "render/vectors.h"

namespace openrt {

// Returns the correction for shading normals in importance transport: flux scales with the cosines
// at the geometric normal, lobes with those at their own normal. E. Veach, 1997, 5.3.
inline float adjointCorrection(const RtsLobe& lobe, const RtsHits& hits, uint32_t i,
                               const float out[3]) {
  const Vector3 n = vectorAt(lobe.normal, i), g = vectorAt(hits.geometric, i),
                d = vectorAt(hits.direction, i);
  const float t = dot3(n, d) * dot3(g, out) / (dot3(g, d) * dot3(n, out));
  return std::isfinite(t) ? std::fabs(t) : 0.0f;
}

} // namespace openrt
