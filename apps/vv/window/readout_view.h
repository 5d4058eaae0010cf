// readout_view.h: Draws what is seen where the pointer rests, beside it. [main thread, within a
// frame of Gui]
#pragma once

#include "edit/probes.h"

namespace vv {

// isReadable: as in pointerText(). free: the part of the picture that no panel covers.
void drawReadout(const PointerReading& pointer, bool isReadable, const FreePart& free);

} // namespace vv
