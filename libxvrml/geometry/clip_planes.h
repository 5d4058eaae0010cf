// clip_planes.h: the ClipPlanes among the children of a group (ISO/IEC 19775-1 11.4.1). Any thread.
#pragma once

#include <vector>

#include "geometry/half_space.h"
#include "xvrml/world.h"

namespace xvrml {

// Calls visit(half-space) with what each ClipPlane among the children leaves, in their coordinates.
// planes: how many cut the children already; those that are visited are added, and those beyond
// maximumClipPlanes are not visited.
template <class Visit>
void forEachHalfSpace(const std::vector<Node*>& children, size_t& planes, const Visit& visit) {
  for (Node* child : children) {
    if (planes >= maximumClipPlanes) return;
    const auto* plane = nodeCast<nodes::ClipPlane>(renderedNode(child));
    const auto kept = plane ? halfSpaceOf(*plane) : std::nullopt;
    if (!kept) continue;
    ++planes;
    visit(*kept);
  }
}

} // namespace xvrml
