// neighbours.h: where the pixels of a scaled picture lie between those of the first one, for linear
// interpolation. A pure function. [any thread]
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace picture {

// The two pixels of a row or column whose centres are beside the centre of a new one.
struct Neighbours {
  size_t first, second;
  double weight; // that of the second
};

// Returns them for each pixel of a row or column that gets another length.
inline std::vector<Neighbours> neighbours(int from, int to) {
  std::vector<Neighbours> out(static_cast<size_t>(to));
  for (int i = 0; i < to; ++i) {
    const double at = std::clamp((i + 0.5) * from / to - 0.5, 0.0, double(from - 1));
    const size_t first = size_t(at);
    out[size_t(i)] = {first, std::min(first + 1, size_t(from) - 1), at - double(first)};
  }
  return out;
}

} // namespace picture
