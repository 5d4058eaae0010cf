// group.cpp: nests what VRML 1.0 writes in order.
#include "parse/vrml1/group.h"

namespace xvrml::vrml1 {

void Group::closeTransform(Level& level) {
  if (level.transform) graph_.finish(level.transform);
  level.transform = {};
}

void Group::add(const NodeRef& child, const TreeNode& from) {
  if (!child) return;
  Level& level = levels_.back();
  level.onlyLights = false;
  if (level.transform && !(level.placed == placement)) closeTransform(level);
  if (placement.isIdentity()) {
    level.children.push_back(child);
    return;
  }
  if (!level.transform) {
    auto* transform = graph_.make<nodes::Transform>(from);
    level.transform = NodeRef(transform);
    level.placed = placement;
    placement.writeTo(*transform);
    level.children.push_back(level.transform);
  }
  nodeCast<nodes::Transform>(level.transform)->children.push_back(child);
}

void Group::addLight(const NodeRef& light, const TreeNode& from) {
  if (!levels_.back().onlyLights && levels_.size() < maximumLevels) {
    closeTransform(levels_.back());
    levels_.emplace_back().from = &from;
  }
  closeTransform(levels_.back());
  levels_.back().children.push_back(light);
}

MFNode Group::finish() {
  for (; levels_.size() > 1; levels_.pop_back()) {
    Level& level = levels_.back();
    closeTransform(level);
    auto* group = graph_.make<nodes::Group>(*level.from);
    group->children = std::move(level.children);
    levels_[levels_.size() - 2].children.push_back(graph_.finish(NodeRef(group)));
  }
  closeTransform(levels_.back());
  return std::exchange(levels_.back(), {}).children;
}

} // namespace xvrml::vrml1
