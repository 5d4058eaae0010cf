// nearest.h: Finds the known name that a mistyped one probably means. Libraries and programs share
// the search; the two users differ in what counts as near. [any thread]
#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace nearest {

// How different two names may be. Numbers are half edits, so that case can cost less than an edit.
struct Limits {
  size_t maxLetters; // a longer name is near to none
  size_t most;       // largest distance of near names
  size_t caseCost;   // a change of letter case; insert, delete and replace cost 2
};

// Returns the limits for words that people type: options, names in arguments.
inline Limits typed(std::string_view name) {
  return {std::string_view::npos, 2 * std::max<size_t>(2, name.size() / 3), 2};
}

// Returns the limits for names in files. A name of one or two letters is near only to itself, and a
// wrong case is likely.
inline Limits written(std::string_view name) { return {64, 2 * (name.size() / 3), 1}; }

// Returns the edit distance of two names (Levenshtein) in half edits. Names are short.
inline size_t distance(std::string_view a, std::string_view b, size_t caseCost) {
  std::vector<size_t> row(b.size() + 1);
  for (size_t j = 0; j <= b.size(); ++j) row[j] = 2 * j;
  const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? char(c + 32) : c; };
  for (size_t i = 1; i <= a.size(); ++i) {
    size_t diagonal = std::exchange(row[0], 2 * i);
    for (size_t j = 1; j <= b.size(); ++j) {
      const size_t replace = diagonal + (a[i - 1] == b[j - 1]                 ? 0
                                         : lower(a[i - 1]) == lower(b[j - 1]) ? caseCost
                                                                              : 2);
      diagonal = row[j];
      row[j] = std::min({replace, row[j - 1] + 2, row[j] + 2});
    }
  }
  return row[b.size()];
}

inline const std::string& nameOf(const std::string& name) { return name; }
template <class T> const std::string& nameOf(const T& item) {
  if constexpr (std::is_pointer_v<T>)
    return item->name;
  else
    return item.name;
}

// A file may declare many names, and use as many that are wrong.
constexpr size_t mostMeasured = 1000;

// Returns the first of the nearest names, or null if none is near. known: strings, or things with a
// `name`.
template <class Range>
const std::string* find(std::string_view name, const Range& known, const Limits& limits) {
  if (name.size() > limits.maxLetters) return nullptr;
  const std::string* best = nullptr;
  size_t least = limits.most + 1, measured = 0;
  for (const auto& item : known) {
    const std::string& candidate = nearest::nameOf(item);
    const size_t longer = std::max(name.size(), candidate.size());
    const size_t shorter = std::min(name.size(), candidate.size());
    if (longer - shorter >= (least + 1) / 2) continue; // an insertion for each
    if (measured++ == mostMeasured) break;
    const size_t now = distance(name, candidate, limits.caseCost);
    if (now >= least) continue;
    least = now;
    best = &candidate;
  }
  return best;
}

// Returns the known word nearest to one that somebody has typed; "" if none is near.
inline std::string word(std::string_view typo, const std::vector<std::string>& known) {
  const std::string* best = find(typo, known, typed(typo));
  return best ? *best : std::string();
}

// Returns "; did you mean 'x'?" for a name of a file; "" if none is near.
template <class Range> std::string suggestion(std::string_view name, const Range& known) {
  const std::string* best = find(name, known, written(name));
  return best ? "; did you mean '" + *best + "'?" : "";
}

} // namespace nearest
