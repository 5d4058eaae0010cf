// world_clock.h: Advances the clock of a world in steps of 1/fps from 0. The world at frame N is
// therefore the same whether earlier frames are rendered or not. The wall clock is never used.
// [main thread]
#pragma once

#include <functional>
#include <optional>
#include <utility>

#include "xvrml/browser.h"

namespace vv {

// Returns the time of the first step of 1/fps at or after `time`, where a script's events happen.
double timeOfStep(double time, double fps);

class WorldClock {
 public:
  WorldClock(xvrml::Browser& browser, double fps)
      : WorldClock([&browser](double time) { browser.tick(time); }, fps) {}
  // tick: performs one step.
  WorldClock(std::function<void(double time)> tick, double fps)
      : tick_(std::move(tick)), fps_(fps) {}
  // Steps up to `time`, which must not decrease. Returns false after an interrupt; the clock then
  // stops earlier.
  bool advance(double time);

 private:
  std::function<void(double time)> tick_;
  double fps_;
  long long next_ = 0;                // number of the next step, at time next_ / fps
  std::optional<double> currentTime_; // the current time
};

} // namespace vv
