// call.h: chooses the callback of a renderer for a node. [the thread that owns the node]
#pragma once

#include "xvrml/renderer.h"

namespace xvrml {

// Calls the callback for the node's type. Written by nodegen.
Visit callFor(NodeRenderer& renderer, Node& node, const RenderState& state);

} // namespace xvrml
