#include "libpicture/export/gltf/motion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <type_traits>

#include "libpicture/walk.h"
#include "xvrml/interpolation.h"

namespace picture::gltf {

using xvrml::Node;
using xvrml::nodeCast;
using xvrml::ProtoInstance;

namespace {

// A field of a node at the end of a ROUTE.
struct End {
  const Node* node;
  std::string field;
};

// Returns whether an event of an instance is the interface, or belongs to the exposedField of that
// name.
bool isOf(std::string_view event, std::string_view interface) {
  const auto cut = [&](std::string_view begin, std::string_view end) {
    return event.size() == begin.size() + interface.size() + end.size() &&
           event.starts_with(begin) && event.ends_with(end) &&
           event.substr(begin.size(), interface.size()) == interface;
  };
  return cut("", "") || cut("set_", "") || cut("", "_changed");
}

// Returns the ends within prototypes that stand for a field, which IS connects with others. A field
// that is none of a prototype's instance stands for itself.
std::vector<End> endsBelow(const Node* node, const std::string& field) {
  constexpr size_t most = 100; // steps; a hostile prototype asks for more
  std::vector<End> open = {{node, field}}, ends;
  for (size_t steps = 0; !open.empty() && steps < most; ++steps) {
    const End end = std::move(open.back());
    open.pop_back();
    const auto* instance = nodeCast<ProtoInstance>(end.node);
    if (!instance) {
      if (end.node) ends.push_back(end);
      continue;
    }
    for (const xvrml::IsConnection& is : instance->is)
      if (isOf(end.field, is.interfaceName)) open.push_back({is.node.get(), is.field});
  }
  return ends;
}

struct Link {
  const Node* from;
  const xvrml::FieldInfo* out;
  const Node* to;
  const xvrml::FieldInfo* in;
};

// Returns the ROUTEs of a world between nodes that are no instances.
std::vector<Link> linksOf(const xvrml::World& world) {
  constexpr size_t most = 1'000'000;
  std::vector<Link> links;
  const auto add = [&](const xvrml::Scope& scope) {
    if (links.size() >= most) return;
    for (const xvrml::Route& route : scope.routes)
      for (const End& from : endsBelow(route.from.get(), route.fromField))
        for (const End& to : endsBelow(route.to.get(), route.toField)) {
          const auto* out = from.node->type().findEventOut(from.field);
          const auto* in = to.node->type().findEventIn(to.field);
          if (out && in) links.push_back({from.node, out, to.node, in});
        }
  };
  walkInto(
      world.scope, [](const Node&) {}, add);
  return links;
}

// Returns the name of the field that an eventIn or exposedField sets.
std::string_view fieldSet(const Node& node, const xvrml::FieldInfo& in) {
  const xvrml::FieldInfo* field = node.type().fieldSetBy(in);
  return field ? field->name : in.name;
}

std::optional<Path> pathOf(const Link& link) {
  const bool hasMatrix =
      nodeCast<xvrml::nodes::Transform>(link.to) || nodeCast<xvrml::nodes::CADPart>(link.to);
  if (!hasMatrix) return {};
  const std::string_view field = fieldSet(*link.to, *link.in);
  const bool turns = nodeCast<xvrml::nodes::OrientationInterpolator>(link.from) ||
                     nodeCast<xvrml::nodes::SquadOrientationInterpolator>(link.from);
  if (turns) return field == "rotation" ? std::optional(Path::rotation) : std::nullopt;
  if (!nodeCast<xvrml::nodes::PositionInterpolator>(link.from) &&
      !nodeCast<xvrml::nodes::SplinePositionInterpolator>(link.from))
    return {};
  return field == "translation" ? std::optional(Path::translation)
         : field == "scale"     ? std::optional(Path::scale)
                                : std::nullopt;
}

std::array<float, 4> valueOf(const Quaternion& q) {
  return {float(q.x), float(q.y), float(q.z), float(q.w)};
}

bool isFinite(const std::array<float, 4>& value) {
  return std::all_of(value.begin(), value.end(), [](float x) { return std::isfinite(x); });
}

// Appends a key. If it is not later than the last one, it gets a time a millionth of that one
// later.
void append(Keys& keys, double time, const std::array<float, 4>& value) {
  constexpr float least = 1e-6f;
  float at = float(time);
  if (!keys.times.empty() && !(at > keys.times.back()))
    at = std::max(keys.times.back() * (1 + least), keys.times.back() + least);
  keys.times.push_back(at);
  keys.values.push_back(value);
}

struct Step {
  double fraction;
  std::array<float, 4> value;
};

// Returns what an interpolator has within a cycle, from fraction 0 to 1. A key outside of it has
// its part in the value at 0 or 1. Keys that go back, or are no numbers, are left out. valueAt(i):
// the value of a key; between(a, b, t): the value at a fraction of the way between two.
template <class ValueAt, class Between>
std::vector<Step> stepsOf(const std::vector<float>& fractions, size_t count, const ValueAt& valueAt,
                          const Between& between) {
  std::vector<Step> steps;
  std::optional<Step> last;
  for (size_t i = 0; i < count; ++i) {
    const Step now{fractions[i], valueAt(i)};
    if (!std::isfinite(now.fraction) || (last && now.fraction < last->fraction)) continue;
    const auto cutAt = [&](double fraction) {
      const double t = (fraction - last->fraction) / (now.fraction - last->fraction);
      steps.push_back({fraction, between(last->value, now.value, t)});
    };
    if (last && last->fraction < 0 && now.fraction > 0) cutAt(0);
    if (now.fraction > 1) {
      if (!last) return {{1, now.value}};
      if (last->fraction < 1) cutAt(1);
      return steps;
    }
    if (now.fraction >= 0) steps.push_back(now);
    last = now;
  }
  if (steps.empty() && last) steps.push_back({0, last->value});
  return steps;
}

// Appends steps as keys, and one for the end of the cycle.
void appendAll(Keys& keys, const std::vector<Step>& steps, double length) {
  for (const Step& step : steps) append(keys, step.fraction * length, step.value);
  if (!keys.times.empty() && keys.times.back() < float(length))
    append(keys, length, keys.values.back());
}

std::array<float, 4> betweenPositions(const std::array<float, 4>& a, const std::array<float, 4>& b,
                                      double t) {
  std::array<float, 4> value{};
  for (size_t i = 0; i < 3; ++i) value[i] = float((1 - t) * double(a[i]) + t * double(b[i]));
  return value;
}

Quaternion turnOf(const std::array<float, 4>& v) { return {v[0], v[1], v[2], v[3]}; }

std::array<float, 4> betweenTurns(const std::array<float, 4>& a, const std::array<float, 4>& b,
                                  double t) {
  return valueOf(between(turnOf(a), turnOf(b), t));
}

// The keys of an interpolator: fractions, and a value for each.
template <class T> struct Curve {
  std::vector<float> fractions;
  std::vector<T> values;
};

template <class Node> auto curveOf(const Node& node) {
  using T = std::decay_t<decltype(node.keyValue[0])>;
  const size_t count = std::min(node.key.size(), node.keyValue.size());
  return Curve<T>{{node.key.begin(), node.key.begin() + ptrdiff_t(count)},
                  {node.keyValue.begin(), node.keyValue.begin() + ptrdiff_t(count)}};
}

// Returns a curve that is not straight between its keys, with more keys.
template <class Node> auto sampledCurveOf(const Node& node) {
  constexpr int parts = 16; // between two keys
  const auto given = curveOf(node);
  auto curve = decltype(curveOf(node))();
  for (size_t i = 0; i < given.fractions.size(); ++i) {
    const float from = i > 0 ? given.fractions[i - 1] : 0, to = given.fractions[i];
    for (int k = 1; k < parts && i > 0 && from < to; ++k) {
      const float fraction = from + (to - from) * float(k) / parts;
      curve.fractions.push_back(fraction);
      curve.values.push_back(xvrml::valueAt(node, fraction).value_or(given.values[i]));
    }
    curve.fractions.push_back(to);
    curve.values.push_back(given.values[i]);
  }
  return curve;
}

void appendPlaces(Keys& keys, const Curve<xvrml::Vec3f>& curve, double length) {
  const auto valueAt = [&](size_t i) {
    const xvrml::Vec3f& v = curve.values[i];
    return std::array<float, 4>{v.x, v.y, v.z, 0};
  };
  appendAll(keys, stepsOf(curve.fractions, curve.values.size(), valueAt, betweenPositions), length);
}

// glTF turns by the shorter way, which is not certain for nearly half a circle of quaternions. Our
// interpolators go on in the same direction there (ISO/IEC 14772-1 6.32).
void appendTurns(Keys& keys, const Curve<xvrml::Rotation>& curve, double length) {
  const size_t count = curve.values.size();
  std::vector<Quaternion> turns(count);
  for (size_t i = 0; i < count; ++i) {
    turns[i] = quaternionOf(curve.values[i]);
    const double side = i > 0 ? dot(turns[i - 1], turns[i]) : 1;
    if (side < -1e-3) turns[i] = {-turns[i].x, -turns[i].y, -turns[i].z, -turns[i].w};
  }
  Keys sparse;
  const auto valueAt = [&](size_t i) { return valueOf(turns[i]); };
  appendAll(sparse, stepsOf(curve.fractions, count, valueAt, betweenTurns), length);
  for (size_t i = 0; i < sparse.times.size(); ++i) {
    constexpr double near = 0.1; // 0 is the product of quaternions at right angles
    if (i > 0 && dot(turnOf(sparse.values[i - 1]), turnOf(sparse.values[i])) < near)
      append(keys, 0.5 * (double(sparse.times[i - 1]) + double(sparse.times[i])),
             betweenTurns(sparse.values[i - 1], sparse.values[i], 0.5));
    append(keys, sparse.times[i], sparse.values[i]);
  }
}

template <class T> Elements elementsOf(const std::vector<T>& values, size_t width) {
  Elements elements;
  elements.count = values.size();
  elements.type = width == 1 ? "SCALAR" : width == 3 ? "VEC3" : "VEC4";
  const size_t bytes = width * sizeof(float);
  elements.bytes.resize(values.size() * bytes);
  for (size_t i = 0; i < values.size(); ++i)
    std::memcpy(&elements.bytes[i * bytes], &values[i], bytes);
  return elements;
}

// Writes the accessors of keys; returns the object of the sampler.
Json samplerOf(const Keys& keys, Document& document) {
  Elements times = elementsOf(keys.times, 1);
  times.minimum = {keys.times.front()};
  times.maximum = {keys.times.back()};
  const size_t input = document.add(std::move(times));
  return {{"input", input},
          {"output", document.add(elementsOf(keys.values, keys.width))},
          {"interpolation", "LINEAR"}};
}

// Returns a sum that is finite.
float sumOf(float a, double b) {
  constexpr double most = std::numeric_limits<float>::max();
  return float(std::clamp(double(a) + b, -most, most));
}

constexpr const char* pathNames[] = {"translation", "rotation", "scale"};

} // namespace

Keys keysOf(const Motion& motion) {
  Keys keys;
  const double length = motion.clock->cycleInterval;
  constexpr double longest = 1e9; // seconds; floats count no single ones beyond
  if (!(length > 0) || length > longest) return keys;
  const Node* node = motion.interpolator;
  if (motion.path == Path::rotation) keys.width = 4;
  if (const auto* turn = nodeCast<xvrml::nodes::OrientationInterpolator>(node))
    appendTurns(keys, curveOf(*turn), length);
  else if (const auto* squad = nodeCast<xvrml::nodes::SquadOrientationInterpolator>(node))
    appendTurns(keys, sampledCurveOf(*squad), length);
  else if (const auto* spline = nodeCast<xvrml::nodes::SplinePositionInterpolator>(node))
    appendPlaces(keys, sampledCurveOf(*spline), length);
  else if (const auto* place = nodeCast<xvrml::nodes::PositionInterpolator>(node))
    appendPlaces(keys, curveOf(*place), length);
  if (!std::all_of(keys.values.begin(), keys.values.end(), isFinite)) return {};
  return keys;
}

Motions::Motions(const xvrml::World& world, Remarks& remarks) {
  const std::vector<Link> links = linksOf(world);
  std::unordered_map<const Node*, const xvrml::nodes::TimeSensor*> clocks; // by interpolator
  std::unordered_set<const Link*> written;
  std::set<std::tuple<const Node*, const Node*, Path>> taken;
  for (const Link& link : links) {
    const auto* clock = nodeCast<xvrml::nodes::TimeSensor>(link.from);
    if (clock && link.out->name == "fraction_changed" && link.in->name == "set_fraction" &&
        link.to->type().is("interpolator"))
      clocks.emplace(link.to, clock);
  }
  for (const Link& link : links) {
    const auto clock = clocks.find(link.from);
    const std::optional<Path> path = pathOf(link);
    if (clock == clocks.end() || !path || link.out->name != "value_changed") continue;
    const Motion motion{clock->second, link.from, link.to, *path};
    // An animation moves a field once.
    if (!taken.emplace(motion.clock, motion.target, motion.path).second) continue;
    Keys keys = keysOf(motion);
    if (keys.times.empty()) continue;
    motions_.emplace_back(motion, std::move(keys));
    targets_.insert(link.to);
    used_.insert(link.from);
    used_.insert(clock->second);
    written.insert(&link);
  }
  for (const Link& link : links) {
    const bool drives = used_.contains(link.to) && link.in->name == "set_fraction";
    if (!written.contains(&link) && !drives)
      remarks.change("a ROUTE that is no animation of translation, rotation or scale is left out");
  }
}

void Motions::place(const Node& target, const Placed& placed) {
  places_[&target].push_back(placed);
}

// Keys that several motions share are written for each of them, because targets with a center have
// other translations.
void Motions::write(Document& document) {
  std::vector<const xvrml::nodes::TimeSensor*> order;
  std::unordered_map<const Node*, std::pair<Json, Json>> animations; // samplers, channels
  for (auto& [motion, keys] : motions_) {
    const auto places = places_.find(motion.target);
    if (places == places_.end()) continue; // not drawn
    const auto [found, fresh] = animations.try_emplace(motion.clock, Json::array(), Json::array());
    if (fresh) order.push_back(motion.clock);
    auto& [samplers, channels] = found->second;
    if (motion.path == Path::translation)
      for (auto& value : keys.values) {
        const Vec& offset = places->second.front().offset;
        value = {sumOf(value[0], offset.x), sumOf(value[1], offset.y), sumOf(value[2], offset.z),
                 0};
      }
    const size_t sampler = samplers.size();
    samplers.push_back(samplerOf(keys, document));
    for (const Placed& placed : places->second) {
      const size_t node = motion.path == Path::scale ? placed.scaleNode : placed.node;
      channels.push_back({{"sampler", sampler},
                          {"target", {{"node", node}, {"path", pathNames[int(motion.path)]}}}});
    }
  }
  for (const auto* clock : order) {
    auto& [samplers, channels] = animations.at(clock);
    Json animation = {{"samplers", std::move(samplers)}, {"channels", std::move(channels)}};
    if (!clock->defName.empty()) animation["name"] = clock->defName;
    document.add("animations", animation);
  }
}

} // namespace picture::gltf
