// timeline.h: which moments of a world are pictured, and how its clock gets there: in steps of
// 1/fps from 0, so that the world at frame N is the same whether the frames before it are pictured
// or not. No wall clock. [main thread]
#pragma once

#include <functional>
#include <utility>

#include "options/options.h"
#include "xvrml/browser.h"

namespace vv {

struct Moment {
  double time = 0;                // of the world's clock
  std::optional<long long> frame; // number in its sequence
  double turn = 0;                // radians around the world
};

class Timeline {
 public:
  explicit Timeline(const Options& options);
  size_t size() const { return count_; }
  Moment operator[](size_t i) const;

 private:
  const Options& options_;
  size_t count_ = 1;
};

class WorldClock {
 public:
  WorldClock(xvrml::Browser& browser, double fps)
      : WorldClock([&browser](double time) { browser.tick(time); }, fps) {}
  // tick: what a step is.
  WorldClock(std::function<void(double time)> tick, double fps)
      : tick_(std::move(tick)), fps_(fps) {}
  // Steps up to `time`, which is not before the last one. False, and not there, after an interrupt.
  bool advance(double time);

 private:
  std::function<void(double time)> tick_;
  double fps_;
  long long next_ = 0;          // step that comes next: at next_ / fps
  std::optional<double> there_; // the time it has come to
};

} // namespace vv
