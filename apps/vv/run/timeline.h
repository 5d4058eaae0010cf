// timeline.h: Chooses the moments of a world to render (start/world_clock.h advances the world to
// them), and those before that the previews of a film depend on. [main thread]
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
  bool isShown = true;            // false: it is rendered for the previews after it alone
};

class Timeline {
 public:
  // With --missing, reads the files of all frames.
  explicit Timeline(const Options& options);
  size_t size() const { return count_; }
  Moment operator[](size_t i) const;
  // Returns a moment with those before it that must be rendered, too, if the one of i - 1 was
  // rendered with its own: one, except for previews.
  std::vector<Moment> withHistory(size_t i) const;

 private:
  // Returns the moment of a frame. Before frame 0 the world rests, and a turntable goes round.
  Moment momentOf(long long frame) const;

  const Options& options_;
  std::vector<long long> missing_; // the frames, if only those are made
  size_t count_ = 1;
};

} // namespace vv
