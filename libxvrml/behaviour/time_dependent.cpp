// time_dependent.cpp: Decisions where the standard is silent:
// docs/decisions/0014.
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
// (4.6.9). A replay may begin at time 0, which is the default startTime: what would have begun by
// then without loop counts as over.
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

// At most one event of an eventOut has a timestamp (4.10.3): a second tick of the same time tells
// what runs nothing new, and neither does a field that is set meanwhile. One that ends the run
// brings the final events once more (6.50).
TimeStep TimeDependent::tick(const TimeFields& fields, double now, bool mayTurn) {
  if (std::exchange(ticked_, now) == now && active_ && fields.enabled && now < end(fields))
    return {};
  return step(fields, now, mayTurn);
}

TimeStep TimeDependent::fieldChanged(const TimeFields& fields, double now, bool mayTurn,
                                     bool started) {
  if (started || fields.loop) finished_ = false;
  if (!active_ && mayTurn) waiting_ = false;
  return step(fields, now, mayTurn);
}

// When the run that goes on, or would begin now, is over.
double TimeDependent::end(const TimeFields& fields) const {
  const double stop = fields.stops() ? fields.stopTime : never;
  if (fields.loop) return stop;
  return std::min(stop, (active_ ? cycleStart_ : fields.startTime) + fields.cycle);
}

// Where in its cycle step.time lies. The remainder is exact in double however far startTime lies
// back; what is less than the clock's own resolution after a cycle's end is that end.
void TimeDependent::place(const TimeFields& fields, TimeStep& step) const {
  const double elapsed = step.time - fields.startTime;
  step.cycleStart = fields.startTime;
  step.fraction = 0;
  if (!(fields.cycle > 0) || !(elapsed > 0) || !std::isfinite(elapsed)) return;
  const double resolution = std::numeric_limits<double>::epsilon() *
                            std::max(std::abs(step.time), std::abs(fields.startTime));
  double rest = std::fmod(elapsed, fields.cycle);
  if (elapsed >= fields.cycle && rest <= resolution) rest = 0;
  // A cycle such as .1 is no double: many of them end a little after the sum that is meant.
  if (fields.cycle > 8 * resolution && fields.cycle - rest <= resolution) rest = 0;
  step.cycleStart = step.time - rest;
  step.fraction = rest == 0 ? 1 : rest / fields.cycle;
}

TimeStep TimeDependent::step(const TimeFields& fields, double now, bool mayTurn) {
  TimeStep step;
  if (!active_) {
    const bool waited =
        std::exchange(waiting_, fields.enabled && !finished_ && fields.startTime > now);
    if (waiting_ || finished_ || !fields.enabled || !(fields.startTime <= now)) return step;
    // A run that lies between two ticks is not lost: it begins in the second and ends in the next.
    if (end(fields) <= now && !waited && fields.startTime < now) return step;
    if (!mayTurn) {
      waiting_ = true;
      return step;
    }
    step.time = std::min(now, end(fields));
    step.begins = step.newCycle = true;
    place(fields, step);
    if (step.cycleStart == step.time && step.time < end(fields))
      step.fraction = 0; // joined where one cycle ends: the next begins
    if (!fields.loop) {
      step.cycleStart = fields.startTime;
      if (step.time >= fields.startTime + fields.cycle) step.fraction = 1;
    }
    active_ = true;
  } else {
    const double over = fields.enabled ? end(fields) : now;
    step.ends = now >= over && mayTurn;
    step.told = stepped_ == now && !step.ends;
    step.time = now >= over ? std::clamp(over, std::min(last_, now), now)
                            : now; // a stopTime set into the past stops now
    place(fields, step);
    if (!fields.loop && step.time >= cycleStart_ + fields.cycle) step.fraction = 1;
    step.newCycle = fields.loop && step.cycleStart > cycleStart_ + fields.cycle / 2;
    if (now >= over && step.cycleStart >= step.time)
      step.newCycle = false; // none begins at the end
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
