// deformable.h: nodes with coordinates or normals that a figure moves (geometry/figure.h). The
// field stays as it is at rest, so that a written world and events have the rest. [the thread that
// owns the nodes]
#pragma once

#include <memory>

#include "xvrml/nodes.h"

namespace xvrml {

// Vectors: the type of the field.
template <class T, class Vectors = MFVec3f> struct Deformable : T {
  using T::T;
  std::unique_ptr<Vectors> moved; // null: the field's own vectors are drawn
};
using DeformableCoordinate = Deformable<nodes::Coordinate>;
using DeformableCoordinateDouble = Deformable<nodes::CoordinateDouble, MFVec3d>;
using DeformableNormal = Deformable<nodes::Normal>;

} // namespace xvrml
