#include "edit/standing.h"

#include <algorithm>
#include <vector>

namespace xvrml {

void Standing::add(Node* node, const Node* parent) {
  walked_.reset();
  struct Open {
    Node* node;
    uint32_t depth;
    bool isNew; // else its depth may grow, with that of another place
  };
  std::vector<Open> open{{node, uint32_t(parent ? depthOf(*parent) : 0) + 1, true}};
  std::vector<Node*> children;
  while (!open.empty()) {
    const Open one = open.back();
    open.pop_back();
    if (!one.node) continue;
    Places& places = *places_.insert(one.node, {}).first;
    const bool isFirst = one.isNew && places.count++ == 0;
    const bool isDeeper = !loops_ && one.depth > places.depth;
    if (isFirst || isDeeper) places.depth = one.depth;
    if (!isFirst && !isDeeper) continue;
    children.clear();
    appendChildren(*one.node, children);
    // In the order of the file, in which nodes stand before their USEs.
    for (size_t i = children.size(); i-- > 0;)
      open.push_back({children[i], one.depth + 1, isFirst});
  }
}

void Standing::remove(Node* node) {
  walked_.reset();
  std::vector<Node*> open{node};
  while (!open.empty()) {
    Node* const one = open.back();
    open.pop_back();
    if (!one || --places_.insert(one, {1, 0}).first->count > 0) continue;
    places_.erase(one);
    appendChildren(*one, open);
  }
}

bool Standing::contains(const Node& node, const Scope& scope) const {
  if (!loops_) return places_.contains(&node);
  if (!walked_) {
    walked_.emplace();
    walk(rootsOf(scope), *walked_,
         [](Node& one, std::vector<Node*>& open) { appendChildren(one, open); });
  }
  return walked_->contains(&node);
}

uint64_t heightOf(Node& root) {
  struct Open {
    Node* node;
    bool isEntered;
  };
  NodeMap<uint32_t> heights; // 0: the node is being measured
  std::vector<Open> open{{&root, false}};
  std::vector<Node*> children;
  while (!open.empty()) {
    const Open one = open.back();
    open.pop_back();
    if (!one.node || (!one.isEntered && !heights.insert(one.node, 0).second)) continue;
    children.clear();
    appendChildren(*one.node, children);
    if (!one.isEntered) {
      open.push_back({one.node, true});
      for (Node* child : children) open.push_back({child, false});
      continue;
    }
    uint32_t height = 0;
    for (const Node* child : children)
      if (const uint32_t* const known = heights.find(child)) height = std::max(height, *known);
    *heights.insert(one.node, 0).first = height + 1;
  }
  return *heights.find(&root);
}

} // namespace xvrml
