// handles.h: the handles (numbers) under which a Script knows nodes. A handle is valid during the
// engine function in which it was given out, or longer if it is retained. The handle of the
// Script's own node is always valid and holds no reference. One table per Script; numbers are never
// reused. [the browser's thread]
#pragma once

#include <unordered_map>

#include "xvrml/node.h"
#include "xvrml/xscript.h"

namespace xvrml {

class Handles {
 public:
  Handles(Node* own, XsNode ownNumber, XsNode& lastNumber)
      : own_(own), ownNumber_(ownNumber), last_(lastNumber) {}

  // Returns the handle of a node. Returns 0 for NULL, and if the Script has too many handles.
  XsNode handleOf(Node* node);
  Node* find(XsNode number) const; // returns null if the handle is unknown
  bool retain(XsNode number);
  bool release(XsNode number);
  void endCall(); // drops the handles that have not been retained
  void clear();
  void setOwn(Node* own) { own_ = own; }
  size_t size() const { return entries_.size(); }

  static constexpr size_t most = 1'000'000;

 private:
  struct Entry {
    NodeRef node;
    uint64_t retained = 0;
    bool lent = false; // the handle is in lent_
  };
  Node* own_;
  const XsNode ownNumber_;
  XsNode& last_;
  std::unordered_map<XsNode, Entry> entries_;
  std::unordered_map<const Node*, XsNode> numbers_;
  std::vector<XsNode> lent_;
};

} // namespace xvrml
