// line_properties.h: LineProperties, PointProperties and FillProperties (ISO/IEC 19775-1 12.4.2,
// 12.4.3, :2023 12.4.7) as sizes in pixels. [the mapper's thread]
#pragma once

#include "xvrml/nodes.h"
#include "xvrml/world.h"

namespace xvrml::mapper {

struct LineSizes {
  float line = 1, point = 1; // width of lines and diameter of points, in pixels
};
// Returns the sizes for an appearance, which may be null.
LineSizes lineSizes(const nodes::Appearance* appearance);
// Warns of what is not drawn: patterns of lines, and points that get smaller with their distance.
void warnOfLines(const nodes::Appearance* appearance, World& world);
// Warns of hatching, and of a back with another kind of material, which are not drawn.
void warnOfFaces(const nodes::Appearance* appearance, World& world);

} // namespace xvrml::mapper
