// arc2d.h: points on circles for the planar nodes of X3D (ISO/IEC 19775-1 clause 14).
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "geometry/faults.h"
#include "geometry/mesh.h"

namespace xvrml {

// Returns whether a size can be drawn, and notes a fault if it is not positive and finite.
bool isDrawable(float size, std::string_view field, Faults& faults);

// The part of the unit circle from one angle counter-clockwise to another.
struct Arc {
  // The whole circle: the last point is not repeated.
  bool whole = true;
  std::vector<Vec2f> points;
};
Arc wholeCircle();
// Equal angles, and those that are a turn or more apart, give the whole circle (14.3.1). Returns
// nothing, and notes a fault, if an angle is not finite.
std::optional<Arc> arcBetween(float startAngle, float endAngle, Faults& faults);

} // namespace xvrml
