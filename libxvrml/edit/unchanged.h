// unchanged.h: finds the nodes of a file that are to be written as they stand in its text, with all
// that is in them, so that each is copied as one piece. Internal; one thread at a time.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "edit/document.h"

namespace xvrml {

class Unchanged {
 public:
  // Looks at all nodes of the file once. It must not be edited as long as this object is used.
  explicit Unchanged(const Document& document);
  // Returns the texts of all nodes within a node, and at the end its own. Empty: some of it may
  // have to be written otherwise, or the node does not come from the file.
  std::span<const NodeText> within(const Node& node) const;

 private:
  const Document& document_;
  // For the text of each node the number of the first text within it. Nodes stand in the order of
  // their ends, so that all between are within it, too.
  std::vector<size_t> first_;
};

} // namespace xvrml
