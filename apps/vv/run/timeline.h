// timeline.h: Chooses the moments of a world to render (start/world_clock.h advances the world to
// them). [main thread]
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "options/options.h"

namespace vv {

struct Moment {
  double time = 0;                // time of the world's clock
  std::optional<long long> frame; // number in the sequence
  double turn = 0;                // rotation around the world in radians
};

class Timeline {
 public:
  // With --missing, reads the files of all frames.
  explicit Timeline(const Options& options);
  size_t size() const { return count_; }
  Moment operator[](size_t i) const;

 private:
  const Options& options_;
  std::vector<long long> missing_; // the frames, if only those are made
  size_t count_ = 1;
};

} // namespace vv
