// readout_view.h: Draws what is seen where the pointer rests, beside it. [main thread, within a
// frame of Gui]
#pragma once

#include "edit/probes.h"

namespace vv {

// isReadable: as in pointerText().
void drawReadout(const PointerReading& pointer, bool isReadable);

} // namespace vv
