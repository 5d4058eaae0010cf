// figure_motion.cpp: frames that play on the joints of figures (HAnimMotion, ISO/IEC 19775-1:2023
// 26.3.4): which frame a time has, what its numbers do, and what hostile motions do.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include <gtest/gtest.h>

#include "behaviour/figures/motion_frames.h"
#include "behaviour/figures/playback.h"
#include "conformance/events/support.h"

namespace xvrml {
namespace {

TEST(MotionPlayback, AFrameLastsItsDuration) {
  const PlayedFrames four{0, 3, 1, 0.1, false};
  EXPECT_EQ(playedFrame(four, 0, -1).frame, 0);
  EXPECT_EQ(playedFrame(four, 0, 0.09).frame, 0);
  EXPECT_EQ(playedFrame(four, 0, 0.1).frame, 1);
  EXPECT_EQ(playedFrame(four, 0, 3 * 0.1).frame, 3) << "though 3 * 0.1 / 0.1 is no whole number";
  EXPECT_FALSE(playedFrame(four, 0, 0.39).ended) << "the last one lasts as long as the others";
  const PlayedFrame end = playedFrame(four, 0, 7);
  EXPECT_TRUE(end.ended);
  EXPECT_EQ(end.frame, 3);
  EXPECT_DOUBLE_EQ(end.elapsed, 0.4);
}

TEST(MotionPlayback, FramesAreSkippedAndPlayedBackwards) {
  EXPECT_EQ(playedFrame({0, 6, 3, 1, false}, 0, 1).frame, 3);
  EXPECT_EQ(playedFrame({0, 7, 3, 1, false}, 0, 9).frame, 6) << "the last of 0, 3, 6";
  EXPECT_DOUBLE_EQ(playedFrame({0, 7, 3, 1, false}, 0, 9).elapsed, 3);
  EXPECT_EQ(playedFrame({2, 5, -1, 1, false}, 5, 2).frame, 3);
  EXPECT_TRUE(playedFrame({2, 5, -1, 1, false}, 5, 4).ended);
  EXPECT_EQ(playedFrame({2, 5, -1, 1, false}, 5, 4).frame, 2);
}

TEST(MotionPlayback, ALoopBeginsAgain) {
  const PlayedFrames three{1, 3, 1, 1, true};
  const int64_t expected[] = {2, 3, 1, 2, 3, 1};
  for (int i = 0; i < 6; ++i) EXPECT_EQ(playedFrame(three, 2, i).frame, expected[i]) << i;
  EXPECT_EQ(playedFrame(three, 2, 1).cycle, 0);
  EXPECT_EQ(playedFrame(three, 2, 2).cycle, 1);
  EXPECT_DOUBLE_EQ(playedFrame(three, 2, 4.5).cycleBegan, 2);
  EXPECT_EQ(playedFrame({0, 3, -1, 1, true}, 1, 2).frame, 3);
  EXPECT_EQ(playedFrame({0, 3, -1, 1, true}, 1, 2).cycle, -1);
  EXPECT_DOUBLE_EQ(playedFrame({0, 3, -1, 1, true}, 1, 3).cycleBegan, 2);
  EXPECT_EQ(playedFrame({0, 3, 5, 1, true}, 0, 1).frame, 1) << "an increment above the length";
}

TEST(MotionPlayback, ExtremeNumbersStayWithinTheFrames) {
  constexpr int64_t most = std::numeric_limits<int32_t>::max();
  for (const bool loop : {false, true})
    for (const int64_t increment : {most, -most - 1, int64_t(1), int64_t(-1)})
      for (const double seconds : {0.0, 1e-300, 1e9, 1e300, 1.7e308})
        for (const int64_t from : {int64_t(0), most}) {
          const PlayedFrame at = playedFrame({0, most, increment, 1e-300, loop}, from, seconds);
          EXPECT_GE(at.frame, 0);
          EXPECT_LE(at.frame, most);
        }
}

TEST(MotionChannels, NumbersGoToTheJointsInTheirOrder) {
  Faults faults;
  const MotionFrames frames = motionFrames(
      "3 Xposition Yposition Zposition, 1 Xrotation 0 2 Zscale Yscale", "a IGNORED\tb,c", faults);
  EXPECT_FALSE(faults.any());
  ASSERT_EQ(frames.tracks.size(), 4u);
  EXPECT_EQ(frames.width, 6u);
  EXPECT_EQ(frames.tracks[0].joint, "a");
  EXPECT_EQ(frames.tracks[1].joint, "") << "IGNORED";
  EXPECT_EQ(frames.tracks[2].joint, "b");
  EXPECT_TRUE(frames.tracks[2].channels.empty());
  EXPECT_EQ(frames.tracks[3].first, 4u);
  const nodes::HAnimJoint joint;
  const float frame[] = {1, 2, 3, 90, 5, 6};
  const JointPose moved = poseOf(frames.tracks[0], frame, {}, joint);
  EXPECT_EQ(moved.translation, (Vec3f{1, 2, 3}));
  EXPECT_FALSE(moved.rotation || moved.scale);
  EXPECT_EQ(poseOf(frames.tracks[3], frame, {}, joint).scale, (Vec3f{1, 6, 5}));
  const JointPose part = poseOf(frames.tracks[0], frame, {false, true, false}, joint);
  EXPECT_EQ(part.translation, (Vec3f{0, 2, 0})) << "channels that are not enabled keep the joint's";
}

TEST(MotionChannels, TheFirstRotationActsLast) {
  Faults faults;
  const MotionFrames frames = motionFrames("2 Zrotation Xrotation", "a", faults);
  const float frame[] = {90, 90};
  const JointPose pose = poseOf(frames.tracks[0], frame, {}, nodes::HAnimJoint());
  ASSERT_TRUE(pose.rotation);
  // x turns y to z, then z leaves it there; it turns x to y. That is a turn about 1 1 1.
  const float third = float(1 / std::sqrt(3));
  EXPECT_NEAR(pose.rotation->x, third, 1e-6);
  EXPECT_NEAR(pose.rotation->y, third, 1e-6);
  EXPECT_NEAR(pose.rotation->z, third, 1e-6);
  EXPECT_NEAR(pose.rotation->angle, 2 * std::numbers::pi / 3, 1e-6);
}

TEST(MotionChannels, WhatDoesNotFitIsTold) {
  const std::pair<const char*, const char*> cases[] = {{"1 Wrotation", "a"},
                                                       {"2 Xrotation", "a"},
                                                       {"1 Xrotation", "a b"},
                                                       {"Xrotation", "a"},
                                                       {"1 Xrotation 1 Yrotation", "a"},
                                                       {"99999999999999999999 X", "a"}};
  for (const auto& [channels, joints] : cases) {
    Faults faults;
    motionFrames(channels, joints, faults);
    EXPECT_TRUE(faults.any()) << channels << " for " << joints;
  }
  Faults faults;
  EXPECT_EQ(motionFrames("", "", faults).width, 0u);
  EXPECT_FALSE(faults.any()) << "an empty motion is none";
}

constexpr const char* figure =
    "#X3D V4.0 utf8\nPROFILE Immersive COMPONENT HAnim:2\n"
    "DEF F HAnimHumanoid { skeleton DEF A HAnimJoint { name \"humanoid_root\" children "
    "DEF B HAnimJoint { name \"l_knee\" } } motions [ DEF M HAnimMotion { ";
std::string world(const std::string& fields, const std::string& more = "") {
  return figure + fields + " } " + more + " ] }\n";
}
const std::string turning = "joints \"HumanoidRoot l_knee\" channels \"1 Xposition 1 Zrotation\" "
                            "frameDuration 1 values [ 0 0, 1 90, 2 180 ] ";

TEST(FigureMotion, TimePlaysItOnTheJoints) {
  Running run(world(turning));
  run.log("M", "frameIndex");
  run.log("M", "cycleTime");
  run.log("B", "rotation");
  for (const double time : {0.0, 0.5, 1.0, 2.5, 9.0}) run.browser.tick(time);
  EXPECT_EQ(run.get("M", "frameCount"), "3");
  EXPECT_EQ(run.get("M", "frameIndex"), "2");
  EXPECT_EQ(run.get("M", "elapsedTime"), "3");
  EXPECT_EQ(run.get("A", "translation"), "2 0 0");
  const Log told = run.take();
  EXPECT_EQ(std::count(told.begin(), told.end(), "1 M.frameIndex 1"), 1);
  EXPECT_EQ(std::count(told.begin(), told.end(), "2.5 M.frameIndex 2"), 1);
  EXPECT_EQ(std::count_if(told.begin(), told.end(),
                          [](const std::string& s) { return s.find("cycleTime") != s.npos; }),
            1);
  EXPECT_EQ(std::count_if(told.begin(), told.end(),
                          [](const std::string& s) { return s.find("B.rotation") != s.npos; }),
            2);
}

TEST(FigureMotion, APictureDoesNotDependOnThoseBefore) {
  Running often(world(turning + "loop TRUE ")), once(world(turning + "loop TRUE "));
  for (int i = 0; i <= 71; ++i) often.browser.tick(0.1 * i);
  once.browser.tick(7.1);
  EXPECT_EQ(once.get("M", "frameIndex"), "1");
  for (const char* joint : {"A", "B"})
    for (const char* field : {"rotation", "translation"})
      EXPECT_EQ(often.get(joint, field), once.get(joint, field)) << joint << field;
}

TEST(FigureMotion, EventsChooseFrames) {
  Running run(world(turning + "enabled FALSE "));
  run.browser.tick(1);
  EXPECT_EQ(run.get("A", "translation"), "0 0 0") << "it does not play";
  run.set("M", "frameIndex", SFInt32(2));
  run.browser.tick(2);
  EXPECT_EQ(run.get("A", "translation"), "2 0 0");
  run.set("M", "next", true);
  run.browser.tick(3);
  EXPECT_EQ(run.get("M", "frameIndex"), "2") << "without loop nothing follows the last frame";
  run.set("M", "previous", true);
  run.browser.tick(4);
  EXPECT_EQ(run.get("A", "translation"), "1 0 0");
  run.set("M", "enabled", true);
  run.browser.tick(5);
  EXPECT_EQ(run.get("A", "translation"), "2 0 0") << "it goes on from its frame";
  run.set("M", "values", MFFloat{5, 0});
  run.browser.tick(6);
  EXPECT_EQ(run.get("M", "frameCount"), "1");
  EXPECT_EQ(run.get("A", "translation"), "5 0 0");
}

TEST(FigureMotion, TheLastOfSeveralMotionsCounts) {
  const std::string other = "DEF N HAnimMotion { joints \"humanoid_root\" channels \"1 Xposition\" "
                            "values [ 7, 8 ] frameDuration 1 loop TRUE }";
  Running both(world(turning, other));
  both.browser.tick(1);
  EXPECT_EQ(both.get("A", "translation"), "8 0 0");
  EXPECT_NE(both.get("B", "rotation"), "0 0 1 0") << "the first one moves what the other does not";
  Running one(world(turning, other + " ] motionsEnabled [ TRUE FALSE"));
  one.browser.tick(1);
  EXPECT_EQ(one.get("A", "translation"), "1 0 0");
}

TEST(FigureMotion, HostileMotionsMoveNothing) {
  for (const char* fields :
       {"channels \"1 Xposition\"", "joints \"a\" channels \"1 Xposition\" values [ 1 ]",

        "joints \"humanoid_root\" channels \"0\" values [ 1 2 3 ]",
        "joints \"humanoid_root\" channels \"2 Xposition Yposition\" values [ 1 ]",
        "joints \"humanoid_root\" channels \"1 Xrotation\" frameDuration -1 values [ 0 0 ]",
        "joints \"humanoid_root\" channels \"1 Xrotation\" frameIncrement 0 startFrame 5 endFrame "
        "2 "
        "values [ 0 0 ]"}) {
    Running run(world(fields));
    for (const double time : {0.0, 1.0, 1e6}) run.browser.tick(time);
    EXPECT_EQ(run.get("A", "translation"), "0 0 0") << fields;
  }
}

} // namespace
} // namespace xvrml
