// emitter.h: the nodes that say where particles begin and which way they go (ISO/IEC 19775-1
// 40.3.1). Any thread that owns the nodes.
#pragma once

#include <functional>
#include <optional>

#include "behaviour/particles/draws.h"
#include "xvrml/nodes.h"

namespace xvrml {

struct Emitter {
  struct Start {
    V3d place, direction; // a unit vector, or 0
  };
  bool explodes = false;
  double speed = 0, variation = 0, mass = 0, surfaceArea = 0;
  uint64_t facets = 0; // triangles that each particle is compared with
  std::function<Start(Draws&)> start;
};

// Returns the emitter of a node; none if there is nothing that particles could leave.
std::optional<Emitter> emitterOf(Node* node);

} // namespace xvrml
