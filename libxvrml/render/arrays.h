// arrays.h: a geometry node as arrays, cut by ClipPlanes. [the thread that owns the node]
#pragma once

#include <array>
#include <span>

#include "xvrml/build.h"

namespace xvrml {

// Returns the arrays of what lies in all of the half-spaces (PlacedShape::kept). sphereSteps: as
// for geometryArrays().
GeometryArrays arraysOf(Node& geometry, std::span<const std::array<double, 4>> kept,
                        int sphereSteps, const Limits& limits);

} // namespace xvrml
