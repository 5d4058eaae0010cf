#include "script/handles.h"

#include <utility>

namespace xvrml {

XsNode Handles::handleOf(Node* node) {
  if (!node) return 0;
  if (node == own_) return ownNumber_;
  if (const auto known = numbers_.find(node); known != numbers_.end()) {
    Entry& entry = entries_.at(known->second);
    if (!std::exchange(entry.lent, true)) lent_.push_back(known->second);
    return known->second;
  }
  if (entries_.size() >= most) return 0;
  const XsNode number = ++last_;
  numbers_.emplace(node, number);
  entries_.emplace(number, Entry{NodeRef(node), 0, true});
  lent_.push_back(number);
  return number;
}

Node* Handles::find(XsNode number) const {
  if (number == ownNumber_) return own_;
  const auto found = entries_.find(number);
  return found == entries_.end() ? nullptr : found->second.node.get();
}

bool Handles::retain(XsNode number) {
  if (number == ownNumber_) return true;
  const auto found = entries_.find(number);
  if (found == entries_.end()) return false;
  ++found->second.retained;
  return true;
}

bool Handles::release(XsNode number) {
  if (number == ownNumber_) return true;
  const auto found = entries_.find(number);
  if (found == entries_.end() || found->second.retained == 0) return false;
  if (found->second.retained == 1 && !found->second.lent) {
    lent_.push_back(number); // it ends with the call
    found->second.lent = true;
  }
  --found->second.retained;
  return true;
}

// Drops handles. Nodes may be destroyed here and notify the world, so the table must not be in use
// meanwhile.
void Handles::endCall() {
  std::vector<NodeRef> gone;
  for (const XsNode number : std::exchange(lent_, {})) {
    const auto found = entries_.find(number);
    found->second.lent = false;
    if (found->second.retained > 0) continue;
    numbers_.erase(found->second.node.get());
    gone.push_back(std::move(found->second.node));
    entries_.erase(found);
  }
}

void Handles::clear() {
  const auto entries = std::exchange(entries_, {});
  numbers_.clear();
  lent_.clear();
}

} // namespace xvrml
