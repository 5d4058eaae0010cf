// comparison_view.h: Draws what belongs to a comparison of pictures over the picture: the line
// between A and the present one, the legend of what differs, and rectangles. [main thread, within a
// frame of Gui]
#pragma once

#include "edit/comparison.h"
#include "edit/region.h"

namespace vv {

// x, y: where the pointer is in the picture. free: the part that texts may stand in.
void drawComparison(const Comparison& comparison, double x, double y, const FreePart& free);
// text: stands at the left upper corner.
void drawRectangle(const Region& region, const char* text);

} // namespace vv
