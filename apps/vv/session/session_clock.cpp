#include "session/session_clock.h"

#include <algorithm>

namespace vv {

namespace {

constexpr int maxSteps = 10;        // maximum number of steps before a picture
constexpr double maxPassing = 0.25; // seconds; a slow picture does not cause a burst of steps

} // namespace

void SessionClock::read(double seconds, Reading reading) {
  passed_ = reading_ ? std::max(0.0, seconds - *reading_) : 0;
  reading_ = seconds;
  if (mode_ == Mode::real && reading == Reading::advances) due_ += passed_;
}

void SessionClock::pass() {
  if (mode_ == Mode::stepped) due_ += std::min(passed_, maxPassing);
}

void SessionClock::run(const Driven& driven) {
  switch (mode_) {
  case Mode::real:
    time_ = due_;
    driven.step(time_);
    return;
  case Mode::stepped:
    for (int i = 0; i < maxSteps && timeOfStep() <= due_ && !driven.held(); ++i) {
      time_ = timeOfStep();
      if (!driven.step(time_)) return;
      ++next_;
    }
    due_ = std::min(due_, timeOfStep());
    return;
  }
}

} // namespace vv
