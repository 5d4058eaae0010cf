// parts.h: Draws a text of parts, between which there are two blanks or more. No part is broken, so
// that numbers stay whole. [main thread, within a frame of Gui]
#pragma once

#include <string_view>

namespace vv {

// A part that has no room in a line of this width begins the next one.
void drawParts(std::string_view text, float width);

} // namespace vv
