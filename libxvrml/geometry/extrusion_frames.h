// extrusion_frames.h: the spine-aligned cross-section planes of an Extrusion (clauses 6.18.2
// and 6.18.3).
#pragma once

#include <span>
#include <vector>

#include "geometry/vector_math.h"

namespace xvrml {

// Orthonormal axes of one cross-section plane. x and z are the axes of the cross-section; y points
// along the spine.
struct SpineFrame {
  V3d x, y, z;
};

// Returns one frame per spine point. closed: the first and last points coincide.
std::vector<SpineFrame> spineFrames(std::span<const Vec3f> spine, bool closed);

} // namespace xvrml
