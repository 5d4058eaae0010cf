// deformable.h: Coordinate and Normal nodes whose vectors a figure moves (geometry/figure.h). The
// field stays as it is at rest, so that a written world and events have the rest. [the thread that
// owns the nodes]
#pragma once

#include <memory>
#include <vector>

#include "xvrml/nodes.h"

namespace xvrml {

template <class T> struct Deformable : T {
  using T::T;
  std::unique_ptr<std::vector<Vec3f>> moved; // null: the field's own vectors are drawn
};

} // namespace xvrml
