// squad_interpolator.cpp: SquadOrientationInterpolator (ISO/IEC 19775-1 19.4.13).
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "behaviour/builtin.h"
#include "behaviour/keys.h"
#include "behaviour/named_fields.h"
#include "behaviour/squad.h"
#include "xvrml/interpolation.h"
#include "xvrml/nodes.h"

namespace xvrml {
namespace {

using Interpolator = nodes::SquadOrientationInterpolator;

struct State : NodeState {
  bool warned = false; // the mismatch of key and keyValue has been reported
};

void presetFirst(Events& events, Interpolator& node) {
  static const FieldInfo& out = fieldOf<Interpolator>("value_changed");
  if (!node.keyValue.empty()) events.preset(node, out, node.keyValue[0]);
}

void evaluate(Events& events, Interpolator& node, float fraction) {
  static const FieldInfo& out = fieldOf<Interpolator>("value_changed");
  const std::optional<Rotation> value = valueAt(node, fraction);
  if (!value) return;
  if (auto* state = static_cast<State*>(events.state(node));
      node.key.size() != node.keyValue.size() && !std::exchange(state->warned, true))
    events.diagnostics().warn(
        node.source, fmt::format("SquadOrientationInterpolator: {} keys but {} values: what is in "
                                 "excess is ignored (19.4.13)",
                                 node.key.size(), node.keyValue.size()));
  events.send(node, out, *value);
}

void receive(Events& events, Node& node, const FieldInfo& in, const Value& value) {
  auto& interpolator = static_cast<Interpolator&>(node);
  if (!isField<"set_fraction">(node, in))
    presetFirst(events, interpolator);
  else
    evaluate(events, interpolator, std::get<SFFloat>(value));
}

std::unique_ptr<NodeState> begin(Events& events, Node& node) {
  presetFirst(events, static_cast<Interpolator&>(node));
  return std::make_unique<State>();
}

} // namespace

std::optional<Rotation> valueAt(const Interpolator& node, float fraction) {
  const size_t count = std::min(node.key.size(), node.keyValue.size());
  if (count == 0 || std::isnan(fraction)) return {};
  const KeyPosition place = locate(node.key.data(), count, fraction);
  return place.t == 0 ? node.keyValue[place.left]
                      : squad(std::span(node.keyValue).first(count), place.left, place.t);
}

void addSquadInterpolatorBehaviours(const AddBehaviour& add) {
  add(Interpolator::nodeType(), {.begin = begin, .receive = receive});
}

} // namespace xvrml
