// clock.cpp: the world's clock: seconds since 1970 (4.11.2), starting at a fixed number so that
// pictures are reproducible.
#include "conformance/events/support.h"

namespace xvrml {
namespace {

// A world run by an application that does not set the clock: times 0, 1, 2 after worldEpoch.
struct Loaded : Running {
  explicit Loaded(const std::string& vrml) : Running(vrml, 0, {}, RunOptions()) {}
  void ticks(std::initializer_list<double> times) {
    for (const double time : times) browser.tick(time);
  }
  float fraction(std::string_view name) {
    return std::get<SFFloat>(browser.get(node(name), "fraction_changed"));
  }
};

TEST(Clock, LoopWithStopTimeOneIsOffWhenTheWorldIsLoaded) {
  Loaded w("DEF T TimeSensor { loop TRUE startTime 0 stopTime 1 }");
  w.log("T", "isActive");
  w.ticks({0, 0.5, 1, 2});
  EXPECT_EQ(w.take(), Log{});
}

TEST(Clock, LoopWithStartTimeOneHasBeenRunningWhenTheWorldIsLoaded) {
  Loaded w("DEF T TimeSensor { loop TRUE startTime 1 cycleInterval 4 }");
  w.log("T", "isActive");
  w.ticks({0});
  EXPECT_EQ(w.take(), Log{"0 T.isActive TRUE"});
  EXPECT_FLOAT_EQ(w.fraction("T"), 0.75f); // a second before the next cycle
}

TEST(Clock, ARunOfOneSecondIn1970IsOver) {
  Loaded w("DEF T TimeSensor { startTime 1 cycleInterval 1 }");
  w.log("T", "isActive");
  w.ticks({0, 1, 2, 3});
  EXPECT_EQ(w.take(), Log{});
}

TEST(Clock, TimesOfEventsAreSecondsSince1970AndThoseOfTheProgramSecondsSinceLoading) {
  Loaded w("DEF T TimeSensor { loop TRUE }");
  w.ticks({0, 2.5});
  EXPECT_EQ(std::get<SFTime>(w.browser.get(w.node("T"), "time")), worldEpoch + 2.5);
  EXPECT_EQ(w.browser.now(), 2.5);
  EXPECT_EQ(w.browser.epoch(), worldEpoch);
  EXPECT_EQ(w.browser.events().now(), worldEpoch + 2.5);
}

TEST(Clock, TheProgramReadsTheTimeThatItHasGiven) { // epoch + 0.1 is rounded
  Loaded w("");
  w.ticks({0.1});
  EXPECT_EQ(w.browser.now(), 0.1);
  w.ticks({0.05});
  EXPECT_EQ(w.browser.now(), 0.1); // it does not run backwards
}

// Cycles whose length divides the epoch start at loading, so that sequences of a looping world
// start at its beginning. This includes lengths that are not exact in double (.1, .7, 3.3).
TEST(Clock, CyclesBeginAtTheLoading) {
  for (const char* cycle :
       {"0.1", "0.25", "0.7", "1",  "1.5", "2.2", "3",  "3.3", "4",   "5",   "6",
        "7",   "8",    "9",   "10", "12",  "30",  "60", "100", "360", "3600"}) {
    Loaded w(fmt::format("DEF T TimeSensor {{ loop TRUE cycleInterval {} }}", cycle));
    w.log("T", "cycleTime");
    w.ticks({0});
    EXPECT_EQ(w.fraction("T"), 0) << cycle;
    EXPECT_EQ(w.take(), Log{fmt::format("0 T.cycleTime {:.17g}", worldEpoch)}) << cycle;
    w.ticks({std::stod(cycle) / 2});
    EXPECT_NEAR(w.fraction("T"), 0.5, 1e-5) << cycle;
    w.ticks({std::stod(cycle)});
    EXPECT_EQ(w.fraction("T"), 1) << cycle; // 6.50: the end of a cycle, not the start of the next
  }
}

TEST(Clock, ASecondTickOfTheSameTimeSendsNothingAgain) { // 4.10.3
  Loaded w("DEF T TimeSensor { loop TRUE }");
  w.log("T", "time");
  w.ticks({0, 0});
  EXPECT_EQ(w.take().size(), 1u);
  w.ticks({1, 1, 1});
  EXPECT_EQ(w.take().size(), 1u);
}

TEST(Clock, ASensorThatIsSetToStartBetweenTicksOfTheSameTimeStarts) {
  Loaded w("DEF T TimeSensor { }");
  w.ticks({1});
  w.log("T", "isActive");
  w.set("T", "startTime", worldEpoch + 1);
  w.ticks({1});
  EXPECT_EQ(w.take(), Log{"1 T.isActive TRUE"});
}

TEST(Clock, AnotherEpochIsTheProgramsOwn) {
  Running w("DEF T TimeSensor { loop TRUE }", 5, {}, {.epoch = 100});
  w.browser.tick(6);
  EXPECT_EQ(w.get("T", "time"), "106");
  EXPECT_EQ(w.browser.now(), 6);
}

} // namespace
} // namespace xvrml
