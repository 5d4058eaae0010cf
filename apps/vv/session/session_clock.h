// session_clock.h: Turns readings of any clock into the time of a session. It is pure arithmetic
// without a clock of its own. Owned by a session. [the browser's thread]
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

namespace vv {

class SessionClock {
 public:
  enum class Mode : uint8_t {
    real,   // the time is that of the readings
    stepped // the time advances in steps of 1/fps, for scripts
  };
  // The functions that the clock calls.
  struct Driven {
    std::function<bool()> held; // returns whether steps must wait
    // Performs the step to `time`. Returns false if the same step must be repeated later.
    std::function<bool(double time)> step;
  };

  SessionClock(Mode mode, double fps) : mode_(mode), fps_(fps) {}

  // Says what a reading does to a real clock.
  enum class Reading : uint8_t { advances, isHeld };

  // Takes a reading, in seconds. Only a real clock advances, and only if it is not held.
  void read(double seconds, Reading reading = Reading::advances);
  // Lets the time since the last reading pass, at most a quarter of a second. Does nothing to a
  // real clock, which has advanced already.
  void pass();
  // Performs the steps that are due: one for a real clock, some for a stepped one.
  void run(const Driven& driven);

  double time() const { return time_; }                   // time of the last step
  double reading() const { return reading_.value_or(0); } // the last reading

 private:
  double timeOfStep() const { return double(next_) / fps_; }

  Mode mode_;
  double fps_;
  std::optional<double> reading_;
  double passed_ = 0;  // time between the last two readings
  double due_ = 0;     // the clock's time; steps up to it are due
  double time_ = 0;    // time of the last step
  long long next_ = 0; // stepped: number of the next step
};

} // namespace vv
