// extrusion_frames.h: the spine-aligned cross-section planes of an Extrusion (clauses 6.18.2
// and 6.18.3).
#pragma once

#include <span>
#include <vector>

#include "geometry/vector_math.h"

namespace xvrml {

// Unit axes at right angles: the cross-section's x and z lie along x and z, y points along the
// spine.
struct SpineFrame {
  V3d x, y, z;
};

// One frame a spine point. `closed`: the first and last points are the same place.
std::vector<SpineFrame> spineFrames(std::span<const Vec3f> spine, bool closed);

} // namespace xvrml
