#include "edit/alignment.h"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <optional>
#include <unordered_map>

namespace xvrml {
namespace {

// Bounds for lists that have little in common. The rows of shortestEdit take 8 MB at most.
constexpr size_t mostDifferences = 2000;
constexpr uint64_t mostComparisons = uint64_t(1) << 26;

// Aligns what lies between the elements that are equal at both ends.
template <class Align> Alignment betweenEnds(Keys olds, Keys news, const Align& align) {
  const size_t most = std::min(olds.size(), news.size());
  size_t begin = 0, rest = 0; // elements that are equal at both ends
  while (begin < most && olds[begin] == news[begin]) ++begin;
  while (begin + rest < most && olds[olds.size() - 1 - rest] == news[news.size() - 1 - rest])
    ++rest;
  Alignment kept(news.size(), fresh);
  std::iota(kept.begin(), kept.begin() + std::ptrdiff_t(begin), size_t(0));
  std::iota(kept.end() - std::ptrdiff_t(rest), kept.end(), olds.size() - rest);
  const Keys oldMiddle = olds.subspan(begin, olds.size() - begin - rest),
             newMiddle = news.subspan(begin, news.size() - begin - rest);
  if (oldMiddle.empty() || newMiddle.empty()) return kept;
  const Alignment middle = align(oldMiddle, newMiddle);
  for (size_t i = 0; i < middle.size(); ++i)
    if (middle[i] != fresh) kept[begin + i] = begin + middle[i];
  return kept;
}

// Returns the longest increasing subsequence of places (C. Schensted, "Longest increasing and
// decreasing subsequences", 1961). Equal elements are paired in their order.
Alignment increasing(Keys olds, Keys news) {
  std::unordered_map<uint64_t, std::vector<size_t>> unused; // last ones first
  for (size_t i = olds.size(); i-- > 0;) unused[olds[i]].push_back(i);
  Alignment place(news.size(), fresh);
  for (size_t i = 0; i < news.size(); ++i) {
    const auto found = unused.find(news[i]);
    if (found == unused.end() || found->second.empty()) continue;
    place[i] = found->second.back();
    found->second.pop_back();
  }
  std::vector<size_t> ends, before(news.size(), fresh); // indices in the new list
  for (size_t i = 0; i < news.size(); ++i) {
    if (place[i] == fresh) continue;
    const auto at = std::lower_bound(ends.begin(), ends.end(), i,
                                     [&](size_t a, size_t b) { return place[a] < place[b]; });
    if (at != ends.begin()) before[i] = *std::prev(at);
    if (at == ends.end())
      ends.push_back(i);
    else
      *at = i;
  }
  Alignment kept(news.size(), fresh);
  for (size_t i = ends.empty() ? fresh : ends.back(); i != fresh; i = before[i]) kept[i] = place[i];
  return kept;
}

// A row has for each diagonal how many old elements are passed at most after a number of
// differences. Element i belongs to the diagonal 2 i - differences: old less new elements passed.
using Row = std::vector<uint32_t>;

// Returns whether the way to a diagonal of the next row inserts an element; else it removes one.
bool inserts(const Row& row, size_t i) { return i == 0 || (i < row.size() && row[i - 1] < row[i]); }
size_t beginAfter(const Row& row, size_t i) { return inserts(row, i) ? row[i] : row[i - 1] + 1; }

// Follows the way to the end back through the rows.
Alignment traced(const std::vector<Row>& rows, size_t olds, size_t news) {
  Alignment kept(news, fresh);
  size_t differences = rows.size() - 1;
  for (size_t i = (olds + differences - news) / 2;; --differences) {
    const size_t begin = differences == 0 ? 0 : beginAfter(rows[differences - 1], i);
    while (olds > begin) kept[--news] = --olds;
    if (differences == 0) return kept;
    if (inserts(rows[differences - 1], i)) {
      --news;
    } else {
      --olds;
      --i;
    }
  }
}

// Returns an alignment with the fewest elements that are inserted or removed (E. W. Myers, "An
// O(ND) difference algorithm and its variations", 1986); nothing if there are more than `most`.
std::optional<Alignment> shortestEdit(Keys olds, Keys news, size_t most) {
  std::vector<Row> rows;
  uint64_t comparisons = 0;
  for (size_t differences = 0; differences <= most && comparisons < mostComparisons;
       ++differences) {
    rows.emplace_back(differences + 1);
    for (size_t i = 0; i <= differences; ++i) {
      size_t old = differences == 0 ? 0 : beginAfter(rows[differences - 1], i);
      size_t now = old + differences - 2 * i;
      for (; old < olds.size() && now < news.size() && olds[old] == news[now]; ++old, ++now)
        ++comparisons;
      rows.back()[i] = uint32_t(old);
      if (old >= olds.size() && now >= news.size()) return traced(rows, olds.size(), news.size());
    }
  }
  return std::nullopt;
}

size_t changesOf(const Alignment& alignment, size_t olds) {
  size_t changes = 0;
  forEachStep(alignment, olds, [&changes](AlignmentStep step, size_t, size_t) {
    changes += step != AlignmentStep::keep;
  });
  return changes;
}

Alignment fewest(Keys olds, Keys news) {
  Alignment inPlace(news.size(), fresh);
  for (size_t i = 0; i < std::min(olds.size(), news.size()); ++i)
    if (olds[i] == news[i]) inPlace[i] = i;
  // A replaced element is two differences at most.
  const size_t changes = changesOf(inPlace, olds.size()), useful = 2 * changes - 2;
  std::optional<Alignment> other = shortestEdit(olds, news, std::min(useful, mostDifferences));
  if (!other && useful > mostDifferences) other = increasing(olds, news);
  return other && changesOf(*other, olds.size()) < changes ? *other : inPlace;
}

} // namespace

Alignment longestInOrder(Keys olds, Keys news) { return betweenEnds(olds, news, increasing); }
Alignment fewestChanges(Keys olds, Keys news) { return betweenEnds(olds, news, fewest); }

} // namespace xvrml
