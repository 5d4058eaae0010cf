// spline_interpolators.cpp: SplinePositionInterpolator, SplinePositionInterpolator2D and
// SplineScalarInterpolator (ISO/IEC 19775-1 19.2.4, 19.4.10 to 19.4.12).
#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "behaviour/builtin.h"
#include "behaviour/keys.h"
#include "behaviour/named_fields.h"
#include "behaviour/spline.h"
#include "xvrml/interpolation.h"
#include "xvrml/nodes.h"

namespace xvrml {
namespace {

struct State : NodeState {
  bool warned = false; // numbers of values that do not fit have been reported
};

// Reports once that the lists do not fit together.
template <class Interpolator> void check(Events& events, const Interpolator& node, State& state) {
  const size_t keys = node.key.size(), values = node.keyValue.size(),
               velocities = node.keyVelocity.size();
  const bool velocitiesFit = velocities == 0 || velocities == keys || velocities == 2;
  if ((keys == values && velocitiesFit) || state.warned) return;
  state.warned = true;
  events.diagnostics().warn(
      node.source,
      fmt::format("{}: {} keys, {} values and {} velocities: expected as many values as keys, and "
                  "as many velocities, 2 or none; {} (19.4.10)",
                  node.type().name, keys, values, velocities,
                  keys != values ? "what is in excess is ignored" : "velocities are ignored"));
}

template <class Interpolator> auto splineAt(const Interpolator& node, float fraction) {
  using T = ElementOf<decltype(node.keyValue)>;
  const size_t count = std::min(node.key.size(), node.keyValue.size());
  if (count == 0 || std::isnan(fraction)) return std::optional<T>();
  const KeyPosition place = locate(node.key.data(), count, fraction);
  if (place.t == 0) return std::optional<T>(node.keyValue[place.left]);
  const Spline<T> spline{std::span(node.key).first(count), std::span(node.keyValue).first(count),
                         node.keyVelocity, node.closed, node.normalizeVelocity};
  return std::optional<T>(spline.at(place.left, double(place.t)));
}

template <class Interpolator> void evaluate(Events& events, Interpolator& node, float fraction) {
  static const FieldInfo& out = fieldOf<Interpolator>("value_changed");
  const auto value = splineAt(node, fraction);
  if (!value) return;
  check(events, node, *static_cast<State*>(events.state(node)));
  events.send(node, out, *value);
}

// As with the linear interpolators, value_changed reads as the first value before it first sends.
template <class Interpolator> void presetFirst(Events& events, Interpolator& node) {
  static const FieldInfo& out = fieldOf<Interpolator>("value_changed");
  if (!node.keyValue.empty()) events.preset(node, out, node.keyValue[0]);
}

template <class Interpolator>
void receive(Events& events, Node& node, const FieldInfo& in, const Value& value) {
  auto& interpolator = static_cast<Interpolator&>(node);
  if (!isField<"set_fraction">(node, in))
    presetFirst(events, interpolator);
  else
    evaluate(events, interpolator, std::get<SFFloat>(value));
}

template <class Interpolator> std::unique_ptr<NodeState> begin(Events& events, Node& node) {
  presetFirst(events, static_cast<Interpolator&>(node));
  return std::make_unique<State>();
}

template <class Interpolator> void addOne(const AddBehaviour& add) {
  add(Interpolator::nodeType(), {.begin = begin<Interpolator>, .receive = receive<Interpolator>});
}

} // namespace

std::optional<Vec3f> valueAt(const nodes::SplinePositionInterpolator& node, float fraction) {
  return splineAt(node, fraction);
}

void addSplineInterpolatorBehaviours(const AddBehaviour& add) {
  addOne<nodes::SplinePositionInterpolator>(add);
  addOne<nodes::SplinePositionInterpolator2D>(add);
  addOne<nodes::SplineScalarInterpolator>(add);
}

} // namespace xvrml
