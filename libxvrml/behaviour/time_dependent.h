// time_dependent.h: when TimeSensors, AudioClips and MovieTextures run (clause 4.6.9): one state
// machine for all three. Each has one as (part of) its NodeState and sends what its steps say. [the
// browser's thread]
#pragma once

#include <limits>

#include "xvrml/behaviour.h"

namespace xvrml {

// What the fields of a node say. cycle: the length of a cycle in seconds; 0: nothing to play, one
// run is over at once.
struct TimeFields {
  double startTime = 0, stopTime = 0, cycle = 1;
  bool loop = false, enabled = true;

  bool stops() const { return stopTime > startTime; }
};

// What one moment means for a node. Nothing but `running` false: it does not run.
struct TimeStep {
  bool running = false; // time, cycleStart and fraction are set
  bool begins = false;  // isActive TRUE is due
  bool ends = false;    // isActive FALSE is due, after the final events
  bool newCycle = false;
  bool told = false; // what goes on has had a step at this very time before: fraction and time have
                     // been sent
  double time = 0;   // seconds: now, or the exact end if that has passed since the last step
  double cycleStart = 0; // seconds: beginning of the cycle that `time` lies in
  double fraction = 0;   // of that cycle, in [0,1]: 1, never 0, at its end
};

class TimeDependent {
 public:
  // The node has become part of the world at time now. What would have ended before stays inactive.
  void begin(const TimeFields& fields, double now);
  // Time has come to now. mayTurn: isActive can be sent (it cannot twice in a cascade: then a
  // change waits for the next tick).
  TimeStep tick(const TimeFields& fields, double now, bool mayTurn);
  // A field has got a value by an event at time now; started: it was startTime.
  TimeStep fieldChanged(const TimeFields& fields, double now, bool mayTurn, bool started);
  bool active() const { return active_; }
  // Whether tick() has to be called: it runs, or will.
  bool wantsTicks(const TimeFields& fields, double now) const;

  // Clauses 4.6.9, 6.50: an active node takes no startTime, and no stopTime that is not after
  // startTime.
  bool accepts(const TimeFields& fields, const FieldInfo& field, const Value& value) const;

 private:
  TimeStep step(const TimeFields& fields, double now, bool mayTurn);
  void place(const TimeFields& fields, TimeStep& step) const;
  double end(const TimeFields& fields) const;

  bool active_ = false;
  bool waiting_ = false; // startTime, or the turn of isActive, was still to come at the last step
  bool finished_ =
      false;        // a run without loop is over: it takes a new startTime, or loop, to run again
  double last_ = 0; // time of the last step
  double stepped_ =
      std::numeric_limits<double>::quiet_NaN();              // now of the last step in which it ran
  double ticked_ = std::numeric_limits<double>::quiet_NaN(); // time of the last tick
  double cycleStart_ = 0;
};

} // namespace xvrml
