// followers.cpp: the 14 followers (ISO/IEC 19775-1 clause 39). A follower wants ticks only while it
// moves; what it sends depends on its events and on time, not on the number of ticks.
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "behaviour/builtin.h"
#include "behaviour/follower_filter.h"
#include "behaviour/named_fields.h"
#include "xvrml/nodes.h"

namespace xvrml {
namespace {

template <class Follower> using Element =
    ElementOf<std::remove_cvref_t<decltype(std::declval<Follower&>().initialValue)>>;

template <class Follower> constexpr bool isDamper = requires(Follower& node) { node.tau; };

// The filter of a node. A single value is a list of one.
template <class Follower> struct FilterOf { using Type = ChaserFilter<Element<Follower>>; };
template <class Follower>
requires isDamper<Follower>
struct FilterOf<Follower> {
  using Type = DamperFilter<Element<Follower>>;
};

template <class Follower> struct State : NodeState {
  typename FilterOf<Follower>::Type filter;
  bool isActive = false; // the last isActive sent
  bool warned = false;   // numbers that are not finite have been reported
};

template <class Follower> State<Follower>& stateOf(Events& events, Node& node) {
  return *static_cast<State<Follower>*>(events.state(node));
}

template <class T> std::vector<T> listOf(const T& value) { return {value}; }
template <class T> const std::vector<T>& listOf(const std::vector<T>& value) { return value; }

template <class Follower> Value valueOf(const std::vector<Element<Follower>>& list) {
  using Field = std::remove_cvref_t<decltype(std::declval<Follower&>().initialValue)>;
  if constexpr (isList<Field>)
    return list;
  else
    return list[0];
}

// Returns whether all numbers of a list are finite; reports once that they are not. A filter would
// never be rid of one that is not.
template <class Follower, class T> bool
isUsable(Events& events, const Follower& node, State<Follower>& state, const std::vector<T>& list) {
  if (allFinite(std::span<const T>(list))) return true;
  if (!std::exchange(state.warned, true))
    events.diagnostics().warn(
        node.source,
        fmt::format("{}: a value that is not finite is ignored (39.3)", node.type().name));
  return false;
}

// Sends isActive if it has changed. It can be sent once in a cascade only; a second change waits
// for the next tick.
template <class Follower> void followMovement(Events& events, Node& node, State<Follower>& state) {
  static const FieldInfo& out = fieldOf<Follower>("isActive");
  const bool isMoving = state.filter.moving();
  if (isMoving != state.isActive && !events.hasSent(node, out))
    events.send(node, out, state.isActive = isMoving);
  events.wantTicks(node, isMoving || state.isActive);
}

template <class Follower> void sendValue(Events& events, Node& node, State<Follower>& state) {
  static const FieldInfo& out = fieldOf<Follower>("value_changed");
  events.send(node, out, valueOf<Follower>(state.filter.at(events.now())));
}

template <class Follower> void tick(Events& events, Node& node) {
  State<Follower>& state = stateOf<Follower>(events, node);
  if (state.filter.moving()) sendValue<Follower>(events, node, state);
  followMovement<Follower>(events, node, state);
}

template <class Follower>
void receive(Events& events, Node& node, const FieldInfo& in, const Value& value) {
  auto& follower = static_cast<Follower&>(node);
  State<Follower>& state = stateOf<Follower>(events, node);
  if constexpr (isDamper<Follower>) {
    if (isField<"tau">(node, in)) return state.filter.setTau(follower.tau, events.now());
    if (isField<"tolerance">(node, in)) return state.filter.setTolerance(follower.tolerance);
  }
  using Field = std::remove_cvref_t<decltype(follower.initialValue)>;
  const auto& list = listOf(std::get<Field>(value));
  if (!isUsable(events, follower, state, list)) return;
  if (isField<"set_value">(node, in)) {
    state.filter.setValue(list, events.now());
    sendValue<Follower>(events, node, state);
  } else {
    const bool wasMoving = state.filter.moving();
    state.filter.setDestination(list, events.now());
    // a destination that is reached at once
    if (!state.filter.moving() && (wasMoving || !list.empty()))
      sendValue<Follower>(events, node, state);
  }
  followMovement<Follower>(events, node, state);
}

template <class Follower> std::unique_ptr<NodeState> begin(Events& events, Node& node) {
  auto& follower = static_cast<Follower&>(node);
  auto state = std::make_unique<State<Follower>>();
  if constexpr (isDamper<Follower>)
    state->filter =
        typename FilterOf<Follower>::Type(follower.order, follower.tau, double(follower.tolerance));
  else
    state->filter = typename FilterOf<Follower>::Type(follower.duration);
  const auto& from = listOf(follower.initialValue);
  const auto& to = listOf(follower.initialDestination);
  if (isUsable(events, follower, *state, from) && isUsable(events, follower, *state, to)) {
    state->filter.setDestination(to, events.now());
    if (from.size() == to.size()) state->filter.setValue(from, events.now());
  }
  static const FieldInfo& out = fieldOf<Follower>("value_changed");
  events.preset(node, out, follower.initialValue);
  if (state->filter.moving()) events.wantTicks(node, true);
  return state;
}

template <class... Followers> void addAll(const AddBehaviour& add) {
  (add(Followers::nodeType(),
       {.begin = begin<Followers>, .receive = receive<Followers>, .tick = tick<Followers>}),
   ...);
}

} // namespace

void addFollowerBehaviours(const AddBehaviour& add) {
  using namespace nodes;
  addAll<ColorChaser, CoordinateChaser, OrientationChaser, PositionChaser, PositionChaser2D,
         ScalarChaser, TexCoordChaser2D>(add);
  addAll<ColorDamper, CoordinateDamper, OrientationDamper, PositionDamper, PositionDamper2D,
         ScalarDamper, TexCoordDamper2D>(add);
}

} // namespace xvrml
