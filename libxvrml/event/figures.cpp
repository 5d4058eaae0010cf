// figures.cpp: keeps the skins of figures where their joints are, and particles where their
// emitters and forces lead them, in a running world. Any change may concern them, so all are moved
// again after the cascade; the renderer sees those that are drawn in another way. Vertices that are
// taken out of a figure, or whose figure is taken out of the scene, go back to rest.
#include <utility>

#include "event/engine.h"
#include "event/hierarchy.h"
#include "geometry/figure.h"
#include "xvrml/nodes.h"

namespace xvrml {

static bool isParticles(const Node& node) {
  return node.type().index == nodes::ParticleSystem::typeIndex;
}

// Remembers the figures and particles among nodes that have become part of the world. Nobody draws
// them yet.
void Engine::addFigures(const std::vector<NodeRef>& nodes) {
  for (const NodeRef& node : nodes) {
    if (isParticles(*node)) deforming_[liveOf(*node)->order] = node.get();
    if (!deforms(node->type())) continue;
    deforming_[liveOf(*node)->order] = node.get();
    deform(*node, &diagnostics_);
    noteSkin(*node);
  }
}

void Engine::noteSkin(const Node& figure) {
  for (Node* part : skinOf(figure)) skins_.emplace(part, part);
}

void Engine::moveFigures() {
  if (!figuresOutdated_) return;
  const auto before = std::exchange(skins_, {});
  for (const auto& [order, node] : deforming_) {
    if (isParticles(*node)) {
      renewExpansion(*node);
      continue;
    }
    if (!isInScene(*node)) continue; // its skin may be part of the scene elsewhere, at rest
    for (Node* moved : deform(*node, nullptr)) changed(*moved, vectorsOf(*moved));
    noteSkin(*node);
  }
  for (const auto& [part, held] : before)
    if (!skins_.contains(part) && straighten(*part)) changed(*part, vectorsOf(*part));
  figuresOutdated_ = false;
}

} // namespace xvrml
