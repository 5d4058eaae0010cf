// motion_frames.h: the frames of an HAnimMotion (ISO/IEC 19775-1:2023 26.3.4, ISO/IEC 19774-2):
// which numbers of a frame turn and move which joint. They are those of the motion files named BVH.
// [the browser's thread]
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/faults.h"
#include "xvrml/nodes.h"

namespace xvrml {

struct MotionChannel {
  enum class Kind : uint8_t { position, rotation, scale, unknown } kind = Kind::unknown;
  uint8_t axis = 0; // 0: x, 1: y, 2: z
};

// The channels of one joint. Their numbers follow each other in a frame, from `first` on.
struct MotionTrack {
  std::string joint; // empty: no joint has these numbers
  size_t first = 0;
  std::vector<MotionChannel> channels;
};

struct MotionFrames {
  std::vector<MotionTrack> tracks;
  size_t width = 0; // numbers of a frame
};
// Reads the fields `channels` and `joints`. faults: receives what does not fit.
MotionFrames motionFrames(std::string_view channels, std::string_view joints, Faults& faults);

// The values that a frame gives a joint; those without channels are left as they are.
struct JointPose {
  std::optional<Rotation> rotation;
  std::optional<Vec3f> translation, scale;
};
// Returns the pose of a track. frame: its numbers, `width` of them. enabled: the field
// channelsEnabled. now: the joint, whose translation and scale keep the axes that have no channel.
// A pose with a number that is not finite is empty.
JointPose poseOf(const MotionTrack& track, std::span<const float> frame, const MFBool& enabled,
                 const nodes::HAnimJoint& now);

} // namespace xvrml
