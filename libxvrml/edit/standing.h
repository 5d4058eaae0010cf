// standing.h: the nodes that stand anywhere in a file, kept up to date while nodes are put in and
// taken out. Internal; one thread at a time.
#pragma once

#include <optional>

#include "xvrml/node_map.h"
#include "xvrml/walk.h"

namespace xvrml {

class Standing {
 public:
  // Count a place of a node more or less, when it has been put there or taken out. null: NULL.
  void add(Node* node);
  void remove(Node* node);
  // scope: that of the file.
  bool contains(const Node& node, const Scope& scope) const;
  // Returns in how many places a node stands that the file contains.
  size_t countOf(const Node& node) const {
    const uint32_t* const count = places_.find(&node);
    return count ? *count : 0;
  }
  // To be called when nodes come in that hold themselves, as Scripts and instances may. Counts do
  // not show then when the last place outside of such a loop is gone, so the file is walked.
  void expectLoops() { loops_ = true; }

 private:
  NodeMap<uint32_t> places_; // number of places of each node that stands in the file
  bool loops_ = false;
  mutable std::optional<SeenNodes> walked_; // with loops: empty after each change
};

} // namespace xvrml
