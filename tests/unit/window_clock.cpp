// window_clock.cpp: Tests the clocks of vv's window: which steps a session performs, and the time
// of a world that is paused.
#include <vector>

#include <gtest/gtest.h>

#include "session/fit.h"
#include "session/session_clock.h"
#include "session/world_time.h"

namespace {

using vv::SessionClock;

struct Steps {
  std::vector<double> times;
  bool held = false;
  bool repeats = false; // the step wants to be repeated
  SessionClock::Driven driven() {
    return {[this] { return held; },
            [this](double time) {
              times.push_back(time);
              return !repeats;
            }};
  }
};

TEST(WindowClock, RealTimeIsThatOfTheReadings) {
  SessionClock clock(SessionClock::Mode::real, 10);
  Steps steps;
  for (const double reading : {5.0, 5.5, 5.25, 6.0}) {
    clock.read(reading);
    clock.pass();
    clock.run(steps.driven());
  }
  EXPECT_EQ(steps.times, (std::vector<double>{0, .5, .5, 1.25}));
  EXPECT_EQ(clock.time(), 1.25);
  EXPECT_EQ(clock.reading(), 6.0);
}

// While a picture of an instant is made, the time stands still and then goes on from there.
TEST(WindowClock, AHeldClockGoesOnFromItsInstant) {
  SessionClock clock(SessionClock::Mode::real, 10);
  Steps steps;
  const auto read = [&](double reading, SessionClock::Reading kind) {
    clock.read(reading, kind);
    if (kind == SessionClock::Reading::advances) clock.run(steps.driven());
  };
  read(1, SessionClock::Reading::advances);
  read(2, SessionClock::Reading::advances);
  read(50, SessionClock::Reading::isHeld);
  read(99, SessionClock::Reading::isHeld);
  EXPECT_EQ(clock.time(), 1);
  EXPECT_EQ(clock.reading(), 99);
  read(99.5, SessionClock::Reading::advances);
  EXPECT_EQ(steps.times, (std::vector<double>{0, 1, 1.5}));
}

TEST(WindowClock, StepsAreMultiplesOfThePeriodAndTheirNumberIsLimited) {
  SessionClock clock(SessionClock::Mode::stepped, 8);
  Steps steps;
  clock.read(0);
  clock.pass();
  clock.run(steps.driven());
  EXPECT_EQ(steps.times, (std::vector<double>{0}));
  clock.read(100); // a quarter of a second passes
  clock.pass();
  clock.run(steps.driven());
  EXPECT_EQ(steps.times, (std::vector<double>{0, .125, .25}));
}

TEST(WindowClock, AHeldStepIsRepeated) {
  SessionClock clock(SessionClock::Mode::stepped, 8);
  Steps steps;
  steps.repeats = true;
  clock.read(0);
  clock.pass();
  clock.run(steps.driven());
  clock.run(steps.driven());
  EXPECT_EQ(steps.times, (std::vector<double>{0, 0}));
  steps.held = true;
  clock.run(steps.driven());
  EXPECT_EQ(steps.times.size(), 2u);
  steps.held = steps.repeats = false;
  clock.run(steps.driven());
  clock.run(steps.driven());
  EXPECT_EQ(steps.times, (std::vector<double>{0, 0, 0}));
}

TEST(WindowClock, APausedWorldKeepsItsTime) {
  vv::WorldTime time(100);
  EXPECT_EQ(time.advance(2), 2);
  EXPECT_EQ(time.time(), 102);
  time.toggle();
  EXPECT_TRUE(time.isPaused());
  EXPECT_EQ(time.advance(5), 3);
  EXPECT_EQ(time.time(), 102);
  time.toggle();
  EXPECT_EQ(time.advance(6), 1);
  EXPECT_EQ(time.time(), 103);
}

TEST(WindowFit, OnlyAWantedFitBegins) {
  vv::Fit fit;
  fit.begin();
  EXPECT_FALSE(fit.isPending());
  fit.want(vv::Fit::Direction::current);
  EXPECT_TRUE(fit.isWanted());
  EXPECT_EQ(fit.direction(), vv::Fit::Direction::current);
  fit.begin();
  EXPECT_EQ(fit.state(), vv::Fit::State::mapping);
  EXPECT_TRUE(fit.isPending());
  EXPECT_FALSE(fit.isWanted());
  fit.end();
  EXPECT_FALSE(fit.isPending());
}

} // namespace
