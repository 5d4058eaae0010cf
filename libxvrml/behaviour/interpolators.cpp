// interpolators.cpp: the linear interpolators (ISO/IEC 14772-1 4.6.8, 6.10, 6.13, 6.31, 6.32, 6.37,
// 6.39; ISO/IEC 19775-1 19.4.3, 19.4.8): set_fraction produces value_changed.
#include <algorithm>
#include <cmath>
#include <type_traits>

#include <fmt/format.h>

#include "behaviour/blend.h"
#include "behaviour/builtin.h"
#include "behaviour/keys.h"
#include "behaviour/named_fields.h"
#include "xvrml/nodes.h"

namespace xvrml {
namespace {

struct State : NodeState {
  bool warned = false; // the mismatch of key and keyValue has been reported
};

template <class T> T between(const T* values, KeyPosition place) {
  return place.t == 0 ? values[place.left]
                      : blend(values[place.left], values[place.left + 1], place.t);
}

// Number of usable keys and of values per key; zero if there are none.
struct Shape {
  size_t keys = 0, perKey = 0;
};
template <class Interpolator> Shape shapeOf(Events& events, Interpolator& node, bool lists) {
  const size_t keys = node.key.size(), values = node.keyValue.size();
  if (keys == 0 || values == 0) return {};
  const bool fits = lists ? values % keys == 0 : values == keys;
  if (auto* state = static_cast<State*>(events.state(node)); !fits && state && !state->warned) {
    state->warned = true;
    events.diagnostics().warn(node.source,
                              fmt::format("{}: {} keys but {} values: {} (4.6.8)", node.type().name,
                                          keys, values,
                                          values > keys ? "values in excess are ignored"
                                          : lists       ? "nothing is sent"
                                                        : "keys in excess are ignored"));
  }
  if (lists) return values < keys ? Shape{} : Shape{keys, values / keys};
  return {std::min(keys, values), 1};
}

template <class Interpolator> void evaluate(Events& events, Interpolator& node, float fraction) {
  const Shape shape = shapeOf(events, node, false);
  if (shape.keys == 0) return;
  static const FieldInfo& out = fieldOf<Interpolator>("value_changed");
  events.send(node, out,
              between(node.keyValue.data(), locate(node.key.data(), shape.keys, fraction)));
}

// For interpolators of lists: perKey consecutive values for each key.
template <class Interpolator, class Blend>
void evaluateLists(Events& events, Interpolator& node, float fraction, const Blend& blendOne) {
  const Shape shape = shapeOf(events, node, true);
  if (shape.keys == 0) return;
  const KeyPosition place = locate(node.key.data(), shape.keys, fraction);
  using List = decltype(node.keyValue);
  const auto* left = node.keyValue.data() + place.left * shape.perKey;
  List result;
  if (place.t == 0) {
    result.assign(left, left + shape.perKey);
  } else {
    result.resize(shape.perKey);
    for (size_t i = 0; i < shape.perKey; ++i)
      result[i] = blendOne(left[i], left[i + shape.perKey], place.t);
  }
  static const FieldInfo& out = fieldOf<Interpolator>("value_changed");
  events.send(node, out, std::move(result));
}

void evaluate(Events& events, nodes::CoordinateInterpolator& node, float fraction) {
  evaluateLists(events, node, fraction,
                [](const Vec3f& a, const Vec3f& b, float t) { return blend(a, b, t); });
}
void evaluate(Events& events, nodes::CoordinateInterpolator2D& node, float fraction) {
  evaluateLists(events, node, fraction,
                [](const Vec2f& a, const Vec2f& b, float t) { return blend(a, b, t); });
}
void evaluate(Events& events, nodes::NormalInterpolator& node, float fraction) {
  evaluateLists(events, node, fraction, blendNormals);
}

// Sets value_changed to the first value until the node sends (4.6.8).
template <class Interpolator> void presetFirst(Events& events, Interpolator& node) {
  static const FieldInfo& out = fieldOf<Interpolator>("value_changed");
  if (node.keyValue.empty()) return;
  using List = decltype(node.keyValue);
  if constexpr (std::is_same_v<Interpolator, nodes::CoordinateInterpolator> ||
                std::is_same_v<Interpolator, nodes::CoordinateInterpolator2D> ||
                std::is_same_v<Interpolator, nodes::NormalInterpolator>) {
    const size_t perKey = node.key.empty() ? 0 : node.keyValue.size() / node.key.size();
    events.preset(node, out,
                  List(node.keyValue.begin(), node.keyValue.begin() + ptrdiff_t(perKey)));
  } else {
    events.preset(node, out, node.keyValue[0]);
  }
}

// Handles eventIns. A new key or keyValue sends nothing; only set_fraction does.
template <class Interpolator>
void receive(Events& events, Node& node, const FieldInfo& in, const Value& value) {
  auto& interpolator = static_cast<Interpolator&>(node);
  if (!isField<"set_fraction">(node, in))
    presetFirst(events, interpolator);
  else if (!std::isnan(std::get<SFFloat>(value)))
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

void addInterpolatorBehaviours(const AddBehaviour& add) {
  addOne<nodes::ColorInterpolator>(add);
  addOne<nodes::CoordinateInterpolator>(add);
  addOne<nodes::CoordinateInterpolator2D>(add);
  addOne<nodes::NormalInterpolator>(add);
  addOne<nodes::OrientationInterpolator>(add);
  addOne<nodes::PositionInterpolator>(add);
  addOne<nodes::PositionInterpolator2D>(add);
  addOne<nodes::ScalarInterpolator>(add);
}

} // namespace xvrml
