#include "edit/list_steps.h"

#include <algorithm>
#include <iterator>
#include <unordered_map>

namespace xvrml {
namespace {

constexpr size_t none = ~size_t(0);

// Finds the places that nodes of a list keep, and of both only what lies behind the first `begin`
// and before the last `rest` of them: the longest increasing subsequence of places (C. Schensted,
// "Longest increasing and decreasing subsequences", 1961).
void keepBetween(const std::vector<NodePlace>& places, const MFNode& list, size_t begin,
                 size_t rest, std::vector<size_t>& kept) {
  const size_t lastPlace = places.size() - rest, lastNode = list.size() - rest;
  std::unordered_map<const Node*, std::vector<size_t>> unused; // last ones first
  for (size_t i = lastPlace; i-- > begin;) unused[places[i].node].push_back(i);
  std::vector<size_t> place(list.size(), none);
  for (size_t i = begin; i < lastNode; ++i) {
    const auto found = unused.find(list[i].get());
    if (found == unused.end() || found->second.empty()) continue;
    place[i] = found->second.back();
    found->second.pop_back();
  }
  std::vector<size_t> ends, before(list.size(), none); // indices in the list
  for (size_t i = begin; i < lastNode; ++i) {
    if (place[i] == none) continue;
    const auto at = std::lower_bound(ends.begin(), ends.end(), i,
                                     [&](size_t a, size_t b) { return place[a] < place[b]; });
    if (at != ends.begin()) before[i] = *std::prev(at);
    if (at == ends.end())
      ends.push_back(i);
    else
      *at = i;
  }
  for (size_t i = ends.empty() ? none : ends.back(); i != none; i = before[i]) kept[i] = place[i];
}

// Returns for each node of the list the place that it keeps, or none.
std::vector<size_t> keptPlaces(const std::vector<NodePlace>& places, const MFNode& list) {
  std::vector<size_t> kept(list.size(), none);
  const size_t most = std::min(places.size(), list.size());
  size_t begin = 0, rest = 0; // nodes that are equal at both ends
  for (; begin < most && places[begin].node == list[begin].get(); ++begin) kept[begin] = begin;
  for (; begin + rest < most; ++rest) {
    const size_t place = places.size() - 1 - rest, node = list.size() - 1 - rest;
    if (places[place].node != list[node].get()) break;
    kept[node] = place;
  }
  if (begin + rest < list.size()) keepBetween(places, list, begin, rest, kept);
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
