// animations.cpp: animations (glTF 2.0, 3.11) as one TimeSensor each, with an interpolator and two
// routes for each channel. The first animation runs from the start and repeats; the others wait,
// disabled.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "parse/mesh/gltf/scene.h"

namespace xvrml::gltf {
namespace {

// Keys that stand for one curve between two keys of a cubic spline.
constexpr size_t curvePieces = 8;

struct Curve {
  MFFloat times;    // seconds
  size_t width = 0; // numbers of one key
  MFFloat values;   // times.size() * width
};

struct Kind {
  std::string_view path, node, field;
  size_t width; // 0: weights
};
constexpr Kind kinds[] = {{"translation", "PositionInterpolator", "translation", 3},
                          {"scale", "PositionInterpolator", "scale", 3},
                          {"rotation", "OrientationInterpolator", "rotation", 4},
                          {"weights", "CoordinateInterpolator", "point", 0}};

// Appends a key of a cubic spline between two keys (glTF 2.0, appendix C.4). Each key holds an in
// tangent, a value and an out tangent.
void addCubic(const float* from, const float* to, size_t width, float span, float t,
              MFFloat& values) {
  const float t2 = t * t, t3 = t2 * t;
  for (size_t i = 0; i < width; ++i) {
    const float out = span * from[2 * width + i], in = span * to[i];
    values.push_back((2 * t3 - 3 * t2 + 1) * from[width + i] + (t3 - 2 * t2 + t) * out +
                     (3 * t2 - 2 * t3) * to[width + i] + (t3 - t2) * in);
  }
}

Curve sampleCubic(const Curve& keys, size_t width) {
  Curve curve;
  curve.width = width;
  const size_t count = keys.times.size();
  for (size_t k = 0; k < count; ++k) {
    const float* key = &keys.values[k * 3 * width];
    const size_t pieces = k + 1 < count ? curvePieces : 1;
    const float span = k + 1 < count ? keys.times[k + 1] - keys.times[k] : 0;
    for (size_t i = 0; i < pieces; ++i) {
      const float t = float(i) / float(curvePieces);
      curve.times.push_back(keys.times[k] + t * span);
      addCubic(key, pieces > 1 ? key + 3 * width : key, width, span, t, curve.values);
    }
  }
  return curve;
}

// Each value holds until the next key.
Curve sampleSteps(const Curve& keys) {
  Curve curve;
  curve.width = keys.width;
  for (size_t k = 0; k < keys.times.size(); ++k) {
    const auto value = keys.values.begin() + ptrdiff_t(k * keys.width);
    if (k > 0) {
      curve.times.push_back(keys.times[k]);
      curve.values.insert(curve.values.end(), value - ptrdiff_t(keys.width), value);
    }
    curve.times.push_back(keys.times[k]);
    curve.values.insert(curve.values.end(), value, value + ptrdiff_t(keys.width));
  }
  return curve;
}

class Animations {
 public:
  Animations(const MeshFile& file, NodeStream& out, const Item& root, Accessors& accessors,
             const Scene& scene)
      : file_(file), out_(out), accessors_(accessors), scene_(scene), scratch_(file.budget),
        animations_(root.list("animations")) {}

  void write() {
    for (size_t i = 0; i < animations_.size(); ++i)
      if (animations_[i]) writeAnimation(animations_[i], i == 0);
  }

 private:
  struct Channel {
    const Kind* kind;
    size_t node;
    Curve curve;
  };

  void writeAnimation(const Item& animation, bool runs) {
    std::vector<Channel> channels;
    const std::vector<Item> samplers = animation.list("samplers");
    float length = 0;
    for (const Item& item : animation.list("channels")) {
      Channel channel;
      if (!readChannel(item, samplers, channel)) continue;
      length = std::max(length, channel.curve.times.back());
      channels.push_back(std::move(channel));
    }
    if (channels.empty()) return;
    if (!(length > 0)) length = 1; // one pose
    const std::string_view clock = out_.define(animation.text("name"), "Animation");
    out_.open("TimeSensor", clock);
    out_.set("cycleInterval", double(length));
    out_.set(runs ? "loop" : "enabled", runs);
    out_.close();
    for (Channel& channel : channels) writeChannel(clock, length, channel);
  }

  bool readChannel(const Item& item, const std::vector<Item>& samplers, Channel& channel) {
    const Item target = item.object("target");
    const std::string path = target.text("path");
    const auto kind = std::find_if(std::begin(kinds), std::end(kinds),
                                   [&](const Kind& one) { return one.path == path; });
    const auto node = target.index("node", scene_.size());
    const auto sampler = item.index("sampler", samplers.size());
    if (kind == std::end(kinds))
      item.warn(fmt::format("an animation of {} is left out", describe(Name{path})));
    if (kind == std::end(kinds) || !node || !sampler || scene_.defOf(*node).empty()) return false;
    channel.kind = kind;
    channel.node = *node;
    size_t width = kind->width;
    if (width == 0) {
      const auto* morphs = scene_.morphsOf(*node);
      if (!morphs || morphs->empty()) return false;
      width = morphs->front().targets.size();
    }
    return width > 0 && readCurve(samplers[*sampler], width, channel.curve);
  }

