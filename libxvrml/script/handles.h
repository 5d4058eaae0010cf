// handles.h: the nodes that a Script knows, as numbers. A number is good while the engine's
// function runs in which it was given out, longer if it is retained; a Script's own node has a
// number that is always good and holds no reference. One table per Script; numbers are never used
// twice. [the browser's thread]
#pragma once

#include <unordered_map>

#include "xvrml/node.h"
#include "xvrml/xscript.h"

namespace xvrml {

class Handles {
 public:
  Handles(Node* own, XsNode ownNumber, XsNode& lastNumber)
      : own_(own), ownNumber_(ownNumber), last_(lastNumber) {}

  // 0 for NULL, and when the Script has too many.
  XsNode give(Node* node);
  Node* find(XsNode number) const; // null if it is not known
  bool retain(XsNode number);
  bool release(XsNode number);
  void endCall(); // forgets what has not been retained
  void clear();
  void setOwn(Node* own) { own_ = own; }
  size_t size() const { return entries_.size(); }

  static constexpr size_t most = 1'000'000;

 private:
  struct Entry {
    NodeRef node;
    uint64_t retained = 0;
    bool lent = false; // in lent_
  };
  Node* own_;
  const XsNode ownNumber_;
  XsNode& last_;
  std::unordered_map<XsNode, Entry> entries_;
  std::unordered_map<const Node*, XsNode> numbers_;
  std::vector<XsNode> lent_;
};

} // namespace xvrml
