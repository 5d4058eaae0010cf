// hit_counts.h: how many samples of each pixel of a tile have hit which name first (RT_COVERAGE).
// Counts are whole numbers of names that do not depend on each other, so that the order in which
// they are merged does not matter.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace openrt {

struct HitCount {
  uint32_t pixel = 0; // place in the tile, row by row
  uint32_t name = 0;  // not 0
  uint32_t times = 0; // not 0
  bool operator==(const HitCount&) const = default;
};

class HitCounts {
 public:
  // In a pixel with more names, those with the smallest numbers are counted. A count that is kept
  // is complete, because a name is not among so many of all samples if it is not among those of
  // some.
  static constexpr uint32_t mostNames = 1024;

  void clear() { counts_.clear(); }
  bool empty() const { return counts_.empty(); }
  // Adds a sample that has hit this name; 0 is none. Call finish() after the last one.
  void add(uint32_t pixel, uint32_t name);
  void finish();
  void merge(const HitCounts& more);
  // Takes counts that come from anywhere. Returns false if finish() would not have made them.
  bool assign(std::vector<HitCount> counts, uint32_t pixels);
  // Returns the counts by pixel and name, each once.
  std::span<const HitCount> all() const { return counts_; }

 private:
  void combine();
  std::vector<HitCount> counts_;
};

} // namespace openrt
