// nearest.h: "did you mean": finds the known name that is most similar to an unknown one. [any
// thread]
#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace xvrml {

// Returns the edit distance of two names in half edits: insert, delete and replace count 2, a
// change of letter case counts 1. Names are short.
inline size_t editDistance(std::string_view a, std::string_view b) {
  std::vector<size_t> row(b.size() + 1);
  for (size_t j = 0; j <= b.size(); ++j) row[j] = 2 * j;
  const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? char(c + 32) : c; };
  for (size_t i = 1; i <= a.size(); ++i) {
    size_t diagonal = std::exchange(row[0], 2 * i);
    for (size_t j = 1; j <= b.size(); ++j) {
      const size_t replace = diagonal + (a[i - 1] == b[j - 1]                 ? 0
                                         : lower(a[i - 1]) == lower(b[j - 1]) ? 1
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

// Returns "; did you mean 'x'?", or "" if no name is similar.
template <class Range> std::string suggestion(std::string_view name, const Range& known) {
  if (name.size() > 64) return {};
  const std::string* best = nullptr;
  // A name of one or two letters gets no suggestion, except one of different case.
  size_t distance = 2 * (name.size() / 3) + 1;
  for (const auto& item : known) {
    const std::string& candidate = nameOf(item);
    const size_t d = editDistance(name, candidate);
    if (d < distance) {
      distance = d;
      best = &candidate;
    }
  }
  return best ? "; did you mean '" + *best + "'?" : "";
}

} // namespace xvrml
