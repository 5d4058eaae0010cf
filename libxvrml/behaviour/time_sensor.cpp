// time_sensor.cpp: TimeSensor (clause 6.50, ISO/IEC 19775-1 8.4.1), based on the state machine of
// time-dependent nodes.
#include "behaviour/builtin.h"
#include "behaviour/named_fields.h"
#include "behaviour/time_dependent.h"
#include "xvrml/nodes.h"

namespace xvrml {
namespace {

struct State : NodeState {
  TimeDependent time;
};

TimeFields fieldsOf(const Node& node) {
  const auto& sensor = static_cast<const nodes::TimeSensor&>(node);
  return {sensor.startTime, sensor.stopTime,  sensor.cycleInterval, sensor.loop,
          sensor.enabled,   sensor.pauseTime, sensor.resumeTime};
}

TimeDependent& machine(Events& events, Node& node) {
  return static_cast<State*>(events.state(node))->time;
}

MaySend maySend(const Events& events, const Node& node) {
  return {!events.hasSent(node, *fieldNamed<"isActive">(node)),
          !events.hasSent(node, *fieldNamed<"isPaused">(node))};
}

// Sends the events of a step in the order of 6.50: isActive TRUE first, isActive FALSE last.
void send(Events& events, Node& node, const TimeStep& step) {
  if (!step.running) return;
  if (step.begins) sendFrom<"isActive">(events, node, true);
  if (step.resumes) sendFrom<"isPaused">(events, node, false);
  if (step.newCycle) sendFrom<"cycleTime">(events, node, step.cycleStart);
  if (!step.alreadySent) {
    sendFrom<"fraction_changed">(events, node, float(step.fraction));
    sendFrom<"time">(events, node, step.time);
    sendFrom<"elapsedTime">(events, node, step.elapsed);
  }
  if (step.pauses) sendFrom<"isPaused">(events, node, true);
  if (step.ends) sendFrom<"isActive">(events, node, false);
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
  if (isField<"cycleInterval">(node, field)) return !time.active() && std::get<SFTime>(value) > 0;
  return time.accepts(fieldsOf(node), node, field, value);
}

void receive(Events& events, Node& node, const FieldInfo& in, const Value&) {
  const TimeFields fields = fieldsOf(node);
  TimeDependent& time = machine(events, node);
  send(events, node,
       time.fieldChanged(fields, events.now(), maySend(events, node),
                         isField<"startTime">(node, in)));
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
