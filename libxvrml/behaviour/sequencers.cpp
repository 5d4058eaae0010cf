// sequencers.cpp: BooleanSequencer and IntegerSequencer (ISO/IEC 19775-1 30.3.1, 30.4.2, 30.4.5).
// set_fraction chooses a value, next and previous step through the list.
#include <algorithm>
#include <cmath>

#include "behaviour/builtin.h"
#include "behaviour/keys.h"
#include "behaviour/named_fields.h"
#include "xvrml/nodes.h"
#include "xvrml/numbers.h"

namespace xvrml {
namespace {

constexpr size_t none = ~size_t(0);

struct State : NodeState {
  size_t index = none; // the last value sent
};

// Returns how many values have a key. Keys or values in excess are ignored.
template <class Sequencer> size_t usable(const Sequencer& node) {
  return std::min(node.key.size(), node.keyValue.size());
}

template <class Sequencer> void sendValue(Events& events, Sequencer& node, size_t index) {
  static const FieldInfo& out = fieldOf<Sequencer>("value_changed");
  static_cast<State*>(events.state(node))->index = index;
  events.send(node, out, ElementOf<decltype(node.keyValue)>(node.keyValue[index]));
}

// A fraction sends only when it reaches another key than the fraction or step before.
template <class Sequencer>
void receive(Events& events, Node& node, const FieldInfo& in, const Value& value) {
  auto& sequencer = static_cast<Sequencer&>(node);
  size_t& index = static_cast<State*>(events.state(node))->index;
  const size_t count = usable(sequencer);
  if (isField<"key">(node, in) || isField<"keyValue">(node, in)) {
    index = none;
  } else if (count == 0) {
    return;
  } else if (isField<"set_fraction">(node, in)) {
    const float fraction = std::get<SFFloat>(value);
    if (std::isnan(fraction)) return;
    const size_t chosen = locate(sequencer.key.data(), count, fraction).left;
    if (chosen != index) sendValue(events, sequencer, chosen);
  } else if (std::get<SFBool>(value)) { // next or previous
    const size_t last = count - 1;
    if (isField<"next">(node, in))
      sendValue(events, sequencer, index == none || index >= last ? 0 : index + 1);
    else
      sendValue(events, sequencer, index == none || index == 0 ? last : std::min(index - 1, last));
  }
}

std::unique_ptr<NodeState> begin(Events&, Node&) { return std::make_unique<State>(); }

} // namespace

void addSequencerBehaviours(const AddBehaviour& add) {
  add(nodes::BooleanSequencer::nodeType(),
      {.begin = begin, .receive = receive<nodes::BooleanSequencer>});
  add(nodes::IntegerSequencer::nodeType(),
      {.begin = begin, .receive = receive<nodes::IntegerSequencer>});
}

} // namespace xvrml
