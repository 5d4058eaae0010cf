// figures.cpp: keeps the skins of figures where their joints are, in a running world. Any change
// may concern them, so all are moved again after the cascade; the renderer sees those that are
// drawn in another way.
#include "event/engine.h"
#include "geometry/figure.h"
#include "xvrml/nodes.h"

namespace xvrml {

// Remembers the figures among nodes that have become part of the world. Nobody draws them yet.
void Engine::addFigures(const std::vector<NodeRef>& nodes) {
  for (const NodeRef& node : nodes) {
    if (!deforms(node->type())) continue;
    deforming_[liveOf(*node)->order] = node.get();
    deform(*node, &diagnostics_);
  }
}

void Engine::moveFigures() {
  if (!figuresOutdated_) return;
  for (const auto& [order, node] : deforming_)
    for (Node* moved : deform(*node, nullptr))
      changed(*moved,
              *moved->type().find(moved->type().index == nodes::Coordinate::typeIndex ? "point"
                                                                                      : "vector"));
  figuresOutdated_ = false;
}

} // namespace xvrml
