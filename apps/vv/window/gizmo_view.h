// gizmo_view.h: Draws the handles of the selected node over the picture. [main thread, within a
// frame of Gui]
#pragma once

#include "edit/gizmo.h"

namespace vv {

// hot: the axis whose handle is brighter, because the pointer is there or moves it; -1: none.
void drawGizmo(const Gizmo& gizmo, int hot);

} // namespace vv
