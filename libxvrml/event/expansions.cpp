// expansions.cpp: keeps the expansions of plug-in nodes up to date in a running world. A new
// expansion is compared with the old one. Equal parts stay, and the others get new values, so that
// the renderer sees only real changes.
#include <algorithm>

#include "event/engine.h"
#include "graph/expansion.h"
#include "graph/field_access.h"

namespace xvrml {
namespace {

// Returns whether a node of the old expansion can stay in place of one in the new expansion.
bool canReuse(const NodeRef& old, const NodeRef& fresh) {
  return old && fresh && &old->type() == &fresh->type() && isMadeByPlugin(*old) &&
         isMadeByPlugin(*fresh) && !fresh->live;
}

bool sameNodes(const MFNode& old, const MFNode& fresh) {
  return std::equal(old.begin(), old.end(), fresh.begin(), fresh.end(),
                    [](const NodeRef& a, const NodeRef& b) { return a == b || canReuse(a, b); });
}

} // namespace

void Engine::renewExpansions() {
  // Expanding a node may outdate a node of another plug-in. 32 rounds are enough for nested
  // plug-ins.
  for (int round = 0; !outdated_.empty() && round < 32; ++round) {
    std::vector<NodeRef> nodes = std::exchange(outdated_, {});
    std::sort(nodes.begin(), nodes.end(), [](const NodeRef& a, const NodeRef& b) {
      return (a->live ? liveOf(*a)->order : 0) < (b->live ? liveOf(*b)->order : 0);
    });
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    for (const NodeRef& node : nodes)
      if (node->live) renewExpansion(*node);
  }
  outdated_.clear();
}

void Engine::renewExpansion(Node& node) {
  NodeRef* place = node.expansion();
  if (!place) return;
  const NodeRef fresh = makeExpansion(node);
  if (*place == fresh) return;
  if (canReuse(*place, fresh)) return reuseNodes(**place, *fresh);
  const NodeRef old = std::exchange(*place, fresh);
  if (old && old->live) unlinkChild(node, *old);
  if (fresh) {
    adopt(*fresh);
    linkChild(node, *fresh);
  }
  // For the nodes that hold this node, or the prototype instance it stands for, the value of a
  // field has changed.
  std::vector<Node*> open{&node};
  for (size_t i = 0; i < open.size() && i < 10'000; ++i) {
    const Node* child = open[i];
    if (liveOf(*child)->root) rootsChanged();
    for (Node* parent : liveOf(*child)->parents) {
      if (parent->type().index < 0 || parent->type().expand) {
        open.push_back(parent);
        continue;
      }
      forEachChild(*parent, [&](NodeRef& held, const FieldInfo& field) {
        if (held.get() == child) changed(*parent, field);
      });
    }
  }
}

// Gives the old nodes the values of the new ones. Nodes made by the plug-in are compared in turn.
void Engine::reuseNodes(Node& old, Node& fresh) {
  std::vector<std::pair<NodeRef, NodeRef>> open{{NodeRef(&old), NodeRef(&fresh)}};
  while (!open.empty()) {
    const auto [to, from] = open.back();
    open.pop_back();
    for (const FieldInfo& field : to->type().fields) {
      if (!holdsValue(field)) continue;
      Value before = to->get(field), after = from->get(field);
      if (before == after) continue;
      if (field.type == FieldType::SFNode) {
        const NodeRef &a = std::get<NodeRef>(before), &b = std::get<NodeRef>(after);
        if (canReuse(a, b)) {
          open.emplace_back(a, b);
          continue;
        }
      } else if (field.type == FieldType::MFNode) {
        const auto &a = std::get<MFNode>(before), &b = std::get<MFNode>(after);
        if (sameNodes(a, b)) {
          for (size_t i = 0; i < a.size(); ++i)
            if (!(a[i] == b[i])) open.emplace_back(a[i], b[i]);
          continue;
        }
      }
      store(*to, field, std::move(after));
    }
  }
}

} // namespace xvrml
