// edited.h: what follows from edits of a world that does not run. Whoever draws a world calls this
// before; the event engine does the same for a world that runs. [the thread that owns the nodes]
#pragma once

#include "xvrml/world.h"

namespace xvrml {

// Lets the skins of figures be drawn at rest, until deform() moves them (geometry/figure.h), and
// ParticleSystems be expanded again, if the world has been edited since the last call. Any edit may
// concern them: a skin may have lost its figure, and a system reads the nodes below it. Nodes that
// are part of a running world stay as they are.
void followEdits(const World& world);

} // namespace xvrml
