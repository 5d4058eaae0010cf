#include "edit/list_steps.h"

#include <algorithm>
#include <iterator>

#include "edit/alignment.h"

namespace xvrml {

static uint64_t keyOf(const Node* node) { return reinterpret_cast<uintptr_t>(node); }

std::vector<ListStep> listSteps(const std::vector<NodePlace>& places, const MFNode& list) {
  using Kind = ListStep::Kind;
  std::vector<uint64_t> olds, news;
  std::transform(places.begin(), places.end(), std::back_inserter(olds),
                 [](const NodePlace& place) { return keyOf(place.node); });
  std::transform(list.begin(), list.end(), std::back_inserter(news),
                 [](const NodeRef& node) { return keyOf(node.get()); });
  std::vector<ListStep> steps;
  bool begun = false; // a place of the text has been passed that has a node
  forEachStep(
      longestInOrder(olds, news), places.size(), [&](AlignmentStep step, size_t place, size_t now) {
        switch (step) {
        case AlignmentStep::keep:
        case AlignmentStep::replace: {
          const bool keeps = step == AlignmentStep::keep;
          steps.push_back({keeps ? Kind::keep : Kind::replace, &places[place], list[now].get()});
          begun = true;
          break;
        }
        case AlignmentStep::insert:
          steps.push_back(
              {begun || places.empty() ? Kind::behind : Kind::before, nullptr, list[now].get()});
          break;
        case AlignmentStep::remove: steps.push_back({Kind::remove, &places[place], nullptr});
        }
      });
  return steps;
}

} // namespace xvrml
