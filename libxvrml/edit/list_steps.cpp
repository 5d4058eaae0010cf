#include "edit/list_steps.h"

#include <algorithm>
#include <iterator>

namespace xvrml {
namespace {

constexpr size_t none = ~size_t(0);

// Returns for each node of the list the place that it keeps, or none: the longest increasing
// subsequence of places (C. Schensted, "Longest increasing and decreasing subsequences", 1961).
std::vector<size_t> keptPlaces(const std::vector<NodePlace>& places, const MFNode& list) {
  std::unordered_map<const Node*, std::vector<size_t>> unused; // last ones first
  for (size_t i = places.size(); i-- > 0;) unused[places[i].node].push_back(i);
  std::vector<size_t> place(list.size(), none);
  for (size_t i = 0; i < list.size(); ++i) {
    const auto found = unused.find(list[i].get());
    if (found == unused.end() || found->second.empty()) continue;
    place[i] = found->second.back();
    found->second.pop_back();
  }
  std::vector<size_t> ends, before(list.size(), none); // indices in the list
  for (size_t i = 0; i < list.size(); ++i) {
    if (place[i] == none) continue;
    const auto at = std::lower_bound(ends.begin(), ends.end(), i,
                                     [&](size_t a, size_t b) { return place[a] < place[b]; });
    if (at != ends.begin()) before[i] = *std::prev(at);
    if (at == ends.end())
      ends.push_back(i);
    else
      *at = i;
  }
  std::vector<size_t> kept(list.size(), none);
  for (size_t i = ends.empty() ? none : ends.back(); i != none; i = before[i]) kept[i] = place[i];
  return kept;
}

} // namespace

std::vector<ListStep> listSteps(const std::vector<NodePlace>& places, const MFNode& list) {
  using Kind = ListStep::Kind;
  const std::vector<size_t> kept = keptPlaces(places, list);
  std::vector<ListStep> steps;
  bool begun = false; // a place of the text has been passed that has a node
  size_t next = 0;    // the next place of the text
  size_t fresh = 0;   // the next node of the list
  // Writes the nodes and places before a node that is kept.
  const auto between = [&](size_t place, size_t node) {
    for (; next < place && fresh < node; ++next, ++fresh) {
      steps.push_back({Kind::replace, &places[next], list[fresh].get()});
      begun = true;
    }
    const Kind kind = begun || places.empty() ? Kind::behind : Kind::before;
    for (; fresh < node; ++fresh) steps.push_back({kind, nullptr, list[fresh].get()});
    for (; next < place; ++next) steps.push_back({Kind::remove, &places[next], nullptr});
  };
  for (size_t i = 0; i < list.size(); ++i) {
    if (kept[i] == none) continue;
    between(kept[i], i);
    steps.push_back({Kind::keep, &places[next++], list[fresh++].get()});
    begun = true;
  }
  between(places.size(), list.size());
  return steps;
}

} // namespace xvrml
