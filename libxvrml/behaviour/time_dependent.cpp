// time_dependent.cpp: implements the state machine of time-dependent nodes. Decisions where the
// standard is silent are in docs/decisions/0014.
#include "behaviour/time_dependent.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "behaviour/named_fields.h"

namespace xvrml {
namespace {

constexpr double never = std::numeric_limits<double>::infinity();

} // namespace

// "The default values are specified such that any node with default values is already inactive"
// (4.6.9). A replay may begin at time 0, the default startTime. So a run without loop that would
// have begun by then counts as over.
void TimeDependent::begin(const TimeFields& fields, double now) {
  last_ = joined_ = now;
  finished_ = !fields.loop && fields.startTime <= 0;
  waiting_ = !finished_ && (fields.startTime > now || end(fields) > now);
}

bool TimeDependent::accepts(const TimeFields& fields, const Node& node, const FieldInfo& field,
                            const Value& value) const {
  if (!active_) return true;
  if (isField<"startTime">(node, field)) return false;
  return !isField<"stopTime">(node, field) || std::get<SFTime>(value) > fields.startTime;
}

bool TimeDependent::wantsTicks(const TimeFields& fields, double now) const {
  if (active_ || (waiting_ && fields.enabled)) return true;
  return fields.enabled && !finished_ && (fields.startTime > now || end(fields) > now);
}

// An eventOut sends at most one event per timestamp (4.10.3). So a second tick at the same time
// sends nothing for an active node, nor does a field that is set in between. A field change that
// ends the run sends the final events again (6.50).
TimeStep TimeDependent::tick(const TimeFields& fields, double now, MaySend may) {
  if (std::exchange(ticked_, now) == now && active_ && fields.enabled && now < end(fields))
    return {};
  return step(fields, now, may);
}

TimeStep TimeDependent::fieldChanged(const TimeFields& fields, double now, MaySend may,
                                     bool started) {
  if (started || fields.loop) finished_ = false;
  if (!active_ && may.active) waiting_ = false;
  return step(fields, now, may);
}

// Returns when the current run, or one that would begin now, is over.
double TimeDependent::end(const TimeFields& fields) const {
  const double stop = fields.stops() ? fields.stopTime : never;
  if (fields.loop || paused_) return stop;
  double over = (active_ ? cycleStart_ : fields.startTime) + fields.cycle;
  const double pause = fields.pauseTime, resume = fields.resumeTime;
  if (!active_ && pause >= fields.startTime && pause < over && pause != resume)
    over = pause < resume ? over + (resume - pause) : never;
  return std::min(stop, over);
}

// Adds a pause to those of this run. The present cycle lasts longer by it.
void TimeDependent::wait(double from, double until) {
  const double pause = std::max(0.0, until - from);
  waited_ += pause;
  cycleStart_ += pause;
  idle_ += std::max(0.0, until - std::max(from, joined_));
}

// Pauses or resumes an active node (ISO/IEC 19775-1 8.2.4). It pauses from pauseTime until
// resumeTime, or until a later resumeTime is set. A pauseTime before the start of the run belongs
// to an earlier one. from: the time of the last step; times before it count as now.
void TimeDependent::changePause(const TimeFields& fields, double from, double now, double over,
                                TimeStep& step) {
  const double pause = fields.pauseTime, resume = fields.resumeTime;
  if (paused_) {
    if (!(pause <= resume && resume <= now)) return;
    wait(pausedAt_, std::clamp(resume, std::min(from, now), now));
    paused_ = false;
    step.resumes = true;
  } else if (pause >= fields.startTime && pause <= now && pause < over) {
    if (pause > resume || resume > now) {
      paused_ = step.pauses = true;
      pausedAt_ = std::clamp(pause, std::min(from, now), now);
    } else if (pause < resume && pause >= from && resume > from) { // a pause between two ticks
      wait(pause, resume);
    }
  }
}

// Finds the position of step.time in its cycle. The remainder is exact in double, however long ago
// startTime was. A time after the end of a cycle by less than the clock's resolution counts as that
// end.
void TimeDependent::place(const TimeFields& fields, TimeStep& step) const {
  const double start = fields.startTime + waited_, elapsed = step.time - start;
  step.cycleStart = start;
  step.fraction = 0;
  if (!(fields.cycle > 0) || !(elapsed > 0) || !std::isfinite(elapsed)) return;
  const double resolution =
      std::numeric_limits<double>::epsilon() * std::max(std::abs(step.time), std::abs(start));
  double rest = std::fmod(elapsed, fields.cycle);
  if (elapsed >= fields.cycle && rest <= resolution) rest = 0;
  // A cycle such as .1 is no exact double, so the sum of many may fall a little after the intended
  // time.
  if (fields.cycle > 8 * resolution && fields.cycle - rest <= resolution) rest = 0;
  step.cycleStart = step.time - rest;
  step.fraction = rest == 0 ? 1 : rest / fields.cycle;
}

TimeStep TimeDependent::step(const TimeFields& fields, double now, MaySend may) {
  TimeStep step;
  double cycleStart = fields.startTime;
  if (!active_) {
    const bool waited =
        std::exchange(waiting_, fields.enabled && !finished_ && fields.startTime > now);
    if (waiting_ || finished_ || !fields.enabled || !(fields.startTime <= now)) return step;
    // A run between two ticks is not lost: it begins in the second tick and ends in the next.
    double over = end(fields);
    if (over <= now && !waited && fields.startTime < now) return step;
    if (!may.active) {
      waiting_ = true;
      return step;
    }
    waited_ = idle_ = 0;
    cycleStart_ = fields.startTime;
    active_ = true;
    if (may.paused) changePause(fields, fields.startTime, now, end(fields), step);
    step.time = paused_ ? pausedAt_ : std::min(now, over);
    step.begins = step.newCycle = true;
    place(fields, step);
    if (step.cycleStart == step.time && step.time < over)
      step.fraction = 0; // joined at the end of a cycle: the next one begins
    cycleStart = step.cycleStart;
    if (!fields.loop) {
      cycleStart = fields.startTime + waited_;
      step.cycleStart = fields.startTime;
      if (step.time >= cycleStart + fields.cycle) step.fraction = 1;
    }
  } else {
    const bool wasPaused = paused_;
    if (may.paused && fields.enabled) changePause(fields, stepped_, now, end(fields), step);
    const double over = fields.enabled ? end(fields) : now;
    step.ends = now >= over && may.active;
    step.alreadySent = (stepped_ == now || (wasPaused && paused_)) && !step.ends;
    step.time = now >= over ? std::clamp(over, std::min(last_, now), now)
                            : now; // a stopTime in the past stops now
    if (paused_ && step.ends) {    // the pause ends with the run, where it began
      wait(pausedAt_, step.time);
      paused_ = false;
      step.resumes = !std::exchange(step.pauses, false);
    } else if (paused_) {
      step.time = pausedAt_;
    }
    place(fields, step);
    if (!fields.loop && step.time >= cycleStart_ + fields.cycle) step.fraction = 1;
    step.newCycle = fields.loop && step.cycleStart > cycleStart_ + fields.cycle / 2;
    if (now >= over && step.cycleStart >= step.time)
      step.newCycle = false; // no cycle begins at the end
    if (!step.newCycle) step.cycleStart = cycleStart_;
    cycleStart = step.cycleStart;
    if (step.ends) {
      active_ = false;
      finished_ = !fields.loop && fields.enabled;
    }
  }
  step.running = true;
  step.elapsed = std::max(0.0, step.time - std::max(fields.startTime, joined_) - idle_);
  stepped_ = now;
  cycleStart_ = cycleStart;
  last_ = step.time;
  return step;
}

} // namespace xvrml