  // Reads the keys of a sampler. Times must increase.
  bool readCurve(const Item& sampler, size_t width, Curve& curve) {
    const auto input = sampler.index("input", accessors_.size());
    const auto output = sampler.index("output", accessors_.size());
    if (!input || !output) return false;
    Values times = accessors_.read(*input), values = accessors_.read(*output);
    if (times.components == 0 || values.components == 0) return false;
    const std::string how = sampler.text("interpolation");
    const bool cubic = how == "CUBICSPLINE";
    const size_t count = times.size();
    if (times.components != 1 || count == 0 ||
        values.numbers.size() != count * width * (cubic ? 3 : 1)) {
      sampler.error(fmt::format("{} numbers do not fit to {} keys; the animation is left out",
                                values.numbers.size(), count));
      return false;
    }
    const bool finite = std::all_of(times.numbers.begin(), times.numbers.end(),
                                    [](float t) { return std::isfinite(t) && t >= 0; });
    if (!finite || !std::is_sorted(times.numbers.begin(), times.numbers.end())) {
      sampler.error("the times of keys must increase from 0; the animation is left out");
      return false;
    }
    scratch_.take((times.numbers.size() + values.numbers.size()) * sizeof(float) *
                  (cubic ? curvePieces : 2));
    curve.times = std::move(times.numbers);
    curve.values = std::move(values.numbers);
    curve.width = width * (cubic ? 3 : 1);
    if (cubic)
      curve = sampleCubic(curve, width);
    else if (how == "STEP")
      curve = sampleSteps(curve);
    return true;
  }

  void writeChannel(std::string_view clock, float length, Channel& channel) {
    MFFloat keys = channel.curve.times;
    for (float& key : keys) key = std::min(key / length, 1.0f);
    if (channel.kind->width == 0) return writeMorphs(clock, keys, channel);
    out_.open(channel.kind->node, interpolator_ = out_.define(channel.kind->path, {}));
    out_.set("key", std::move(keys));
    if (channel.kind->width == 4)
      writeRotations(channel.curve);
    else
      writeVectors(channel.curve);
    out_.close();
    out_.route(clock, "fraction_changed", interpolator_, "set_fraction");
    out_.route(interpolator_, "value_changed", scene_.defOf(channel.node), channel.kind->field);
  }

  void writeVectors(const Curve& curve) {
    MFVec3f values;
    values.reserve(curve.times.size());
    for (size_t i = 0; i + 2 < curve.values.size(); i += 3)
      values.push_back({curve.values[i], curve.values[i + 1], curve.values[i + 2]});
    out_.set("keyValue", std::move(values));
  }

  void writeRotations(const Curve& curve) {
    MFRotation values;
    values.reserve(curve.times.size());
    for (size_t i = 0; i + 3 < curve.values.size(); i += 4)
      values.push_back(rotationOf(curve.values[i], curve.values[i + 1], curve.values[i + 2],
                                  curve.values[i + 3]));
    out_.set("keyValue", std::move(values));
  }

  // The positions of each key: the mesh moved by the key's weights.
  void writeMorphs(std::string_view clock, const MFFloat& keys, const Channel& channel) {
    for (const Primitives::Morph& morph : *scene_.morphsOf(channel.node)) {
      if (morph.coordinate.empty() || morph.targets.size() != channel.curve.width) continue;
      const uint64_t total = uint64_t(keys.size()) * morph.base.size();
      if (total > file_.options.limits.arrayElements / 3) {
        file_.locator.error(nullptr, fmt::format("an animation of {} positions: more numbers than "
                                                 "limit arrayElements={}",
                                                 total, file_.options.limits.arrayElements));
        continue;
      }
      Scratch memory(file_.budget);
      memory.take(total * sizeof(Vec3f));
      out_.open("CoordinateInterpolator", interpolator_ = out_.define("weights", {}));
      out_.set("key", MFFloat(keys));
      out_.set("keyValue", morphPositions(morph, channel.curve));
      out_.close();
      out_.route(clock, "fraction_changed", interpolator_, "set_fraction");
      out_.route(interpolator_, "value_changed", morph.coordinate, "point");
    }
  }

  static MFVec3f morphPositions(const Primitives::Morph& morph, const Curve& curve) {
    MFVec3f values;
    values.reserve(curve.times.size() * morph.base.size());
    for (size_t k = 0; k < curve.times.size(); ++k) {
      for (size_t v = 0; v < morph.base.size(); ++v) {
        Vec3f p = morph.base[v];
        for (size_t t = 0; t < morph.targets.size(); ++t) {
          if (v >= morph.targets[t].size()) continue;
          const float w = curve.values[k * curve.width + t];
          const Vec3f& move = morph.targets[t][v];
          p = {p.x + w * move.x, p.y + w * move.y, p.z + w * move.z};
        }
        values.push_back(p);
      }
    }
    return values;
  }

  const MeshFile& file_;
  NodeStream& out_;
  Accessors& accessors_;
  const Scene& scene_;
  Scratch scratch_;
  const std::vector<Item> animations_;
  std::string_view interpolator_;
};

} // namespace

void writeAnimations(const MeshFile& file, NodeStream& out, const Item& root, Accessors& accessors,
                     const Scene& scene) {
  Animations(file, out, root, accessors, scene).write();
}

} // namespace xvrml::gltf
