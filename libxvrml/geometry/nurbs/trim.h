// trim.h: cuts a grid of cells by contours in the plane of two parameters (ISO/IEC 19775-1 27.2.5).
// Pure functions; any thread.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geometry/faults.h"
#include "geometry/vector_math.h"

namespace xvrml {

// The corners of the triangles that lie within an odd number of contours.
struct TrimmedCells {
  std::vector<V2d> corners;        // no two are equal
  std::vector<uint32_t> triangles; // 3 corners for each, counterclockwise
};

// Cuts the cells between increasing values of both parameters. Neighbouring cells have the same
// corners on the line between them. most: the greatest number of triangles; beyond it, and for
// contours that are too tangled, the result is empty, with a fault.
TrimmedCells trimCells(std::span<const double> u, std::span<const double> v,
                       std::span<const std::vector<V2d>> contours, uint64_t most, Faults& faults);

} // namespace xvrml
