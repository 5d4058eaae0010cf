// motion.cpp: HAnimMotion and the HAnimHumanoid whose joints it moves (ISO/IEC 19775-1:2023 26.3.2,
// 26.3.4). A motion knows the time and its frame; the figure looks at its motions after the events
// of a tick, and gives its joints their values as events.
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "behaviour/builtin.h"
#include "behaviour/figures/motion_frames.h"
#include "behaviour/figures/playback.h"
#include "behaviour/named_fields.h"
#include "geometry/figure.h"
#include "xvrml/nodes.h"

namespace xvrml {
namespace {

// The state of an HAnimMotion.
struct MotionState : NodeState {
  MotionFrames frames;
  int64_t frame = 0;    // that the joints have
  uint64_t version = 0; // grows with each frame that joints shall have; 0: none yet
  bool playing = false;
  double began = 0;             // time at which the playback began
  int64_t from = 0;             // its first frame
  std::optional<int64_t> cycle; // the last one that was told
};

MotionState& stateOf(Events& events, Node& node) {
  return static_cast<MotionState&>(*events.state(node));
}

int64_t frameCount(const nodes::HAnimMotion& motion, const MotionState& state) {
  return state.frames.width > 0 ? int64_t(motion.values.size() / state.frames.width) : 0;
}

PlayedFrames playedFrames(const nodes::HAnimMotion& motion, const MotionState& state) {
  const int64_t last = std::max<int64_t>(0, frameCount(motion, state) - 1);
  const int64_t a = std::clamp<int64_t>(motion.startFrame, 0, last),
                b = motion.endFrame > 0 ? std::min<int64_t>(motion.endFrame, last) : last;
  return {std::min(a, b), std::max(a, b), motion.frameIncrement, motion.frameDuration, motion.loop};
}

// Lets the figure take a frame, and tells it.
void setFrame(Events& events, nodes::HAnimMotion& motion, MotionState& state, int64_t frame) {
  state.frame = frame;
  ++state.version;
  if (motion.frameIndex == frame) return;
  events.store(motion, *fieldNamed<"frameIndex">(motion), SFInt32(frame));
  sendFrom<"frameIndex">(events, motion, SFInt32(frame));
}

// Goes on from the present frame, if time plays frames.
void play(Events& events, nodes::HAnimMotion& motion, MotionState& state) {
  state.playing = motion.enabled && frameCount(motion, state) > 0 && motion.frameIncrement != 0 &&
                  motion.frameDuration > 0 && std::isfinite(motion.frameDuration);
  state.began = events.now();
  state.cycle.reset();
  const PlayedFrames played = playedFrames(motion, state);
  state.from = std::clamp(state.frame, played.first, played.last);
  events.wantTicks(motion, state.playing);
  if (!state.playing) return;
  if (state.from != state.frame) setFrame(events, motion, state, state.from);
}

// Begins at the present frame; at the other end, if no frame follows it.
void start(Events& events, nodes::HAnimMotion& motion, MotionState& state) {
  const PlayedFrames played = playedFrames(motion, state);
  const bool forwards = motion.frameIncrement > 0;
  if (state.frame >= played.last && forwards) state.frame = played.first;
  if (state.frame <= played.first && !forwards) state.frame = played.last;
  if (motion.enabled) setFrame(events, motion, state, state.frame);
  play(events, motion, state);
}

void readFrames(Events& events, nodes::HAnimMotion& motion, MotionState& state) {
  Faults faults;
  state.frames = motionFrames(motion.channels, motion.joints, faults);
  const size_t width = state.frames.width;
  if (width > 0 && motion.values.size() % width != 0)
    faults.note(fmt::format("values has {} numbers, which are no whole frames of {}; the rest is "
                            "ignored",
                            motion.values.size(), width));
  faults.report(motion, &events.diagnostics(), "");
}

std::unique_ptr<NodeState> beginMotion(Events& events, Node& node) {
  auto& motion = static_cast<nodes::HAnimMotion&>(node);
  auto state = std::make_unique<MotionState>();
  readFrames(events, motion, *state);
  const int64_t count = frameCount(motion, *state);
  state->frame = std::clamp<int64_t>(motion.frameIndex, 0, std::max<int64_t>(0, count - 1));
  events.preset(node, *fieldNamed<"frameCount">(node), SFInt32(count));
  start(events, motion, *state);
  return state;
}

void tickMotion(Events& events, Node& node) {
  auto& motion = static_cast<nodes::HAnimMotion&>(node);
  MotionState& state = stateOf(events, node);
  if (!state.playing) return;
  const PlayedFrame now =
      playedFrame(playedFrames(motion, state), state.from, events.now() - state.began);
  if (now.cycle != state.cycle) sendFrom<"cycleTime">(events, node, state.began + now.cycleBegan);
  state.cycle = now.cycle;
  if (now.frame != state.frame) setFrame(events, motion, state, now.frame);
  sendFrom<"elapsedTime">(events, node, now.elapsed);
  state.playing = !now.ended;
  if (now.ended) events.wantTicks(node, false);
}

// Goes one frame on or back, also where time does not.
void stepBy(Events& events, nodes::HAnimMotion& motion, MotionState& state, int64_t frames) {
  const PlayedFrames played = playedFrames(motion, state);
  int64_t next = state.frame + frames;
  if (next < played.first || next > played.last) {
    if (!motion.loop) return;
    next = next > played.last ? played.first : played.last;
  }
  setFrame(events, motion, state, next);
  play(events, motion, state);
}

void receiveMotion(Events& events, Node& node, const FieldInfo& in, const Value& value) {
  auto& motion = static_cast<nodes::HAnimMotion&>(node);
  MotionState& state = stateOf(events, node);
  if (isField<"next">(node, in) || isField<"previous">(node, in)) {
    const int64_t step =
        isField<"next">(node, in) ? motion.frameIncrement : -int64_t(motion.frameIncrement);
    if (std::get<SFBool>(value)) stepBy(events, motion, state, step);
    return;
  }
  const bool isNew =
      isField<"channels">(node, in) || isField<"joints">(node, in) || isField<"values">(node, in);
  if (isNew) {
    readFrames(events, motion, state);
    sendFrom<"frameCount">(events, node, SFInt32(frameCount(motion, state)));
  }
  const int64_t last = std::max<int64_t>(0, frameCount(motion, state) - 1);
  const int64_t wanted = isField<"frameIndex">(node, in) ? motion.frameIndex : state.frame;
  state.frame = std::clamp<int64_t>(wanted, 0, last);
  if (isField<"enabled">(node, in)) return start(events, motion, state);
  const bool shows =
      isNew || isField<"frameIndex">(node, in) || isField<"channelsEnabled">(node, in);
  if (shows) ++state.version;
  const bool plays = isField<"startFrame">(node, in) || isField<"endFrame">(node, in) ||
                     isField<"frameIncrement">(node, in) || isField<"loop">(node, in) ||
                     isField<"frameDuration">(node, in);
  if (shows || plays) play(events, motion, state);
}

// The state of an HAnimHumanoid: the versions of its motions that its joints have.
struct FigureState : NodeState {
  std::unordered_map<const Node*, uint64_t> shown;
  bool warned = false;
};

// The joints of a figure by name, and the poses that motions give them.
class Poses {
 public:
  explicit Poses(const nodes::HAnimHumanoid& figure) {
    for (nodes::HAnimJoint* joint : jointsOfSkeleton(figure)) byName_.emplace(joint->name, joint);
  }
  // Adds the present frame of a motion. Returns the first of its joints that the figure lacks, or
  // an empty name.
  std::string_view add(const nodes::HAnimMotion& motion, const MotionState& state) {
    std::string_view missing;
    const size_t width = state.frames.width;
    const size_t begin = size_t(state.frame) * width;
    if (width == 0 || begin + width > motion.values.size()) return missing;
    const std::span<const float> frame(motion.values.data() + begin, width);
    for (const MotionTrack& track : state.frames.tracks) {
      if (track.joint.empty()) continue;
      nodes::HAnimJoint* joint = find(track.joint);
      if (!joint) {
        if (missing.empty()) missing = track.joint;
        continue;
      }
      const JointPose pose = poseOf(track, frame, motion.channelsEnabled, *joint);
      JointPose& all = poseFor(joint);
      if (pose.rotation) all.rotation = pose.rotation;
      if (pose.translation) all.translation = pose.translation;
      if (pose.scale) all.scale = pose.scale;
    }
    return missing;
  }
  // Sends the joints the values that they do not have yet.
  void post(Events& events) const {
    for (const auto& [joint, pose] : poses_) {
      if (pose.rotation && !(*pose.rotation == joint->rotation))
        events.post(*joint, *fieldNamed<"rotation">(*joint), *pose.rotation);
      if (pose.translation && !(*pose.translation == joint->translation))
        events.post(*joint, *fieldNamed<"translation">(*joint), *pose.translation);
      if (pose.scale && !(*pose.scale == joint->scale))
        events.post(*joint, *fieldNamed<"scale">(*joint), *pose.scale);
    }
  }

