// script_start.cpp: many Scripts start in parallel in their processes. The world sees no difference
// except the time. Also the total resources of all Scripts of a world.
#include <algorithm>
#include <chrono>

#include <unistd.h>

#include "conformance/events/scripted.h"

namespace xvrml {
namespace {

using Isolation = BrowserOptions::Isolation;

BrowserOptions settings(Isolation isolation) {
  BrowserOptions options;
  options.scriptPath = XVRML_HOSTILE_SCRIPTS ":" XVRML_TEST_SCRIPTS;
  options.scriptIsolation = isolation;
  options.scriptSeconds = 20; // long enough for a busy machine
  return options;
}

// Returns Scripts that each print, send an event, read another node and write a field of their own
// while starting. For some the first URL cannot be run, for some the program fails.
std::string manyScripts(int count) {
  std::string text = "DEF T Transform { translation 1 2 3 }\n";
  for (int i = 0; i < count; ++i)
    text += fmt::format(
        "DEF S{0} Script {{ field SFNode node USE T eventOut SFVec3f out eventOut SFTime time url "
        "[ {1} \"test:"
        "create: print create {0}\ninitialize: now time\ninitialize: read node translation out\n"
        "initialize: {2} initialize {0}\" ] }}\n",
        i, i % 7 == 3 ? "\"nothing:\"" : "", i % 5 == 2 ? "error 1" : "print");
  for (int i = 0; i + 1 < count; ++i)
    text += fmt::format("DEF R{0} Script {{ eventIn SFVec3f in url \"test:in: print event of {0}\" "
                        "}} ROUTE S{0}.out TO R{0}.in\n",
                        i);
  return text;
}

TEST(ScriptStart, ManyAtOnceLookLikeOneAfterTheOther) {
  const std::string text = manyScripts(60);
  Scripted here(text, settings(Isolation::never));
  Scripted there(text, settings(Isolation::always));
  const Log expected = here.printed();
  EXPECT_GE(expected.size(), 150u);
  EXPECT_EQ(there.printed(), expected);
  EXPECT_EQ(there.messages(), here.messages());
  for (int i = 0; i < 60; ++i)
    EXPECT_EQ(there.get(fmt::format("S{}", i), "out"), here.get(fmt::format("S{}", i), "out")) << i;
}

TEST(ScriptStart, ProcessesWorkSideBySide) {
  std::string text;
  for (int i = 0; i < 12; ++i)
    text += "Script { url \"hostile:initialize: slow 600\" }\n"; // sleeps and needs no processor
  const auto start = std::chrono::steady_clock::now();
  Scripted r(text, settings(Isolation::always));
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
  EXPECT_EQ(r.printed(), Log(12, "slept"));
  EXPECT_LT(taken.count(), 6); // one after the other it would be 7.2
}

TEST(ScriptStart, OneThatEndsItsProcessHoldsNobodyUp) {
  std::string text;
  for (int i = 0; i < 40; ++i)
    text += fmt::format("DEF S{0} Script {{ url \"hostile:initialize: {1}\" }}\n", i,
                        i == 5    ? "crash"
                        : i == 20 ? "exit 3"
                                  : fmt::format("print begins {}", i));
  Scripted r(text, settings(Isolation::always));
  const Log messages = r.messages();
  const auto stopped = [](const std::string& line) {
    return line.find("the Script is stopped") != std::string::npos;
  };
  EXPECT_EQ(std::count_if(messages.begin(), messages.end(), stopped), 2)
      << testing::PrintToString(messages);
  Log printed = r.printed();
  std::sort(printed.begin(), printed.end());
  // Scripts of the same process print a second time.
  printed.erase(std::unique(printed.begin(), printed.end()), printed.end());
  EXPECT_EQ(printed.size(), 38u);
}

TEST(ScriptStart, IsCountedAndShown) {
  BrowserOptions options = settings(Isolation::always);
  RunOptions run{.epoch = 0};
  std::vector<ScriptCounts> shown;
  run.onScriptStart = [&](const ScriptCounts& counts) { shown.push_back(counts); };
  std::string text = "Script { url \"nothing:\" }\n";
  for (int i = 0; i < 30; ++i) text += "Script { url \"test:initialize: print begins\" }\n";
  Scripted r(text, options, run);
  ASSERT_EQ(shown.size(), 31u);
  for (size_t i = 0; i < shown.size(); ++i) EXPECT_EQ(shown[i].waiting, 30 - i);
  const ScriptCounts counts = r.browser.scripts();
  EXPECT_EQ(counts.scripts, 31u);
  EXPECT_EQ(counts.started, 30u);
  EXPECT_EQ(counts.waiting, 0u);
  EXPECT_GE(counts.calls, 60u);
  EXPECT_GT(counts.seconds, 0);
}

TEST(ScriptStart, WithPatienceTheWorldGoesOn) {
  BrowserOptions options = settings(Isolation::always);
  options.scriptPatience = 0.02;
  std::string text;
  for (int i = 0; i < 50; ++i) text += "Script { url \"hostile:initialize: slow 50\" }\n";
  Scripted r(text, options);
  EXPECT_GT(r.browser.scripts().waiting, 0u);
  Log printed = r.printed();
  for (int i = 0; i < 6000 && printed.size() < 50; ++i) {
    r.browser.tick(i / 60.0);
    for (std::string& line : r.printed()) printed.push_back(std::move(line));
    usleep(1000);
  }
  EXPECT_EQ(printed, Log(50, "slept"));
  EXPECT_EQ(r.browser.scripts().waiting, 0u);
  EXPECT_EQ(r.messages(), Log{});
}

// --- Resources of a world ---

TEST(ScriptTime, OfAWorldIsBounded) {
  for (const Isolation isolation : {Isolation::always, Isolation::never}) {
    BrowserOptions options = settings(isolation);
    options.scriptSeconds = 0.3;
    RunOptions run{.epoch = 0};
    run.worldScriptSeconds = 0.5;
    std::string text = "DEF G Script { eventIn SFBool go url \"test:go: print went\" }\n";
    for (int i = 0; i < 50; ++i) text += "Script { url \"hostile:initialize: polite\" }\n";
    const auto start = std::chrono::steady_clock::now();
    Scripted r(text, options, run);
    r.set("G", "go", true);
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
    EXPECT_LT(taken.count(), 10); // not 15
    EXPECT_EQ(r.printed(), Log{});
    const Log messages = r.messages();
    ASSERT_FALSE(messages.empty());
    EXPECT_NE(messages.back().find("limit worldScriptSeconds=0.5"), std::string::npos)
        << messages.back();
    EXPECT_NE(messages.back().find("of 51 Scripts are stopped"), std::string::npos)
        << messages.back();
    r.browser.tick(1);
    r.browser.tick(2);
    EXPECT_EQ(r.messages(), Log{});
  }
}

TEST(ScriptTime, GrowsWithTheTimeOfTheWorld) {
  for (const bool moves : {true, false}) {
    RunOptions run{.epoch = 0};
    run.worldScriptSeconds = 0.02; // equivalent to 0.2 s of sleep
    Scripted r("DEF S Script { eventIn SFBool go url \"hostile:go: slow 30\" }",
               settings(Isolation::always), run);
    for (int i = 0; i < 12; ++i) {
      r.browser.tick(moves ? i : 0);
      r.set("S", "go", true);
    }
    EXPECT_EQ(r.printed().size() == 12, moves);
    EXPECT_EQ(r.messages().empty(), moves);
  }
}

} // namespace
} // namespace xvrml
