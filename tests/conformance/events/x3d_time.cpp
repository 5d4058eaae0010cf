// x3d_time.cpp: pauseTime, resumeTime, elapsedTime and isPaused of time-dependent nodes (ISO/IEC
// 19775-1 8.2.4), and AudioClip.gain. The clock has epoch 0.
#include <cmath>
#include <limits>

#include "conformance/events/media_files.h"
#include "conformance/events/support.h"
#include "xvrml/media.h"

namespace xvrml {
namespace {

const std::string header = "#X3D V3.3 utf8\nPROFILE Immersive\n";

Log logOf(const std::string& fields, const std::vector<double>& times,
          const std::vector<const char*>& outs, double start = 0) {
  Running r(header + "DEF T TimeSensor { " + fields + " }\n", start);
  for (const char* out : outs) r.log("T", out);
  for (const double time : times) r.browser.tick(time);
  return r.take();
}

TEST(Pause, StopsTheFractionUntilResumeTime) {
  EXPECT_EQ(logOf("cycleInterval 10 startTime 1 pauseTime 3 resumeTime 6",
                  {1, 2, 3.5, 5, 6, 8, 14, 15}, {"isActive", "isPaused", "fraction_changed"}),
            (Log{"1 T.isActive TRUE", "1 T.fraction_changed 0", "2 T.fraction_changed 0.1",
                 "3.5 T.fraction_changed 0.2", "3.5 T.isPaused TRUE", "6 T.isPaused FALSE",
                 "6 T.fraction_changed 0.2", "8 T.fraction_changed 0.4", "14 T.fraction_changed 1",
                 "14 T.isActive FALSE"}));
}

TEST(Pause, IsExactWhereTicksAreNot) {
  // ticks at other times give the same fractions, and a pause between two ticks counts
  EXPECT_EQ(
      logOf("cycleInterval 10 startTime 1 pauseTime 3 resumeTime 6", {1, 7}, {"fraction_changed"}),
      (Log{"1 T.fraction_changed 0", "7 T.fraction_changed 0.3"}));
  EXPECT_EQ(
      logOf("cycleInterval 10 startTime 1 pauseTime 3 resumeTime 6", {1, 4, 7},
            {"fraction_changed"}),
      (Log{"1 T.fraction_changed 0", "4 T.fraction_changed 0.2", "7 T.fraction_changed 0.3"}));
}

TEST(Pause, BeforeTheWorldWasLoadedCounts) {
  EXPECT_EQ(
      logOf("cycleInterval 10 startTime 1 pauseTime 3 resumeTime 6", {9}, {"fraction_changed"}, 8),
      (Log{"9 T.fraction_changed 0.5"}));
  // without the pause its run would be over at 11
  EXPECT_EQ(logOf("cycleInterval 10 startTime 1 pauseTime 3 resumeTime 6", {12},
                  {"fraction_changed"}, 12),
            (Log{"12 T.fraction_changed 0.8"}));
  // still paused
  EXPECT_EQ(logOf("cycleInterval 10 startTime 1 pauseTime 3", {20, 30},
                  {"isPaused", "fraction_changed"}, 20),
            (Log{"20 T.fraction_changed 0.2", "20 T.isPaused TRUE"}));
}

TEST(Pause, LoopsGoOnWhereTheyWere) {
  EXPECT_EQ(
      logOf("cycleInterval 4 loop TRUE startTime 0 pauseTime 6 resumeTime 7", {0, 6, 7, 8, 9, 10},
            {"cycleTime", "fraction_changed"}),
      (Log{"0 T.cycleTime 0", "0 T.fraction_changed 0", "6 T.cycleTime 4",
           "6 T.fraction_changed 0.5", "7 T.fraction_changed 0.5", "8 T.fraction_changed 0.75",
           "9 T.cycleTime 9", "9 T.fraction_changed 1", "10 T.fraction_changed 0.25"}));
}

TEST(Pause, ByEvents) {
  Running r(header + "DEF T TimeSensor { cycleInterval 10 loop TRUE startTime 0 }\n");
  for (const char* out : {"isPaused", "fraction_changed", "elapsedTime"}) r.log("T", out);
  r.browser.tick(0);
  r.browser.tick(2);
  r.take();
  r.set("T", "pauseTime", 2.0);
  EXPECT_EQ(r.take(), (Log{"2 T.isPaused TRUE"})); // the fraction of this time has been sent
  r.browser.tick(3);
  r.browser.tick(4);
  EXPECT_EQ(r.take(), Log());
  r.set("T", "resumeTime", 4.0);
  EXPECT_EQ(r.take(), (Log{"4 T.isPaused FALSE"}));
  r.browser.tick(5);
  EXPECT_EQ(r.take(), (Log{"5 T.fraction_changed 0.3", "5 T.elapsedTime 3"}));
  r.set("T", "pauseTime", 5.0);
  r.browser.tick(8);
  r.set("T", "resumeTime", 6.0); // in the past: it resumes now, and nothing is made up for
  r.browser.tick(9);
  EXPECT_EQ(r.take(), (Log{"5 T.isPaused TRUE", "8 T.isPaused FALSE", "9 T.fraction_changed 0.4",
                           "9 T.elapsedTime 4"}));
}

TEST(Pause, AndResumeInOneCascadeSendOneEvent) {
  Running r(header + "DEF T TimeSensor { cycleInterval 10 loop TRUE startTime 0 }\n"
                     "DEF P BooleanTrigger { }\nDEF A TimeTrigger { }\n"
                     "ROUTE A.triggerTime TO T.pauseTime\nROUTE A.triggerTime TO T.resumeTime\n");
  r.log("T", "isPaused");
  r.browser.tick(0);
  r.browser.tick(2);
  r.set("A", "set_boolean", true); // pauseTime = resumeTime = 2
  r.browser.tick(3); // an eventOut sends once in a cascade, so it resumes here, for the time 2
  r.browser.tick(4);
  EXPECT_EQ(r.get("T", "fraction_changed"), "0.4");
  EXPECT_EQ(r.take(), (Log{"2 T.isPaused TRUE", "3 T.isPaused FALSE"}));
}

TEST(Pause, StopTimeEndsIt) {
  EXPECT_EQ(logOf("cycleInterval 10 loop TRUE startTime 0 pauseTime 2 stopTime 5", {0, 2, 4, 6, 7},
                  {"isPaused", "isActive", "fraction_changed"}),
            (Log{"0 T.isActive TRUE", "0 T.fraction_changed 0", "2 T.fraction_changed 0.2",
                 "2 T.isPaused TRUE", "6 T.isPaused FALSE", "6 T.fraction_changed 0.2",
                 "6 T.isActive FALSE"}));
}

TEST(Pause, EnabledFalseEndsItAndTheNextRunIsFresh) {
  Running r(header + "DEF T TimeSensor { cycleInterval 10 startTime 0 loop TRUE pauseTime 2 }\n");
  for (const char* out : {"isActive", "isPaused", "fraction_changed"}) r.log("T", out);
  for (const double t : {0, 1, 3}) r.browser.tick(t);
  r.take();
  r.set("T", "enabled", false);
  EXPECT_EQ(r.take(),
            (Log{"3 T.isPaused FALSE", "3 T.fraction_changed 0.2", "3 T.isActive FALSE"}));
  r.set("T", "startTime", 5.0); // a pauseTime before the run belongs to the earlier one
  r.set("T", "enabled", true);
  r.browser.tick(5);
  r.browser.tick(6);
  EXPECT_EQ(r.take(),
            (Log{"5 T.isActive TRUE", "5 T.fraction_changed 0", "6 T.fraction_changed 0.1"}));
}

TEST(Pause, DefaultsAndUnusableTimesDoNotPause) {
  const double inf = std::numeric_limits<double>::infinity();
  for (const auto& [pause, resume] :
       {std::pair(0.0, 0.0), {5.0, 5.0}, {inf, 0.0}, {std::nan(""), 0.0}, {-inf, -1.0}}) {
    Running r(header + "DEF T TimeSensor { cycleInterval 10 loop TRUE startTime 0 }\n");
    r.set("T", "pauseTime", pause);
    r.set("T", "resumeTime", resume);
    r.log("T", "isPaused");
    for (const double t : {0, 4, 5, 6}) r.browser.tick(t);
    EXPECT_EQ(r.get("T", "fraction_changed"), "0.6") << pause << ' ' << resume;
    EXPECT_EQ(r.take(), Log());
  }
}

TEST(Pause, ElapsedTimeIsWithoutPauses) {
  EXPECT_EQ(logOf("cycleInterval 4 loop TRUE startTime 1 pauseTime 3 resumeTime 6",
                  {1, 2, 4, 5, 7, 9}, {"elapsedTime"}),
            (Log{"1 T.elapsedTime 0", "2 T.elapsedTime 1", "4 T.elapsedTime 2", "7 T.elapsedTime 3",
                 "9 T.elapsedTime 5"}));
  // it has been active since the world was loaded, not since 1970
  EXPECT_EQ(logOf("loop TRUE", {1000, 1002}, {"elapsedTime"}, 1000),
            (Log{"1000 T.elapsedTime 0", "1002 T.elapsedTime 2"}));
}

TEST(Pause, OfAClipIsSilent) {
  const Folder folder;
  folder.write("a.wav", wav(std::vector<int16_t>(400, 8192), 1, 100));
  Browser browser(
      loadWorldFromMemory(header + "Sound { maxFront 100 maxBack 100 minFront 50 minBack 50\n"
                                   "spatialize FALSE source DEF T AudioClip { loop TRUE\n"
                                   "startTime 1 gain 2 url \"a.wav\" } }\n",
                          folder / "world.x3dv"),
      BrowserOptions(), 0, RunOptions{.epoch = 0});
  Node& clip = *browser.node("T");
  Log events;
  for (const char* out : {"isPaused", "elapsedTime"})
    browser.listen(clip, out, [&, out](Node&, const FieldInfo&, const Value& value) {
      events.push_back(fmt::format("{:g} {} {}", browser.now(), out, textOf(value)));
    });
  browser.tick(1);
  browser.tick(2);
  ASSERT_EQ(heardIn(browser).size(), 1U);
  EXPECT_DOUBLE_EQ(heardIn(browser)[0].levels.left, 2); // gain
  browser.set(clip, "gain", std::numeric_limits<float>::max());
  EXPECT_LE(heardIn(browser)[0].levels.left, 1000);
  EXPECT_EQ(playingOf(clip).position, 1);
  events.clear();
  browser.set(clip, "pauseTime", 2.0);
  browser.tick(3);
  EXPECT_EQ(playingOf(clip).clip, nullptr);
  browser.set(clip, "resumeTime", 3.0);
  browser.tick(3.5);
  EXPECT_EQ(playingOf(clip).position, 1.5);
  EXPECT_EQ(events, (Log{"2 isPaused TRUE", "3 isPaused FALSE", "3.5 elapsedTime 1.5"}));
}

} // namespace
} // namespace xvrml
