// time_sensor.cpp: TimeSensor: clauses 4.6.9 and 6.50. One rule per test; the groups are those of
// the NIST VRML test suite.
#include <cmath>

#include "conformance/events/support.h"

namespace xvrml {
namespace {

// A world with one sensor T. Its isActive is logged.
struct Sensor : Running {
  explicit Sensor(const std::string& fields, double start = 0)
      : Running("DEF T TimeSensor { " + fields + " }", start) {
    log("T", "isActive");
  }
  void tick(double time) { browser.tick(time); }
  void ticks(std::initializer_list<double> times) {
    for (double time : times) tick(time);
  }
  double number(std::string_view out) {
    const Value value = browser.get(node("T"), out);
    return value.index() == size_t(FieldType::SFTime) ? std::get<SFTime>(value)
                                                      : double(std::get<SFFloat>(value));
  }
};

TEST(TimeSensor, OfDefaultValuesIsInactiveWhenRead) {
  Sensor s("");
  s.ticks({0, 0.5, 1, 2});
  EXPECT_EQ(s.take(), Log{});
}

TEST(TimeSensor, IsInactiveUntilStartTimeAndRunsOneCycle) {
  Sensor s("startTime 1 cycleInterval 2");
  s.ticks({0, 0.5, 1, 2, 3, 4});
  EXPECT_EQ(s.take(), (Log{"1 T.isActive TRUE", "3 T.isActive FALSE"}));
}

TEST(TimeSensor, WithLoopAndStartTimeLongAgoIsActiveAtOnce) {
  Sensor s("loop TRUE", 1.7e9);
  s.tick(1.7e9);
  EXPECT_EQ(s.take().size(), 1u);
}

TEST(TimeSensor, WithoutLoopWhoseCycleEndedBeforeReadingMakesNoEvents) {
  Sensor s("startTime 100 cycleInterval 5", 106);
  s.ticks({106, 107});
  EXPECT_EQ(s.take(), Log{});
}

TEST(TimeSensor, WithoutLoopReadDuringItsCycleRunsTheRest) {
  Sensor s("startTime 100 cycleInterval 5", 102);
  s.ticks({102, 104, 105});
  EXPECT_EQ(s.take(), (Log{"102 T.isActive TRUE", "105 T.isActive FALSE"}));
}

TEST(TimeSensor, LoopRunsOnWhileStopTimeIsBeforeStartTime) {
  Sensor s("loop TRUE startTime 2 stopTime 1");
  s.ticks({0, 1, 2, 3, 30, 300});
  EXPECT_EQ(s.take(), Log{"2 T.isActive TRUE"});
}

TEST(TimeSensor, LoopRunsOnWhileStopTimeEqualsStartTime) {
  Sensor s("loop TRUE startTime 2 stopTime 2");
  s.ticks({0, 2, 3, 30});
  EXPECT_EQ(s.take(), Log{"2 T.isActive TRUE"});
}

TEST(TimeSensor, LoopEndsAtAStopTimeAfterStartTime) {
  Sensor s("loop TRUE startTime 2 stopTime 5");
  s.ticks({0, 2, 3, 5, 6});
  EXPECT_EQ(s.take(), (Log{"2 T.isActive TRUE", "5 T.isActive FALSE"}));
}

TEST(TimeSensor, WithLoopAndAStopTimeBeforeReadingMakesNoEvents) {
  Sensor s("loop TRUE startTime 2 stopTime 5", 7);
  s.ticks({7, 8});
  EXPECT_EQ(s.take(), Log{});
}

TEST(TimeSensor, StopTimeDuringACycleEndsItThereWithTheFractionOfThatTime) {
  Sensor s("startTime 1 stopTime 2.5 cycleInterval 4");
  s.ticks({1, 2});
  s.log("T", "fraction_changed");
  s.log("T", "time");
  s.tick(3);
  EXPECT_EQ(s.take(), (Log{"1 T.isActive TRUE", "3 T.fraction_changed 0.375", "3 T.time 2.5",
                           "3 T.isActive FALSE"}));
}

TEST(TimeSensor, StopTimeAfterTheOnlyCycleHasNoEffect) {
  Sensor s("startTime 1 stopTime 9 cycleInterval 2");
  s.ticks({1, 2, 3, 8, 9});
  EXPECT_EQ(s.take(), (Log{"1 T.isActive TRUE", "3 T.isActive FALSE"}));
}

TEST(TimeSensor, TheCycleEndsWithFractionOneAndTheExactTime) {
  Sensor s("startTime 1 cycleInterval 2");
  s.ticks({1, 2});
  s.log("T", "fraction_changed");
  s.log("T", "time");
  s.take();
  s.tick(3.7);
  EXPECT_EQ(s.take(), (Log{"3.7 T.fraction_changed 1", "3.7 T.time 3", "3.7 T.isActive FALSE"}));
  s.tick(4);
  EXPECT_EQ(s.take(), Log{});
}

TEST(TimeSensor, EventsOfTheFirstTickAreInOrder) {
  Sensor s("startTime 1 cycleInterval 2");
  for (const char* out : {"cycleTime", "fraction_changed", "time"}) s.log("T", out);
  s.tick(1);
  EXPECT_EQ(s.take(),
            (Log{"1 T.isActive TRUE", "1 T.cycleTime 1", "1 T.fraction_changed 0", "1 T.time 1"}));
}

TEST(TimeSensor, TheFractionGrowsThroughEachCycleAndIsOneNeverZeroAtItsEnd) {
  Sensor s("loop TRUE startTime 1 cycleInterval 2");
  s.log("T", "fraction_changed");
  s.ticks({1, 1.5, 2.5, 3, 3.5, 5, 6});
  EXPECT_EQ(s.take(), (Log{"1 T.isActive TRUE", "1 T.fraction_changed 0",
                           "1.5 T.fraction_changed 0.25", "2.5 T.fraction_changed 0.75",
                           "3 T.fraction_changed 1", "3.5 T.fraction_changed 0.25",
                           "5 T.fraction_changed 1", "6 T.fraction_changed 0.5"}));
}

TEST(TimeSensor, CycleTimeIsSentAtTheStartOfEachCycleWithItsTime) {
  Sensor s("loop TRUE startTime 1 cycleInterval 2");
  s.log("T", "cycleTime");
  s.ticks({1, 2, 2.9, 3, 4, 5.5, 6});
  EXPECT_EQ(s.take(),
            (Log{"1 T.isActive TRUE", "1 T.cycleTime 1", "3 T.cycleTime 3", "5.5 T.cycleTime 5"}));
}

TEST(TimeSensor, ATickOverSeveralCyclesSendsTheLastCycleTimeOnly) {
  Sensor s("loop TRUE startTime 1 cycleInterval 2");
  s.log("T", "cycleTime");
  s.ticks({1, 10.5});
  EXPECT_EQ(s.take(), (Log{"1 T.isActive TRUE", "1 T.cycleTime 1", "10.5 T.cycleTime 9"}));
}

TEST(TimeSensor, TheTickThatBeginsARunLateTellsTheCyclesOwnStart) {
  Sensor s("startTime 1 cycleInterval 4");
  for (const char* out : {"cycleTime", "fraction_changed", "time"}) s.log("T", out);
  s.ticks({0, 2});
  EXPECT_EQ(s.take(), (Log{"2 T.isActive TRUE", "2 T.cycleTime 1", "2 T.fraction_changed 0.25",
                           "2 T.time 2"}));
}

TEST(TimeSensor, ARunBetweenTwoTicksIsNotLost) {
  Sensor s("startTime 1 cycleInterval 0.5");
  s.log("T", "fraction_changed");
  s.ticks({0, 10, 20, 30});
  EXPECT_EQ(s.take(), (Log{"10 T.isActive TRUE", "10 T.fraction_changed 1",
                           "20 T.fraction_changed 1", "20 T.isActive FALSE"}));
}

TEST(TimeSensor, TimeIsSentAtEachTickWhileActiveOnly) {
  Sensor s("startTime 1 cycleInterval 2");
  s.log("T", "time");
  s.ticks({0, 1, 1.5, 3, 4});
  EXPECT_EQ(s.take(), (Log{"1 T.isActive TRUE", "1 T.time 1", "1.5 T.time 1.5", "3 T.time 3",
                           "3 T.isActive FALSE"}));
}

TEST(TimeSensor, IgnoresSetStartTimeWhileActive) {
  Sensor s("loop TRUE startTime 1");
  s.log("T", "startTime_changed");
  s.tick(1);
  s.take();
  s.set("T", "set_startTime", 5.0);
  EXPECT_EQ(s.take(), Log{});
  EXPECT_EQ(s.get("T", "startTime"), "1");
}

TEST(TimeSensor, IgnoresSetCycleIntervalWhileActive) {
  Sensor s("loop TRUE startTime 1 cycleInterval 2");
  s.log("T", "cycleInterval_changed");
  s.set("T", "set_cycleInterval", 3.0);
  EXPECT_EQ(s.take(), Log{"0 T.cycleInterval_changed 3"});
  s.tick(1);
  s.take();
  s.set("T", "set_cycleInterval", 5.0);
  EXPECT_EQ(s.take(), Log{});
  EXPECT_EQ(s.get("T", "cycleInterval"), "3");
}

TEST(TimeSensor, RefusesACycleIntervalThatIsNotPositive) {
  Sensor s("");
  for (double bad : {0.0, -1.0, std::nan("")}) s.set("T", "set_cycleInterval", bad);
  EXPECT_EQ(s.get("T", "cycleInterval"), "1");
}

TEST(TimeSensor, IgnoresASetStopTimeNotAfterStartTimeWhileActive) {
  Sensor s("loop TRUE startTime 2 stopTime 9");
  s.log("T", "stopTime_changed");
  s.ticks({2, 3});
  s.take();
  s.set("T", "set_stopTime", 1.0);
  s.set("T", "set_stopTime", 2.0);
  EXPECT_EQ(s.take(), Log{});
  s.set("T", "set_stopTime", 4.0);
  EXPECT_EQ(s.take(), Log{"3 T.stopTime_changed 4"});
  s.ticks({4});
  EXPECT_EQ(s.take(), Log{"4 T.isActive FALSE"});
}

TEST(TimeSensor, ASetStopTimeInThePastStopsNowAndKeepsItsValue) {
  Sensor s("loop TRUE startTime 1 cycleInterval 10");
  s.ticks({1, 6});
  s.log("T", "stopTime_changed");
  s.log("T", "time");
  s.take();
  s.set("T", "set_stopTime", 3.0);
  EXPECT_EQ(s.take(), (Log{"6 T.stopTime_changed 3", "6 T.time 6", "6 T.isActive FALSE"}));
}

TEST(TimeSensor, SetStopTimeAndThenSetStartTimeOfNowRestartIt) {
  Sensor s("loop TRUE startTime 1 cycleInterval 10");
  s.ticks({1, 6});
  s.take();
  s.set("T", "set_stopTime", 6.0);
  s.set("T", "set_startTime", 6.0);
  s.tick(7);
  EXPECT_EQ(s.take(), (Log{"6 T.isActive FALSE", "6 T.isActive TRUE"}));
  EXPECT_FLOAT_EQ(s.number("fraction_changed"), 0.1f);
}

// isActive is sent once per timestamp.
TEST(TimeSensor, RestartedWithinOneCascadeItIsActiveAgainAtTheNextTick) {
  Running r(
      "DEF A TimeSensor { startTime 6 } DEF T TimeSensor { loop TRUE startTime 1 cycleInterval 10 }"
      "ROUTE A.cycleTime TO T.set_stopTime ROUTE A.cycleTime TO T.set_startTime");
  r.log("T", "isActive");
  for (double t : {1.0, 5.0, 6.0, 7.0}) r.browser.tick(t);
  EXPECT_EQ(r.take(), (Log{"1 T.isActive TRUE", "6 T.isActive FALSE", "7 T.isActive TRUE"}));
  EXPECT_EQ(r.get("T", "startTime"), "6");
  EXPECT_EQ(r.get("T", "fraction_changed"), "0.1");
}

TEST(TimeSensor, LoopSetFalseWhileActiveEndsWithTheCycle) {
  Sensor s("loop TRUE startTime 1 cycleInterval 2");
  s.ticks({1, 5.5});
  s.set("T", "set_loop", false);
  s.ticks({6.5, 7, 8});
  EXPECT_EQ(s.take(), (Log{"1 T.isActive TRUE", "7 T.isActive FALSE"}));
  EXPECT_EQ(s.number("fraction_changed"), 1);
}

TEST(TimeSensor, LoopSetTrueAgainBeforeTheCycleEndsGoesOn) {
  Sensor s("loop TRUE startTime 1 cycleInterval 2");
  s.ticks({1, 2});
  s.set("T", "set_loop", false);
  s.tick(2.5);
  s.set("T", "set_loop", true);
  s.ticks({3, 4});
  EXPECT_EQ(s.take(), Log{"1 T.isActive TRUE"});
}

TEST(TimeSensor, LoopSetFalseEndsAtAnEarlierStopTime) {
  Sensor s("loop TRUE startTime 1 stopTime 2 cycleInterval 4");
  s.tick(1);
  s.set("T", "set_loop", false);
  s.ticks({2, 5});
  EXPECT_EQ(s.take(), (Log{"1 T.isActive TRUE", "2 T.isActive FALSE"}));
}

TEST(TimeSensor, EnabledSetFalseWhileActiveSendsTheLastEventsAndIsActiveFalse) {
  Sensor s("loop TRUE startTime 1 cycleInterval 4");
  s.ticks({1, 2});
  s.log("T", "fraction_changed");
  s.log("T", "enabled_changed");
  s.take();
  s.set("T", "set_enabled", false);
  EXPECT_EQ(s.take(),
            (Log{"2 T.enabled_changed FALSE", "2 T.fraction_changed 0.25", "2 T.isActive FALSE"}));
  s.ticks({3, 4});
  EXPECT_EQ(s.take(), Log{});
}

TEST(TimeSensor, DisabledItStillTakesEventsToItsFields) {
  Sensor s("enabled FALSE");
  s.log("T", "startTime_changed");
  s.set("T", "set_startTime", 3.0);
  s.ticks({3, 3.5});
  EXPECT_EQ(s.take(), Log{"0 T.startTime_changed 3"});
}

TEST(TimeSensor, EnabledAgainItRunsIfItsTimeIsNotOver) {
  Sensor s("enabled FALSE startTime 1 cycleInterval 4");
  s.ticks({1, 2});
  s.set("T", "set_enabled", true);
  s.ticks({3, 5});
  EXPECT_EQ(s.take(), (Log{"2 T.isActive TRUE", "5 T.isActive FALSE"}));
}

TEST(TimeSensor, ASetStartTimeLongAgoWithoutLoopDoesNotRun) {
  Sensor s("cycleInterval 2");
  s.tick(100);
  s.set("T", "set_startTime", 97.0);
  s.tick(101);
  EXPECT_EQ(s.take(), Log{});
}

TEST(TimeSensor, ASetStartTimeOfNowStartsInTheSameCascade) {
  Running r("DEF A TimeSensor { startTime 3 cycleInterval 1 } DEF T TimeSensor { cycleInterval 2 } "
            "ROUTE A.cycleTime TO T.startTime");
  r.log("T", "isActive");
  r.log("T", "fraction_changed");
  for (double t : {0.0, 3.0, 4.0, 5.0, 6.0}) r.browser.tick(t);
  EXPECT_EQ(r.take(),
            (Log{"3 T.isActive TRUE", "3 T.fraction_changed 0", "4 T.fraction_changed 0.5",
                 "5 T.fraction_changed 1", "5 T.isActive FALSE"}));
}

// Chains sensors through cycleTime: all of them start in the same cascade.
TEST(TimeSensor, OneEndsAndStartsTheNext) {
  Running r("DEF A TimeSensor { startTime 1 cycleInterval 2 } DEF B TimeSensor { cycleInterval 2 } "
            "DEF C TimeSensor { cycleInterval 2 }"
            "ROUTE A.cycleTime TO B.startTime ROUTE B.cycleTime TO C.startTime");
  r.log("C", "isActive");
  for (double t : {0.0, 1.0, 2.0, 3.0}) r.browser.tick(t);
  EXPECT_EQ(r.take(), (Log{"1 C.isActive TRUE", "3 C.isActive FALSE"}));
}

TEST(TimeSensor, ItRunsAgainWhenSetToStartAgain) {
  Sensor s("startTime 1");
  s.ticks({1, 2});
  s.set("T", "set_startTime", 3.0);
  s.ticks({3, 4, 5});
  EXPECT_EQ(s.take(), (Log{"1 T.isActive TRUE", "2 T.isActive FALSE", "3 T.isActive TRUE",
                           "4 T.isActive FALSE"}));
}

TEST(TimeSensor, ALongerCycleIntervalDoesNotReviveARunThatIsOver) {
  Sensor s("startTime 1");
  s.ticks({1, 2});
  s.take();
  s.set("T", "set_cycleInterval", 100.0);
  s.tick(3);
  EXPECT_EQ(s.take(), Log{});
}

TEST(TimeSensor, LoopSetTrueAfterARunIsOverRunsOn) {
  Sensor s("startTime 1");
  s.ticks({1, 2, 3});
  s.set("T", "set_loop", true);
  EXPECT_EQ(s.take(), (Log{"1 T.isActive TRUE", "2 T.isActive FALSE", "3 T.isActive TRUE"}));
}

TEST(TimeSensor, WaitingItDoesNotRunForAStartTimeLongAgo) {
  Sensor s("startTime 50");
  s.tick(10);
  s.set("T", "set_startTime", 5.0);
  s.ticks({11, 51});
  EXPECT_EQ(s.take(), Log{});
}

TEST(TimeSensor, StartedAndDisabledInOneCascadeItEndsAtTheNextTick) {
  Running r("DEF A TimeSensor { startTime 3 } DEF B TimeSensor { startTime 2 } DEF T TimeSensor { "
            "cycleInterval 9 }"
            "ROUTE A.cycleTime TO T.startTime ROUTE B.isActive TO T.enabled");
  r.log("T", "isActive");
  for (double t : {0.0, 2.0, 3.0, 4.0, 5.0}) r.browser.tick(t);
  EXPECT_EQ(r.take(), (Log{"3 T.isActive TRUE", "4 T.isActive FALSE"}));
}

TEST(TimeSensor, DisabledAndEnabledAgainWithinItsCycleItRunsTheRest) {
  Sensor s("startTime 1 cycleInterval 4");
  s.ticks({1, 2});
  s.set("T", "set_enabled", false);
  s.tick(3);
  s.set("T", "set_enabled", true);
  s.ticks({4, 5});
  EXPECT_EQ(s.take(), (Log{"1 T.isActive TRUE", "2 T.isActive FALSE", "3 T.isActive TRUE",
                           "5 T.isActive FALSE"}));
}

TEST(TimeSensor, ReadDuringItsCycleItIsNotLostIfTheFirstTickComesLate) {
  Sensor s("startTime 100 cycleInterval 5", 102);
  s.ticks({110, 111, 112});
  EXPECT_EQ(s.take(), (Log{"110 T.isActive TRUE", "111 T.isActive FALSE"}));
}

TEST(TimeSensor, ATickBeyondStopTimeTellsOfACycleThatBeganBefore) {
  Sensor s("loop TRUE startTime 1 stopTime 5.5 cycleInterval 2"),
      exact("loop TRUE startTime 1 stopTime 5 cycleInterval 2");
  for (Sensor* sensor : {&s, &exact}) {
    sensor->log("T", "cycleTime");
    sensor->ticks({1, 3});
    sensor->take();
    sensor->tick(7);
  }
  EXPECT_EQ(s.take(), (Log{"7 T.cycleTime 5", "7 T.isActive FALSE"}));
  EXPECT_EQ(exact.take(), Log{"7 T.isActive FALSE"}); // no cycle started at 5
}

TEST(TimeSensor,
     TheLastFractionIsOneThoughTheEndIsRounded) { // 1.7e9 + 0.1 - 1.7e9 is less than 0.1
  Sensor s("startTime 1700000000 cycleInterval 0.1", 1.6e9);
  s.ticks({1.7e9, 1.7e9 + 1});
  EXPECT_EQ(s.number("fraction_changed"), 1);
}

TEST(TimeSensor, InAPrototypeItRunsAsOutside) {
  Running r("PROTO P [ exposedField SFTime start 0 eventOut SFFloat f ] { TimeSensor { startTime "
            "IS start cycleInterval 4 fraction_changed IS f } }"
            "DEF I P { start 1 }");
  r.log("I", "f");
  for (double t : {0.0, 1.0, 2.0}) r.browser.tick(t);
  EXPECT_EQ(r.take(), (Log{"1 I.f 0", "2 I.f 0.25"}));
}

TEST(TimeSensor, FractionsAreExactAtTheTimesOfOurDays) {
  const double start = 1.7e9;
  Sensor s("loop TRUE startTime 0 cycleInterval 7", start);
  for (int i = 0; i < 1000; ++i) {
    const double now = start + i / 60.0;
    s.tick(now);
    const double part = std::fmod(now, 7.0) / 7;
    ASSERT_NEAR(s.number("fraction_changed"), part == 0 ? 1 : part, 1e-6) << now;
  }
}

TEST(TimeSensor, FractionsAreExactOverMillionsOfShortCycles) {
  Sensor s("loop TRUE startTime 1700000000.25 cycleInterval 0.125", 1.7e9);
  for (int i = 0; i < 1000; ++i) {
    const double now = 1.7e9 + 1e6 + 0.25 + i / 1024.0;
    s.tick(now);
    const double part = std::fmod(i / 1024.0, 0.125) / 0.125;
    ASSERT_EQ(s.number("fraction_changed"), part == 0 && i > 0 ? 1 : part)
        << i; // together: a cycle starts
  }
}

TEST(TimeSensor, TheEndOfACycleIsFoundThoughTicksAreNotExact) { // 0.3 - 3 * 0.1 is 5.6e-17
  Sensor s("loop TRUE startTime 0 cycleInterval 0.1");
  for (int i = 0; i <= 50; ++i) {
    s.tick(i / 10.0);
    ASSERT_EQ(float(s.number("fraction_changed")), i == 0 ? 0.0f : 1.0f) << i;
  }
}

TEST(TimeSensor, OddTimesMakeNumbersAndNoHang) {
  for (const char* fields : {"startTime -1e308 cycleInterval 1e-300",
                             "startTime -1e308 stopTime 1e308 cycleInterval 1e308",
                             "cycleInterval 1e-300", "startTime 1e308", "stopTime 1e-300"}) {
    Sensor s(std::string("loop TRUE ") + fields, 1.7e9);
    s.log("T", "fraction_changed");
    s.ticks({1.7e9, 1.8e9, 1e300});
    const double fraction = s.number("fraction_changed");
    EXPECT_TRUE(fraction >= 0 && fraction <= 1) << fields;
  }
}

TEST(TimeSensor, TheSameTicksMakeTheSameEvents) {
  const auto run = [] {
    Sensor s("loop TRUE startTime 0.3 cycleInterval 0.7");
    for (const char* out : {"cycleTime", "fraction_changed", "time"}) s.log("T", out);
    for (int i = 0; i < 100; ++i) s.tick(i / 24.0);
    return s.take();
  };
  EXPECT_EQ(run(), run());
}

} // namespace
} // namespace xvrml
