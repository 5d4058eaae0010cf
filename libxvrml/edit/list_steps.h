// list_steps.h: how a list of nodes in a text becomes the list of a document, with as many nodes as
// possible left in their places. [any thread]
#pragma once

#include <vector>

#include "parse/text_layout.h"

namespace xvrml {

struct ListStep {
  // replace: the node takes the place of another one. before, behind: it gets a place of its own,
  // before the next place or behind the last one.
  enum class Kind : uint8_t { keep, replace, remove, before, behind } kind;
  const NodePlace* place; // in the text; null for before and behind
  const Node* node;       // null: NULL; not for remove
};

// Returns the steps in the order of the text.
std::vector<ListStep> listSteps(const std::vector<NodePlace>& places, const MFNode& list);

} // namespace xvrml
