// nesting.h: how deep the nodes of a document stand in each other. Internal; one thread at a time.
#pragma once

#include <cstdint>

#include "xvrml/world.h"

namespace xvrml {

// Knows a bound, so that the document is not walked for each edit. A node that stands in several
// places counts in all of them, because its text may move from one to another.
class Nesting {
 public:
  // Measures the roots of a file, which takes as long as a walk.
  void measure(const Scope& scope);
  // Returns whether a node can be put into a parent (null: the roots), so that no node stands in
  // more than `most` nodes then, itself included.
  bool admits(const Scope& scope, const Node* parent, Node& node, uint64_t most);
  // Notes that a node is being put in somewhere.
  void note(Node& node);

 private:
  uint64_t deepest_ = 0;          // no node stands deeper
  const Node* admitted_ = nullptr; // the last node that was admitted, and is being put in
  uint64_t height_ = 0;           // how many of its nodes stand in each other
};

} // namespace xvrml