 private:
  // The root has two names: that of H-Anim, and one of its first version.
  nodes::HAnimJoint* find(const std::string& name) const {
    auto found = byName_.find(name);
    if (found == byName_.end() && (name == "HumanoidRoot" || name == "humanoid_root"))
      found = byName_.find(name == "HumanoidRoot" ? "humanoid_root" : "HumanoidRoot");
    return found == byName_.end() ? nullptr : found->second;
  }
  JointPose& poseFor(nodes::HAnimJoint* joint) {
    const auto [place, fresh] = placeOf_.try_emplace(joint, poses_.size());
    if (fresh) poses_.push_back({joint, {}});
    return poses_[place->second].second;
  }
  std::unordered_map<std::string, nodes::HAnimJoint*> byName_;
  std::unordered_map<const Node*, size_t> placeOf_;
  std::vector<std::pair<nodes::HAnimJoint*, JointPose>> poses_; // in the order of the motions
};

// Returns the motions that move the joints, with the states that they have.
std::vector<std::pair<nodes::HAnimMotion*, MotionState*>>
motionsOf(Events& events, const nodes::HAnimHumanoid& figure) {
  std::vector<std::pair<nodes::HAnimMotion*, MotionState*>> motions;
  for (size_t i = 0; i < figure.motions.size(); ++i) {
    if (i < figure.motionsEnabled.size() && !figure.motionsEnabled[i]) continue;
    auto* const motion = nodeCast<nodes::HAnimMotion>(renderedNode(figure.motions[i].get()));
    if (!motion) continue;
    if (auto* const state = static_cast<MotionState*>(events.state(*motion)))
      motions.emplace_back(motion, state);
  }
  return motions;
}

void lookFigure(Events& events, Node& node) {
  auto& figure = static_cast<nodes::HAnimHumanoid&>(node);
  auto& state = static_cast<FigureState&>(*events.state(node));
  const auto motions = motionsOf(events, figure);
  const auto isNew = [&state](const auto& one) {
    const auto shown = state.shown.find(one.first);
    return one.second->version != (shown == state.shown.end() ? 0 : shown->second);
  };
  if (std::none_of(motions.begin(), motions.end(), isNew)) return;
  Poses poses(figure);
  for (const auto& one : motions) {
    if (!isNew(one)) continue;
    const std::string_view missing = poses.add(*one.first, *one.second);
    state.shown[one.first] = one.second->version;
    if (missing.empty() || std::exchange(state.warned, true)) continue;
    events.diagnostics().warn(
        one.first->source,
        fmt::format("HAnimMotion: the skeleton has no joint {}; the numbers of such joints are "
                    "ignored",
                    missing.substr(0, 80)));
  }
  poses.post(events);
}

std::unique_ptr<NodeState> beginFigure(Events& events, Node& node) {
  events.wantLooks(node, !static_cast<nodes::HAnimHumanoid&>(node).motions.empty());
  return std::make_unique<FigureState>();
}

void receiveFigure(Events& events, Node& node, const FieldInfo& in, const Value&) {
  if (!isField<"motions">(node, in) && !isField<"motionsEnabled">(node, in)) return;
  static_cast<FigureState&>(*events.state(node)).shown.clear();
  events.wantLooks(node, !static_cast<nodes::HAnimHumanoid&>(node).motions.empty());
}

} // namespace

void addMotionBehaviours(const AddBehaviour& add) {
  add(nodes::HAnimMotion::nodeType(),
      {.begin = beginMotion, .receive = receiveMotion, .tick = tickMotion});
  add(nodes::HAnimHumanoid::nodeType(),
      {.begin = beginFigure, .receive = receiveFigure, .look = lookFigure});
}

} // namespace xvrml
