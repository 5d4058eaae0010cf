// standing.h: the nodes that stand anywhere in a file, in how many places and how deep, kept up to
// date while nodes are put in and taken out. Internal; one thread at a time.
#pragma once

#include <optional>

#include "xvrml/node_map.h"
#include "xvrml/walk.h"

namespace xvrml {

class Standing {
 public:
  // Count a place of a node more or less, when it has been put there or taken out. null: NULL.
  // parent: what holds it there; null: the roots.
  void add(Node* node, const Node* parent);
  void remove(Node* node);
  // scope: that of the file.
  bool contains(const Node& node, const Scope& scope) const;
  // Returns in how many places a node stands that the file contains.
  size_t countOf(const Node& node) const {
    const Places* const found = places_.find(&node);
    return found ? found->count : 0;
  }
  // Returns in how many nodes a node stands at most, itself included, as deep as it has ever been
  // since it was put in; 0: nowhere. A node that stands in several places counts in all of them,
  // because its text may move from one to another.
  uint64_t depthOf(const Node& node) const {
    const Places* const found = places_.find(&node);
    return found ? found->depth : 0;
  }
  // To be called when nodes come in that hold themselves, as Scripts and instances may. Counts do
  // not show then when the last place outside of such a loop is gone, so the file is walked.
  void expectLoops() { loops_ = true; }

 private:
  struct Places {
    uint32_t count = 0, depth = 0;
  };
  NodeMap<Places> places_; // the nodes that stand in the file
  bool loops_ = false;
  mutable std::optional<SeenNodes> walked_; // with loops: empty after each change
};

// Returns how many nodes stand in each other at most, from this one on. A node that holds itself
// counts as if it did not.
uint64_t heightOf(Node& node);

} // namespace xvrml
