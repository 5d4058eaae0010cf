// time_sensor.cpp: TimeSensor (clause 6.50, ISO/IEC 19775-1 8.4.1), based on the state machine of
// time-dependent nodes.
#include "behaviour/builtin.h"
#include "behaviour/time_dependent.h"
#include "xvrml/nodes.h"

namespace xvrml {
namespace {

struct State : NodeState {
  TimeDependent time;
};

// The fields of TimeSensor that are sent, looked up once.
struct SentFields {
  const FieldInfo &isActive = fieldNamed("isActive"), &cycleTime = fieldNamed("cycleTime"),
                  &fraction = fieldNamed("fraction_changed"), &time = fieldNamed("time"),
                  &startTime = fieldNamed("startTime"), &elapsed = fieldNamed("elapsedTime"),
                  &isPaused = fieldNamed("isPaused");
  static const FieldInfo& fieldNamed(std::string_view name) {
    return fieldOf<nodes::TimeSensor>(name);
  }
};
const SentFields& sentFields() {
  static const SentFields all;
  return all;
}

TimeFields fieldsOf(const Node& node) {
  const auto& sensor = static_cast<const nodes::TimeSensor&>(node);
  return {sensor.startTime, sensor.stopTime,  sensor.cycleInterval, sensor.loop,
          sensor.enabled,   sensor.pauseTime, sensor.resumeTime};
}

TimeDependent& machine(Events& events, Node& node) {
  return static_cast<State*>(events.state(node))->time;
}

MaySend maySend(const Events& events, const Node& node) {
  return {!events.hasSent(node, sentFields().isActive),
          !events.hasSent(node, sentFields().isPaused)};
}

// Sends the events of a step in the order of 6.50: isActive TRUE first, isActive FALSE last.
void send(Events& events, Node& node, const TimeStep& step) {
  const SentFields& out = sentFields();
  if (step.running) {
    if (step.begins) events.send(node, out.isActive, true);
    if (step.resumes) events.send(node, out.isPaused, false);
    if (step.newCycle) events.send(node, out.cycleTime, step.cycleStart);
    if (!step.alreadySent) {
      events.send(node, out.fraction, float(step.fraction));
      events.send(node, out.time, step.time);
      events.send(node, out.elapsed, step.elapsed);
    }
    if (step.pauses) events.send(node, out.isPaused, true);
    if (step.ends) events.send(node, out.isActive, false);
  }
}

std::unique_ptr<NodeState> begin(Events& events, Node& node) {
  auto state = std::make_unique<State>();
  const TimeFields fields = fieldsOf(node);
  state->time.begin(fields, events.now());
  if (state->time.wantsTicks(fields, events.now())) events.wantTicks(node, true);
  return state;
}

bool accept(Events& events, Node& node, const FieldInfo& field, const Value& value) {
  const TimeDependent& time = machine(events, node);
  if (field.name == "cycleInterval") return !time.active() && std::get<SFTime>(value) > 0;
  return time.accepts(fieldsOf(node), field, value);
}

void receive(Events& events, Node& node, const FieldInfo& in, const Value&) {
  const TimeFields fields = fieldsOf(node);
  TimeDependent& time = machine(events, node);
  send(events, node,
       time.fieldChanged(fields, events.now(), maySend(events, node),
                         &in == &sentFields().startTime));
  events.wantTicks(node, time.wantsTicks(fields, events.now()));
}

void tick(Events& events, Node& node) {
  const TimeFields fields = fieldsOf(node);
  TimeDependent& time = machine(events, node);
  send(events, node, time.tick(fields, events.now(), maySend(events, node)));
  if (!time.wantsTicks(fields, events.now())) events.wantTicks(node, false);
}

} // namespace

void addTimeSensorBehaviours(const AddBehaviour& add) {
  add(nodes::TimeSensor::nodeType(),
      {.begin = begin, .accept = accept, .receive = receive, .tick = tick});
}

} // namespace xvrml
