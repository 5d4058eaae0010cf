// expansions.cpp: keeps what nodes of plug-ins stand for up to date in a running world. A new
// answer is compared with the former one: equal parts stay as they are, the others get new values,
// so that only they are changes for those who draw. See engine.h.
#include <algorithm>

#include "event/engine.h"
#include "graph/expansion.h"
#include "graph/field_access.h"

namespace xvrml {
namespace {

// A node of the former answer that can take the place of one in the new answer.
bool canTakeOver(const NodeRef& old, const NodeRef& fresh) {
  return old && fresh && &old->type() == &fresh->type() && isMadeByPlugin(*old) &&
         isMadeByPlugin(*fresh) && !fresh->live;
}

bool sameNodes(const MFNode& old, const MFNode& fresh) {
  return std::equal(old.begin(), old.end(), fresh.begin(), fresh.end(),
                    [](const NodeRef& a, const NodeRef& b) { return a == b || canTakeOver(a, b); });
}

} // namespace

void Engine::renewExpansions() {
  // One that stands for a node of another plug-in outdates that one; more rounds than plug-ins nest
  // are none.
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
  if (canTakeOver(*place, fresh)) return takeOver(**place, *fresh);
  const NodeRef old = std::exchange(*place, fresh);
  if (old && old->live) unlinkChild(node, *old);
  if (fresh) {
    adopt(*fresh);
    linkChild(node, *fresh);
  }
  // For those who hold the node, or the prototype instance it stands in, their field has another
  // value.
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

// The former nodes get the new ones' values; those that are no values but made nodes are compared
// in turn.
void Engine::takeOver(Node& old, Node& fresh) {
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
        if (canTakeOver(a, b)) {
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
