// window_steps.cpp: Tests the order of a script's events: a save ends its step, and what reaches
// the world afterwards belongs to the next one.
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "session/replay.h"
#include "start/world_clock.h"
#include "xvrml/browser.h"
#include "xvrml/world.h"

namespace {

constexpr double fps = 10;

constexpr const char* examined = R"(#VRML V2.0 utf8
Viewpoint { position 0 0 6 } NavigationInfo { type [ "EXAMINE" "ANY" ] } Shape { geometry Box {} }
)";

// Plays a script. Each save notes the camera of its instant; `waits`: for a picture, as the window.
struct Player {
  std::unique_ptr<xvrml::Browser> browser;
  std::unique_ptr<vv::Pilot> pilot;
  vv::InputScript script;
  std::unique_ptr<vv::Replay> replay;
  bool waits = false;
  double time = 0;
  struct Saved {
    double time;
    xvrml::CameraSettings camera;
  };
  std::vector<Saved> saved;

  explicit Player(const std::string& text, const std::string& world = examined)
      : browser(std::make_unique<xvrml::Browser>(xvrml::loadWorldFromMemory(world, "w.wrl"))),
        pilot(std::make_unique<vv::Pilot>(*browser, 0, picture::View{})),
        script(vv::parseInputScript(text, "in.txt")) {
    pilot->begin({}, "");
    replay = std::make_unique<vv::Replay>(
        *pilot, script, [this](const vv::InputEvent&, vv::Action action) {
          if (action != vv::Action::save && action != vv::Action::saveExr) return;
          saved.push_back({time, pilot->camera()});
          if (waits) replay->wait();
        });
  }

  void playTo(double end) {
    for (int i = 0; i / fps <= end; ++i) {
      time = i / fps;
      while (!replay->step(time)) replay->resume(); // the picture has been saved
    }
  }

  std::vector<double> times() const {
    std::vector<double> times;
    for (const Saved& one : saved) times.push_back(one.time);
    return times;
  }
};

const std::string drags = "0.1 move 0 0.8\n0.1 press left 0 0.8\n0.2 move 0.4 0.6\n"
                          "0.3 release left 0.4 0.6\n0.3 down S\n0.3 up S\n0.3 move 0 0.8\n"
                          "0.3 press left 0 0.8\n0.3 move -0.3 0.7\n0.5 release left -0.3 0.7\n";

TEST(WindowSteps, WhatFollowsASaveAtTheSameTimeBelongsToTheNextStep) {
  for (const bool waits : {false, true}) {
    Player player(drags);
    player.waits = waits;
    player.playTo(.3);
    ASSERT_EQ(player.times(), (std::vector<double>{.3}));
    EXPECT_TRUE(player.saved[0].camera == player.pilot->camera()); // the second drag has not begun
    player.playTo(.4);
    EXPECT_FALSE(player.saved[0].camera == player.pilot->camera());
  }
}

TEST(WindowSteps, AReplayWithoutPicturesEndsWhereOneWithPicturesEnds) {
  Player window(drags), file(drags);
  window.waits = true;
  window.playTo(1);
  file.playTo(1);
  EXPECT_TRUE(window.pilot->camera() == file.pilot->camera());
}

TEST(WindowSteps, SavesThatFollowEachOtherShowOneInstant) {
  Player player("0.2 save a.png\n0.2 save b.exr\n0.2 key S\n0.2 key S shift\n0.2 quit\n");
  player.playTo(.5);
  // The key S goes up in between, and that belongs to the next step.
  EXPECT_EQ(player.times(), (std::vector<double>{.2, .2, .2, .3}));
}

TEST(WindowSteps, ASaveOfEachStepIsSavedInItsStep) {
  Player player("0.2 save a.png\n0.2 move 0 0\n0.2 save b.png\n0.2 move 0 0\n0.2 save c.png\n");
  player.playTo(.5);
  ASSERT_EQ(player.saved.size(), 3u);
  EXPECT_DOUBLE_EQ(player.saved[1].time, .3);
  EXPECT_DOUBLE_EQ(player.saved[2].time, .4);
}

// A key that a KeySensor gets as well reaches the world, so it waits.
TEST(WindowSteps, KeysOfTheWorldWaitForTheNextStep) {
  constexpr const char* sensed = "#X3D V3.3 utf8\nPROFILE Immersive\nDEF K KeySensor { }\n";
  Player player("0.2 save a.png\n0.2 key F1\n0.2 save b.png\n", sensed);
  player.playTo(.5);
  ASSERT_EQ(player.saved.size(), 2u);
  EXPECT_DOUBLE_EQ(player.saved[1].time, .3);
  Player other("0.2 save a.png\n0.2 down F1\n0.2 save b.png\n");
  other.playTo(.5);
  EXPECT_EQ(other.times(), (std::vector<double>{.2, .2}));
}

TEST(WindowSteps, TheTimeOfAStepIsTheFirstAtOrAfterIt) {
  EXPECT_EQ(vv::timeOfStep(0, 30), 0);
  EXPECT_EQ(vv::timeOfStep(1.01, 30), 31 / 30.);
  for (int i = 0; i < 100000; ++i) {
    EXPECT_EQ(vv::timeOfStep(i / 30., 30), i / 30.) << i;
    EXPECT_EQ(vv::timeOfStep(i / 24.7, 24.7), i / 24.7) << i;
  }
}

} // namespace
