// interpolation.h: the values of interpolators whose curves other formats do not have. Pure
// functions. [any thread]
#pragma once

#include <optional>

#include "xvrml/nodes.h"

namespace xvrml {

// Returns what value_changed of an interpolator sends for a fraction. Nothing: it has no keys, or
// the fraction is not a number.
std::optional<Vec3f> valueAt(const nodes::SplinePositionInterpolator& node, float fraction);
std::optional<Rotation> valueAt(const nodes::SquadOrientationInterpolator& node, float fraction);

} // namespace xvrml
