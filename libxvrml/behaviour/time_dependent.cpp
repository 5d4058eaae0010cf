// time_dependent.cpp: implements the state machine of time-dependent nodes. Decisions where the
// standard is silent are in docs/decisions/0014.
#include "behaviour/time_dependent.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace xvrml {
namespace {

constexpr double never = std::numeric_limits<double>::infinity();

} // namespace

// "The default values are specified such that any node with default values is already inactive"
// (4.6.9). A replay may begin at time 0, the default startTime. So a run without loop that would
// have begun by then counts as over.
void TimeDependent::begin(const TimeFields& fields, double now) {
  last_ = now;
  finished_ = !fields.loop && fields.startTime <= 0;
  waiting_ = !finished_ && (fields.startTime > now || end(fields) > now);
}

bool TimeDependent::accepts(const TimeFields& fields, const FieldInfo& field,
                            const Value& value) const {
  if (!active_) return true;
  if (field.name == "startTime") return false;
  return field.name != "stopTime" || std::get<SFTime>(value) > fields.startTime;
}

bool TimeDependent::wantsTicks(const TimeFields& fields, double now) const {
  if (active_ || (waiting_ && fields.enabled)) return true;
  return fields.enabled && !finished_ && (fields.startTime > now || end(fields) > now);
}

// An eventOut sends at most one event per timestamp (4.10.3). So a second tick at the same time
// sends nothing for an active node, nor does a field that is set in between. A field change that
// ends the run sends the final events again (6.50).
TimeStep TimeDependent::tick(const TimeFields& fields, double now, bool maySendActive) {
  if (std::exchange(ticked_, now) == now && active_ && fields.enabled && now < end(fields))
    return {};
  return step(fields, now, maySendActive);
}

TimeStep TimeDependent::fieldChanged(const TimeFields& fields, double now, bool maySendActive,
                                     bool started) {
  if (started || fields.loop) finished_ = false;
  if (!active_ && maySendActive) waiting_ = false;
  return step(fields, now, maySendActive);
}

// Returns when the current run, or one that would begin now, is over.
double TimeDependent::end(const TimeFields& fields) const {
  const double stop = fields.stops() ? fields.stopTime : never;
  if (fields.loop) return stop;
  return std::min(stop, (active_ ? cycleStart_ : fields.startTime) + fields.cycle);
}

// Finds the position of step.time in its cycle. The remainder is exact in double, however long ago
// startTime was. A time after the end of a cycle by less than the clock's resolution counts as that
// end.
void TimeDependent::place(const TimeFields& fields, TimeStep& step) const {
  const double elapsed = step.time - fields.startTime;
  step.cycleStart = fields.startTime;
  step.fraction = 0;
  if (!(fields.cycle > 0) || !(elapsed > 0) || !std::isfinite(elapsed)) return;
  const double resolution = std::numeric_limits<double>::epsilon() *
                            std::max(std::abs(step.time), std::abs(fields.startTime));
  double rest = std::fmod(elapsed, fields.cycle);
  if (elapsed >= fields.cycle && rest <= resolution) rest = 0;
  // A cycle such as .1 is no exact double, so the sum of many may fall a little after the intended
  // time.
  if (fields.cycle > 8 * resolution && fields.cycle - rest <= resolution) rest = 0;
  step.cycleStart = step.time - rest;
  step.fraction = rest == 0 ? 1 : rest / fields.cycle;
}

TimeStep TimeDependent::step(const TimeFields& fields, double now, bool maySendActive) {
  TimeStep step;
  if (!active_) {
    const bool waited =
        std::exchange(waiting_, fields.enabled && !finished_ && fields.startTime > now);
    if (waiting_ || finished_ || !fields.enabled || !(fields.startTime <= now)) return step;
    // A run between two ticks is not lost: it begins in the second tick and ends in the next.
    if (end(fields) <= now && !waited && fields.startTime < now) return step;
    if (!maySendActive) {
      waiting_ = true;
      return step;
    }
    step.time = std::min(now, end(fields));
    step.begins = step.newCycle = true;
    place(fields, step);
    if (step.cycleStart == step.time && step.time < end(fields))
      step.fraction = 0; // joined at the end of a cycle: the next one begins
    if (!fields.loop) {
      step.cycleStart = fields.startTime;
      if (step.time >= fields.startTime + fields.cycle) step.fraction = 1;
    }
    active_ = true;
  } else {
    const double over = fields.enabled ? end(fields) : now;
    step.ends = now >= over && maySendActive;
    step.alreadySent = stepped_ == now && !step.ends;
    step.time = now >= over ? std::clamp(over, std::min(last_, now), now)
                            : now; // a stopTime in the past stops now
    place(fields, step);
    if (!fields.loop && step.time >= cycleStart_ + fields.cycle) step.fraction = 1;
    step.newCycle = fields.loop && step.cycleStart > cycleStart_ + fields.cycle / 2;
    if (now >= over && step.cycleStart >= step.time)
      step.newCycle = false; // no cycle begins at the end
    if (!step.newCycle) step.cycleStart = cycleStart_;
    if (step.ends) {
      active_ = false;
      finished_ = !fields.loop && fields.enabled;
    }
  }
  step.running = true;
  stepped_ = now;
  cycleStart_ = step.cycleStart;
  last_ = step.time;
  return step;
}

} // namespace xvrml
