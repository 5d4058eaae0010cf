// event_utilities.cpp: BooleanFilter, BooleanToggle, BooleanTrigger, IntegerTrigger and TimeTrigger
// (ISO/IEC 19775-1 clause 30). Each answers an event with others, at the same time.
#include "behaviour/builtin.h"
#include "behaviour/named_fields.h"
#include "xvrml/nodes.h"

namespace xvrml {
namespace {

// 30.4.1: one of inputTrue and inputFalse, and the negation.
void filter(Events& events, Node& node, const FieldInfo&, const Value& value) {
  static const FieldInfo& whenTrue = fieldOf<nodes::BooleanFilter>("inputTrue");
  static const FieldInfo& whenFalse = fieldOf<nodes::BooleanFilter>("inputFalse");
  static const FieldInfo& negated = fieldOf<nodes::BooleanFilter>("inputNegate");
  const bool given = std::get<SFBool>(value);
  events.send(node, given ? whenTrue : whenFalse, given);
  events.send(node, negated, !given);
}

// 30.4.3: TRUE negates. A field sends once in a cascade, so that a second TRUE at the same time
// does nothing: the field never differs from what was sent.
void toggle(Events& events, Node& node, const FieldInfo& in, const Value& value) {
  static const FieldInfo& toggled = fieldOf<nodes::BooleanToggle>("toggle");
  if (!isField<"set_boolean">(node, in) || !std::get<SFBool>(value) ||
      events.hasSent(node, toggled))
    return;
  const bool next = !static_cast<nodes::BooleanToggle&>(node).toggle;
  events.store(node, toggled, next);
  events.send(node, toggled, next);
}

// 30.4.4
void triggerTrue(Events& events, Node& node, const FieldInfo&, const Value&) {
  static const FieldInfo& out = fieldOf<nodes::BooleanTrigger>("triggerTrue");
  events.send(node, out, true);
}

// 30.4.6
void triggerInteger(Events& events, Node& node, const FieldInfo& in, const Value&) {
  static const FieldInfo& out = fieldOf<nodes::IntegerTrigger>("triggerValue");
  if (isField<"set_boolean">(node, in))
    events.send(node, out, static_cast<nodes::IntegerTrigger&>(node).integerKey);
}

// 30.4.7
void triggerTime(Events& events, Node& node, const FieldInfo&, const Value&) {
  static const FieldInfo& out = fieldOf<nodes::TimeTrigger>("triggerTime");
  events.send(node, out, events.now());
}

} // namespace

void addEventUtilityBehaviours(const AddBehaviour& add) {
  add(nodes::BooleanFilter::nodeType(), {.receive = filter});
  add(nodes::BooleanToggle::nodeType(), {.receive = toggle});
  add(nodes::BooleanTrigger::nodeType(), {.receive = triggerTrue});
  add(nodes::IntegerTrigger::nodeType(), {.receive = triggerInteger});
  add(nodes::TimeTrigger::nodeType(), {.receive = triggerTime});
}

} // namespace xvrml
