// adjoint.h: importance transport: what differs at a surface if a path comes from a light. [render]
#pragma once

#include <cmath>

#include "openrt/openrts.h"
#include "scene/vec3.h"

namespace openrt {

// Returns the correction for shading normals in importance transport: flux scales with the cosines
// at the geometric normal, lobes with those at their own normal. E. Veach, 1997, 5.3.
inline float adjointCorrection(const RtsLobe& lobe, const RtsHits& hits, uint32_t i,
                               const Vec3f& out) {
  const Vec3f n = load(lobe.normal, i), g = load(hits.geometric, i), d = load(hits.direction, i);
  const float t = dot(n, d) * dot(g, out) / (dot(g, d) * dot(n, out));
  return std::isfinite(t) ? std::fabs(t) : 0.0f;
}

// Returns the factor by which a rough boundary has scaled the weight of a sample that it refracts,
// because it scales radiance by eta squared; 1 for other samples.
inline float radianceScale(const RtsLobe& lobe, uint32_t i, const Vec3f& out) {
  if (lobe.kind != RTS_LOBE_ROUGH_DIELECTRIC || !(dot(out, load(lobe.normal, i)) < 0)) return 1;
  return lobe.parameter[0][i] * lobe.parameter[0][i];
}

} // namespace openrt
