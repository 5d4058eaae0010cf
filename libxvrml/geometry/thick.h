// thick.h: balls in place of points and rods in place of lines, where a viewer asks for a size in
// the units of the Shape. Any thread.
#pragma once

#include "geometry/faults.h"
#include "geometry/mesh.h"

namespace xvrml {

// Replaces points by balls of the diameter options.pointSize, and lines by rods of the diameter
// options.lineWidth with balls at their ends, in the same colours. Leaves other meshes, sizes of 0,
// and what would have too many triangles as they are.
void thicken(Mesh& mesh, const MeshOptions& options, Faults& faults);

} // namespace xvrml
