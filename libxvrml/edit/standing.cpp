#include "edit/standing.h"

#include <vector>

namespace xvrml {

void Standing::add(Node* node) {
  walked_.reset();
  std::vector<Node*> open{node};
  while (!open.empty()) {
    Node* const one = open.back();
    open.pop_back();
    if (one && (*places_.insert(one, 0).first)++ == 0) appendChildren(*one, open);
  }
}

void Standing::remove(Node* node) {
  walked_.reset();
  std::vector<Node*> open{node};
  while (!open.empty()) {
    Node* const one = open.back();
    open.pop_back();
    if (!one || --*places_.insert(one, 1).first > 0) continue;
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

} // namespace xvrml
