// world_time.h: Turns the time of a session into the time of its world, which the user can pause.
// Owned by a Pilot. [the browser's thread]
#pragma once

#include <algorithm>
#include <cstdint>

namespace vv {

class WorldTime {
 public:
  enum class State : uint8_t { running, paused };

  // start: the world's time at session time 0.
  explicit WorldTime(double start) : start_(start) {}

  // Advances the session to `seconds`. Returns the seconds that have passed.
  double advance(double seconds) {
    const double passed = std::max(0.0, seconds - session_);
    session_ = seconds;
    if (isPaused()) pausedSeconds_ += passed;
    return passed;
  }
  // Changes between running and paused.
  void toggle() { state_ = isPaused() ? State::running : State::paused; }
  bool isPaused() const { return state_ == State::paused; }
  // Lets the world's time pass without the session's.
  void skip(double seconds) { start_ += seconds; }
  // Returns the world's time while it runs.
  double time() const { return start_ + (session_ - pausedSeconds_); }

 private:
  State state_ = State::running;
  double start_, session_ = 0, pausedSeconds_ = 0;
};

} // namespace vv
