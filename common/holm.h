// holm.h: which of several tests are significant together. A pure function, for changes of probes
// and pixels in the editor and for pictures that are compared. [any thread]
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace holm {

// Returns which tests are significant, the surest first, so that with a probability of 1 - level
// none of these is chance. chances: those of all tests that are judged together; those above the
// level may be left out if `count` has the number of all.
//
// S. Holm, A simple sequentially rejective multiple test procedure, Scandinavian Journal of
// Statistics 6 (1979): the smallest chance of n is compared with level / n, the next with
// level / (n - 1), and so on, up to the first that is larger. It holds for tests that depend on
// each other, too, as those of neighbouring pixels do by their error bars.
inline std::vector<std::size_t> significantOf(const std::vector<double>& chances, double level,
                                              std::size_t count) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < chances.size(); ++i)
    if (chances[i] <= level) order.push_back(i);
  std::sort(order.begin(), order.end(), [&chances](std::size_t a, std::size_t b) {
    return chances[a] != chances[b] ? chances[a] < chances[b] : a < b;
  });
  std::size_t found = 0;
  while (found < order.size() && chances[order[found]] <= level / double(count - found)) ++found;
  order.resize(found);
  return order;
}
inline std::vector<std::size_t> significantOf(const std::vector<double>& chances, double level) {
  return significantOf(chances, level, chances.size());
}

} // namespace holm
