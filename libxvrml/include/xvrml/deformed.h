// deformed.h: the vectors of a Coordinate, CoordinateDouble or Normal as they are drawn. They are
// those of its field, unless a figure of H-Anim moves them (ISO/IEC 19775-1 26). [the thread that
// owns the nodes; a span is valid until the node or its figure changes]
#pragma once

#include <span>

#include "xvrml/nodes.h"

namespace xvrml {

// Returns the points that are drawn, in the coordinates of the geometry that holds the node.
std::span<const Vec3f> drawnPoints(const nodes::Coordinate& node);
std::span<const Vec3d> drawnPoints(const nodes::CoordinateDouble& node);
// Returns the normals that are drawn: unit vectors where a figure moves them.
std::span<const Vec3f> drawnNormals(const nodes::Normal& node);

} // namespace xvrml
