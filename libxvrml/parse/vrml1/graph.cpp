// graph.cpp: the limits of a graph that is being made.
#include "parse/vrml1/graph.h"

#include <utility>

#include <fmt/format.h>

#include "graph/expander.h"
#include "graph/range.h"

namespace xvrml::vrml1 {

NodeRef Graph::finish(NodeRef node) {
  for (const FieldInfo& field : node->type().fields) {
    RangeFault fault;
    // A Transform may mirror what it holds: negative scales are meant.
    if (!field.range.bounded() || field.type == FieldType::SFRotation || field.name == "scale" ||
        !holdsValue(field) || node->isUnset(field) ||
        enforceRange(field, nullptr, node->storage(field), &fault))
      continue;
    if (reported_.insert(node->type().name + '.' + field.name).second)
      state_.diagnostics.warn(node->source, describe(node->type(), field, fault));
  }
  if (stopped_ || state_.budget.take(nodeBytes(*node))) return node;
  stopped_ = true;
  if (!std::exchange(state_.full, true))
    state_.diagnostics.error(node->source,
                             fmt::format("the world takes more memory than {}; the nodes of this "
                                         "file from {} on are left out",
                                         state_.budget.name(), node->type().name));
  return node;
}

void Graph::name(const NodeRef& node, const TreeNode& from) {
  if (from.name.empty() || !node->defName.empty() || !named_.insert(&from).second) return;
  node->defName = from.name;
  file_.scope.names.insert_or_assign(from.name, node);
}

void Graph::visit(const TreeNode& node) {
  const uint64_t limit = state_.options.limits.expandedNodes;
  if (++visits_ > limit)
    stop(node, fmt::format("the file has more nodes, shared ones counted at each USE, than limit "
                           "expandedNodes={}",
                           limit));
}

void Graph::stop(const TreeNode& at, const std::string& reason) {
  if (!std::exchange(stopped_, true))
    locator_.error(at.at, reason + "; the nodes from here on are left out");
}

} // namespace xvrml::vrml1
