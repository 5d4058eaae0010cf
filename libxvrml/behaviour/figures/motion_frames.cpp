// motion_frames.cpp: angles are in degrees. The first rotation of a joint acts last, as if each
// were that of a joint within the one before.
#include "behaviour/figures/motion_frames.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "behaviour/quaternion.h"

namespace xvrml {
namespace {

// Returns the words of a text. Blanks and commas stand between them.
std::vector<std::string_view> wordsOf(std::string_view text) {
  std::vector<std::string_view> words;
  const auto isBetween = [](char c) { return static_cast<unsigned char>(c) <= ' ' || c == ','; };
  for (size_t begin = 0; begin < text.size();) {
    if (isBetween(text[begin])) {
      ++begin;
      continue;
    }
    size_t end = begin;
    while (end < text.size() && !isBetween(text[end])) ++end;
    words.push_back(text.substr(begin, end - begin));
    begin = end;
  }
  return words;
}

bool isNumber(std::string_view word) {
  return std::all_of(word.begin(), word.end(), [](char c) { return c >= '0' && c <= '9'; });
}

// Returns the channel of a name such as Xposition.
MotionChannel channelOf(std::string_view name) {
  using Kind = MotionChannel::Kind;
  if (name.empty() || name[0] < 'X' || name[0] > 'Z') return {};
  const std::string_view kind = name.substr(1);
  return {kind == "position"   ? Kind::position
          : kind == "rotation" ? Kind::rotation
          : kind == "scale"    ? Kind::scale
                               : Kind::unknown,
          uint8_t(name[0] - 'X')};
}

// Collects what is wrong with the channels.
struct ChannelFaults {
  size_t unknown = 0, miscounted = 0;
  std::string_view first; // unknown name

  void note(std::string_view name) {
    if (unknown++ == 0) first = name;
  }
  void report(Faults& faults) const {
    if (unknown > 0)
      faults.note(fmt::format("{} channels are unknown, such as {}; expected Xposition, Xrotation "
                              "or Xscale, or those of y and z",
                              unknown, first.substr(0, 40)));
    if (miscounted > 0)
      faults.note(fmt::format("{} joints have another number of channels than the number before "
                              "these says; the names count",
                              miscounted));
  }
};

void nameTracks(MotionFrames& frames, std::string_view joints, Faults& faults) {
  const std::vector<std::string_view> names = wordsOf(joints);
  for (size_t i = 0; i < std::min(names.size(), frames.tracks.size()); ++i)
    if (names[i] != "IGNORED") frames.tracks[i].joint = names[i];
  if (names.size() != frames.tracks.size())
    faults.note(fmt::format("joints names {} joints, and channels are those of {}", names.size(),
                            frames.tracks.size()));
}

} // namespace

MotionFrames motionFrames(std::string_view channels, std::string_view joints, Faults& faults) {
  MotionFrames frames;
  ChannelFaults wrong;
  size_t said = 0; // number of channels that the present joint should have
  const auto finish = [&] {
    if (!frames.tracks.empty() && frames.tracks.back().channels.size() != said) ++wrong.miscounted;
  };
  for (const std::string_view word : wordsOf(channels)) {
    if (isNumber(word)) {
      finish();
      said = 0;
      for (const char c : word) said = std::min<size_t>(10 * said + size_t(c - '0'), 1'000'000);
      frames.tracks.push_back({{}, frames.width, {}});
      continue;
    }
    if (frames.tracks.empty()) frames.tracks.push_back({});
    const MotionChannel channel = channelOf(word);
    if (channel.kind == MotionChannel::Kind::unknown) wrong.note(word);
    frames.tracks.back().channels.push_back(channel);
    ++frames.width;
  }
  finish();
  wrong.report(faults);
  nameTracks(frames, joints, faults);
  return frames;
}

JointPose poseOf(const MotionTrack& track, std::span<const float> frame, const MFBool& enabled,
                 const nodes::HAnimJoint& now) {
  using Kind = MotionChannel::Kind;
  Vec3f translation = now.translation, scale = now.scale;
  Quaternion rotation;
  bool moves = false, turns = false, scales = false;
  for (size_t i = 0; i < track.channels.size(); ++i) {
    const size_t at = track.first + i;
    if (at >= frame.size() || (at < enabled.size() && !enabled[at])) continue;
    const float value = frame[at];
    if (!std::isfinite(value)) return {};
    const auto [kind, axis] = track.channels[i];
    if (kind == Kind::rotation) {
      const double half = double(value) * (std::numbers::pi / 360);
      V3d along(0);
      along[axis] = std::sin(half);
      rotation = rotation * Quaternion{along, std::cos(half)};
      turns = true;
    } else if (kind != Kind::unknown) {
      Vec3f& part = kind == Kind::position ? translation : scale;
      (axis == 0 ? part.x : axis == 1 ? part.y : part.z) = value;
      (kind == Kind::position ? moves : scales) = true;
    }
  }
  JointPose pose;
  if (turns) pose.rotation = toRotation(rotation);
  if (moves) pose.translation = translation;
  if (scales) pose.scale = scale;
  return pose;
}

} // namespace xvrml
