#include "geometry/edited.h"

#include <utility>

#include "geometry/figure.h"
#include "xvrml/nodes.h"
#include "xvrml/walk.h"

namespace xvrml {

void followEdits(const World& world) {
  if (!std::exchange(world.edited, false)) return;
  walk(rootsOf(world.scope), [](Node& node, std::vector<Node*>& open) {
    if (node.live) return;
    straighten(node);
    if (node.type().index == nodes::ParticleSystem::typeIndex)
      if (NodeRef* const drawn = node.expansion()) *drawn = {};
    if (const auto* instance = nodeCast<ProtoInstance>(&node)) appendRoots(instance->body, open);
    if (const Scope* content = inlineScope(node)) appendRoots(*content, open);
    appendChildren(node, open);
  });
}

} // namespace xvrml
