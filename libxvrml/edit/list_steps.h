// list_steps.h: how a list of nodes in a text becomes the list of a document, with as many nodes as
// possible left in their places. [any thread]
#pragma once

#include <vector>

#include "parse/text_layout.h"

namespace xvrml {

struct ListStep {
  // replace: the node takes the place of another one. insert: it gets a place of its own behind
  // what has been written; if nothing has, before the next place that is kept.
  enum class Kind : uint8_t { keep, replace, remove, insert } kind;
  size_t place;     // index of the place in the text; not for insert
  const Node* node; // null: NULL; not for remove
};

// Returns the steps in the order of the text.
std::vector<ListStep> listSteps(const std::vector<NodePlace>& places, const MFNode& list);

} // namespace xvrml
