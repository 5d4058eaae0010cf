// time_dependent.h: the state machine that decides when TimeSensors, AudioClips and MovieTextures
// are active (clause 4.6.9) and paused (ISO/IEC 19775-1 8.2.4). Each of these nodes has one in its
// NodeState and sends the events of its steps. [the browser's thread]
#pragma once

#include <limits>

#include "xvrml/behaviour.h"

namespace xvrml {

// The timing fields of a node. cycle: the length of a cycle in seconds; 0: nothing to play, so a
// run ends at once.
struct TimeFields {
  double startTime = 0, stopTime = 0, cycle = 1;
  bool loop = false, enabled = true;
  double pauseTime = 0, resumeTime = 0;

  bool stops() const { return stopTime > startTime; }
};

// The effect of one moment on a node. If `running` is false, the other fields have no meaning.
struct TimeStep {
  bool running = false; // active: time, cycleStart and fraction are set
  bool begins = false;  // isActive TRUE must be sent
  bool ends = false;    // isActive FALSE must be sent after the final events
  bool newCycle = false;
  // A step at this very time has already sent fraction and time, or it is paused.
  bool alreadySent = false;
  bool pauses = false;   // isPaused TRUE must be sent after fraction and time
  bool resumes = false;  // isPaused FALSE must be sent before them
  double time = 0;       // in seconds: now, or the exact end if it has passed since the last step
  double cycleStart = 0; // in seconds: start of the cycle that `time` lies in
  // Part of the cycle that has passed, in [0,1]; 1 at the cycle's end, never 0.
  double fraction = 0;
  double elapsed = 0; // seconds that it has been active in the world, without pauses
};

// Says which events of two states can be sent. Each can be sent only once per cascade; a second
// change of its state waits for the next tick.
struct MaySend {
  bool active = true, paused = true;
};

class TimeDependent {
 public:
  // Starts the state machine when the node joins the world at time now. A run that would be over by
  // now stays inactive.
  void begin(const TimeFields& fields, double now);
  // Advances time to now.
  TimeStep tick(const TimeFields& fields, double now, MaySend may);
  // Handles a field that an event has set at time now. started: the field is startTime.
  TimeStep fieldChanged(const TimeFields& fields, double now, MaySend may, bool started);
  bool active() const { return active_; }
  bool paused() const { return paused_; }
  // Returns whether tick() must be called, because the node is active or will be.
  bool wantsTicks(const TimeFields& fields, double now) const;

  // Returns whether the node accepts a field value (clauses 4.6.9, 6.50). An active node ignores
  // startTime, and a stopTime that is not after startTime.
  bool accepts(const TimeFields& fields, const Node& node, const FieldInfo& field,
               const Value& value) const;

 private:
  TimeStep step(const TimeFields& fields, double now, MaySend may);
  void changePause(const TimeFields& fields, double from, double now, double over, TimeStep& step);
  void wait(double from, double until);
  void place(const TimeFields& fields, TimeStep& step) const;
  double end(const TimeFields& fields) const;

  bool active_ = false;
  // At the last step startTime, or permission to send isActive, was still to come.
  bool waiting_ = false;
  bool finished_ = false; // a run without loop is over; a new startTime or loop TRUE starts another
  double last_ = 0;       // time of the last step
  double stepped_ = std::numeric_limits<double>::quiet_NaN(); // `now` of the last active step
  double ticked_ = std::numeric_limits<double>::quiet_NaN();  // time of the last tick
  // Start of the present cycle in seconds, as if pauses within it had come before it.
  double cycleStart_ = 0;
  bool paused_ = false;
  double pausedAt_ = 0; // time at which it paused; meaningless if it does not pause
  double waited_ = 0;   // seconds of all pauses of this run
  double joined_ = 0;   // time at which the node became part of the world
  double idle_ = 0;     // seconds of the pauses of this run since then
};

} // namespace xvrml
