// line_properties.h: LineProperties and PointProperties (ISO/IEC 19775-1 12.4.3, :2023 12.4.7) as
// sizes and patterns in pixels. [the mapper's thread]
#pragma once

#include "xvrml/nodes.h"
#include "xvrml/world.h"

namespace xvrml::mapper {

struct LineStyle {
  float line = 1, point = 1; // width of lines and diameter of points, in pixels
  uint16_t pattern = 0xffff; // the dashes: arguments of rtLineStipple
  int factor = 1;
  bool operator==(const LineStyle&) const = default;
};
// Returns the style for an appearance, which may be null.
LineStyle lineStyle(const nodes::Appearance* appearance);
// Warns of what is not drawn: some types of lines, and points that get smaller with their distance.
void warnOfLines(const nodes::Appearance* appearance, World& world);
// Warns of an unknown hatching, and of a back with another kind of material, which is not drawn.
void warnOfFaces(const nodes::Appearance* appearance, World& world);

} // namespace xvrml::mapper
