// script_process.cpp: Scripts in processes of their own. Tests check what a program there cannot
// do, and what happens to it, to the others and to the world when it tries. The programs are those
// of tests/script/hostile_engine.c.
#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <regex>
#include <thread>

#include <sys/wait.h>
#include <unistd.h>

#include "conformance/events/scripted.h"

namespace xvrml {
namespace {

// Sanitizers handle signals themselves and reserve so much address space that it cannot be limited.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool sanitized = true;
#else
constexpr bool sanitized = false;
#endif

BrowserOptions limits(double patience = 0, double seconds = 5) {
  BrowserOptions options;
  options.scriptPath = XVRML_HOSTILE_SCRIPTS ":" XVRML_TEST_SCRIPTS;
  options.scriptSeconds = seconds;
  options.scriptMemory = 64 << 20;
  options.scriptPatience = patience;
  return options;
}

// Returns a world. Its Script S does what `program` says when `go` arrives; E is a well-behaved
// Script of the test engine, also in a process.
std::string world(const std::string& program) {
  return "DEF S Script { eventIn SFBool go eventOut SFInt32 out\n url \"hostile:" + program +
         "\" }\nDEF E Script { eventIn SFInt32 in eventOut SFInt32 out url \"test:in: echo out\" }";
}

struct Hostile : Scripted {
  explicit Hostile(const std::string& program, BrowserOptions options = limits())
      : Scripted(world(program), options) {}
  bool lives() { // whether the world still handles events
    static int32_t number = 0;
    set("E", "in", ++number);
    // Waits long enough for a busy machine.
    for (int i = 0; i < 2000 && get("E", "out") != std::to_string(number); ++i) {
      browser.tick(browser.now() + 1.0 / 60);
      usleep(1000);
    }
    return get("E", "out") == std::to_string(number);
  }
  pid_t process(const char* script = "S") { // for a program with "go: process out"
    set(script, "go", true);
    return pid_t(std::stol(get(script, "out")));
  }
  // Ticks at 60 Hz until there is a message or printed output, for at most 10 s. Returns the number
  // of ticks; 0 on a timeout.
  int ticksUntilTold(Log& told) {
    for (int ticks = 1; ticks < 2000; ++ticks) {
      browser.tick(browser.now() + 1.0 / 60);
      told = messages();
      for (std::string& line : printed()) told.push_back(std::move(line));
      if (!told.empty()) return ticks;
      usleep(5000);
    }
    return 0;
  }
};

class ScriptProcess : public testing::Test {
 protected:
  void SetUp() override { isolationOfTest = BrowserOptions::Isolation::always; }
  void TearDown() override { isolationOfTest = BrowserOptions::Isolation::automatic; }
};

struct Misdeed {
  const char* name;
  const char* program;
  const char* message; // a part of the message
};
void PrintTo(const Misdeed& misdeed, std::ostream* out) { *out << misdeed.program; }
class ScriptMisdeeds : public testing::TestWithParam<Misdeed> {};

constexpr Misdeed misdeeds[] = {
    {"EndlessLoop", "go: spin", "took too long"},
    {"EndlessLoopThatAsks", "go: polite", "took too long"},
    {"EndlessCallsOfTheHost", "go: calls out", "took too long"},
    {"EndlessMessages", "go: chatter x", "took too long"},
    {"MemoryBomb", "go: bomb", "(Aborted)"},
    {"EndlessRecursion", "go: recurse", "(Segmentation fault)"},
    {"Crash", "go: crash", "(Segmentation fault)"},
    {"Exit", "go: exit 0", "its process ended with code 0"},
    {"BytesForMessages", "go: speak 0123456789abcdef0123456789abcdef", "its process"},
};
INSTANTIATE_TEST_SUITE_P(All, ScriptMisdeeds, testing::ValuesIn(misdeeds),
                         [](const auto& info) { return info.param.name; });

// With the default isolation.
TEST_P(ScriptMisdeeds, StopTheScriptAndNothingElse) {
  if (sanitized && GetParam().name == std::string_view("MemoryBomb"))
    GTEST_SKIP() << "memory has no limit with sanitizers";
  for (const double patience : {0.0, 0.02}) {
    // Programs that end by themselves may take their time on a busy machine.
    const bool endless = GetParam().message == std::string_view("took too long");
    Hostile r(GetParam().program, limits(patience, endless ? 0.2 : 20));
    EXPECT_EQ(r.messages(), Log{});
    r.set("S", "go", true);
    EXPECT_TRUE(r.lives());
    Log told = r.messages();
    for (int i = 0; i < 1000 && told.empty(); ++i) {
      r.ticksUntilTold(told);
      std::erase(told, "x"); // output of `chatter`
    }
    ASSERT_EQ(told.size(), 1u) << patience;
    EXPECT_EQ(told[0].find("3: Script S: "), 0u) << told[0]; // the line where its program begins
    EXPECT_TRUE(sanitized || told[0].find(GetParam().message) != std::string::npos) << told[0];
    EXPECT_NE(told[0].find("the Script is stopped"), std::string::npos) << told[0];
    EXPECT_EQ(r.browser.world().diagnostics.list().back().file, "test.wrl");
    r.set("S", "go", true); // it does nothing any more
    r.browser.tick(r.browser.now() + 1);
    EXPECT_TRUE(r.lives());
    EXPECT_EQ(r.messages(), Log{});
    r.set("S", "url", MFString{"hostile:go: print again"});
    r.set("S", "go", true);
    Log printed = r.printed();
    for (int i = 0; i < 10'000 && std::count(printed.begin(), printed.end(), "again") == 0; ++i)
      r.ticksUntilTold(printed);
    EXPECT_EQ(std::count(printed.begin(), printed.end(), "again"), 1);
  }
}

TEST_F(ScriptProcess, ReachesNothing) {
  setenv("XVRML_TEST_SECRET", "1", 1);
  setenv("LD_LIBRARY_PATH", ":/nonexistent", 0);
  struct {
    const char* program;
    const char* allowed; // the value that must not be printed
  } const table[] = {{"go: open /etc/passwd", "open: worked"},
                     {"go: create cage-test-file", "create: worked"},
                     {"go: socket", "socket: worked"},
                     {"go: env XVRML_TEST_SECRET", "set"},
                     {"go: env PATH", "set"},
                     {"go: given", "given"},
                     {"go: open /proc/self/environ", "open: worked"},
#ifdef XVRML_WITH_SECCOMP
                     {"go: exec /bin/true", "exec: worked"},
                     {"go: fork", "fork: worked"},
                     {"go: kill", "kill: worked"},
                     {"go: raise", "setrlimit: worked"},
#endif
                     {"go: descriptors", ""}};
  for (const auto& entry : table) {
    Hostile r(entry.program);
    r.set("S", "go", true);
    const Log printed = r.printed();
    ASSERT_EQ(printed.size(), 1u) << entry.program;
    EXPECT_NE(printed[0], entry.allowed) << entry.program;
    EXPECT_EQ(r.messages(), Log{}) << entry.program;
    if (!*entry.allowed) { EXPECT_EQ(printed[0], "0 open"); }
    EXPECT_TRUE(r.lives());
  }
}

TEST_F(ScriptProcess, EveryFunctionHasItsBudget) {
  for (const char* when :
       {"create", "initialize", "eventsProcessed", "tick", "shutdown", "destroy"}) {
    Log told;
    {
      Hostile r(std::string(when) + ": spin\ngo: print went", limits(0, 0.3));
      r.set("S", "go", true);
      r.browser.tick(1);
      r.browser.tick(2);
      EXPECT_TRUE(r.lives()) << when;
      r.set("S", "url", MFString{"hostile:go: print again"});
      r.set("S", "go", true);
      told = r.printed();
      const Log messages = r.messages();
      const std::string name = when;
      EXPECT_EQ(messages.size(), name == "destroy" ? 0u : 1u) << when;
      for (const std::string& message : messages)
        EXPECT_EQ(message, "3: Script S: " + name + " took too long: the Script is stopped");
    }
    ASSERT_FALSE(told.empty()) << when;
    EXPECT_EQ(told.back(), "again");
  }
}

TEST_F(ScriptProcess, OneThatIsKilledWhileNothingRunsIsStartedAnew) {
  Hostile r("initialize: print begins\ngo: process out");
  const pid_t first = r.process();
  ASSERT_GT(first, 1);
  EXPECT_NE(first, getpid());
  EXPECT_EQ(r.printed(), Log{"begins"});
  kill(first, SIGKILL);
  usleep(20'000);
  const pid_t second = r.process(); // the event is not lost
  EXPECT_NE(first, second);
  EXPECT_EQ(r.printed(), Log{"begins"});
  const Log messages = r.messages();
  ASSERT_EQ(messages.size(), 1u);
  EXPECT_EQ(messages[0].find("3: Script S: the process that it runs in ended by signal 9 (Killed)"),
            0u)
      << messages[0];
}

TEST_F(ScriptProcess, OneThatIsAlwaysKilledIsStopped) {
  Hostile r("go: process out");
  for (int i = 0; i < 4; ++i) {
    kill(r.process(), SIGKILL);
    usleep(20'000);
  }
  r.set("S", "go", true);
  // A process that has used much memory says how much, which differs each time.
  Log messages;
  for (const std::string& message : r.messages())
    messages.push_back(std::regex_replace(message, std::regex(", having used [0-9]+ MB"), ""));
  // An identical text is reported once.
  messages.erase(std::unique(messages.begin(), messages.end()), messages.end());
  const std::string ended = "3: Script S: the process that it runs in ended by signal 9 (Killed)";
  EXPECT_EQ(messages,
            (Log{ended + ": it is started anew", ended + " again: the Script is stopped"}));
  EXPECT_TRUE(r.lives());
}

TEST_F(ScriptProcess, ManyScriptsShareProcessesAndOneThatEndsItsProcessEndsAlone) {
  std::string text;
  constexpr int scripts = 40;
  for (int i = 0; i < scripts; ++i)
    text += fmt::format(
        "DEF S{} Script {{ eventIn SFBool go eventIn SFBool die eventOut SFInt32 out url \"hostile:"
        "go: process out\ndie: crash\" }}\n",
        i);
  Scripted r(text, limits());
  const auto processes = [&](int script) {
    r.set(fmt::format("S{}", script), "go", true);
    return std::stol(r.get(fmt::format("S{}", script), "out"));
  };
  std::vector<long> of;
  for (int i = 0; i < scripts; ++i) of.push_back(processes(i));
  std::vector<long> different = of;
  std::sort(different.begin(), different.end());
  different.erase(std::unique(different.begin(), different.end()), different.end());
  EXPECT_EQ(different.size(), 16u);
  const auto mates = std::count(of.begin(), of.end(), of[3]);
  EXPECT_GE(mates, 2);
  EXPECT_LE(mates, 3);
  r.set("S3", "die", true);
  Log messages = r.messages();
  ASSERT_EQ(long(messages.size()), mates);
  EXPECT_NE(messages[0].find("Script S3: event: its process ended"), std::string::npos)
      << messages[0];
  for (long i = 1; i < mates; ++i)
    EXPECT_NE(messages[size_t(i)].find("it is started anew"), std::string::npos);
  for (int i = 0; i < scripts; ++i)
    EXPECT_TRUE(i == 3 || (of[size_t(i)] == of[3]) == (processes(i) != of[size_t(i)])) << i;
  EXPECT_EQ(r.messages(), Log{});
}

TEST_F(ScriptProcess, WithoutTheProgramScriptsDoNothing) {
  for (const char* program : {"/nonexistent/xvrml-script-host", "/bin/true", "/etc/passwd"}) {
    setenv("XVRML_SCRIPT_HOST", program, 1);
    Hostile r("create: print runs\ngo: print runs");
    unsetenv("XVRML_SCRIPT_HOST");
    const Log messages = r.messages();
    ASSERT_EQ(messages.size(), 2u); // one per engine
    EXPECT_EQ(messages[0].find("2: Script S: no process for programs of engine hostile: "), 0u)
        << messages[0];
    EXPECT_NE(messages[0].find("; Scripts of this engine do nothing"), std::string::npos)
        << messages[0];
    EXPECT_TRUE(r.set("S", "go", true));
    r.browser.tick(1);
    EXPECT_EQ(r.printed(), Log{});
    EXPECT_EQ(r.messages(), Log{});
  }
}

TEST_F(ScriptProcess, AWorldCannotEndProcessesForEver) {
  Scripted r(world("go: exit 3") + "DEF N Script { eventIn SFBool go url \"hostile:go: print x\" }",
             limits());
  for (int i = 0; i < 100; ++i) {
    r.set("S", "url", MFString{fmt::format("hostile:go: exit {}", i)});
    r.set("S", "go", true);
  }
  r.messages();
  r.set("N", "go", true); // it has its process
  EXPECT_EQ(r.printed(), Log{"x"});
  r.set("N", "url", MFString{"hostile:go: print y"}); // it gets no new process
  r.set("N", "go", true);
  EXPECT_EQ(r.printed(), Log{});
  const Log messages = r.messages();
  ASSERT_EQ(messages.size(), 1u);
  EXPECT_NE(messages[0].find("100 processes have been ended by programs of this world; Scripts of "
                             "this engine do nothing"),
            std::string::npos)
      << messages[0];
}

TEST_F(ScriptProcess, ProcessesThatNobodyNeedsEnd) {
  std::string text = "DEF G Group {} ";
  for (int i = 0; i < 10; ++i) text += "Script { url \"nothing:\" } ";
  Scripted r(world("initialize: print begins") + text, limits());
  r.browser.tick(1);
  size_t children = 0;
  for (const auto& task : std::filesystem::directory_iterator("/proc/self/task")) {
    std::ifstream list(task.path() / "children");
    for (pid_t child; list >> child;) ++children;
  }
  EXPECT_EQ(children, 3u); // S, E and a spare process
}

// --- Waiting for slow programs ---

TEST_F(ScriptProcess, TheWorldGoesOnWhileAScriptTakesItsTime) {
  Hostile r("go: print began\ngo: slow 200\ngo: process out", limits(0.01, 10));
  ASSERT_TRUE(r.lives());
  r.log("S", "out");
  r.set("S", "go", true);
  EXPECT_EQ(r.printed(), Log{"began"});
  r.set("S", "go", true); // it waits
  EXPECT_TRUE(r.lives());
  EXPECT_EQ(r.take(), Log{});
  Log told;
  EXPECT_GT(r.ticksUntilTold(told), 1);
  EXPECT_EQ(told[0], "slept");
  for (int i = 0; i < 100 && r.events.size() < 2; ++i) r.ticksUntilTold(told);
  const Log events = r.take();
  ASSERT_EQ(events.size(), 2u); // each with the timestamp of its tick
  EXPECT_NE(events[0].substr(0, events[0].find(' ')), events[1].substr(0, events[1].find(' ')));
  EXPECT_EQ(r.messages(), Log{});
}

TEST_F(ScriptProcess, FramesGoOnWhileAScriptLoops) {
  for (const char* program : {"go: spin", "go: calls out", "go: chatter x"}) {
    Scripted r(world(program) +
                   " DEF C TimeSensor { loop TRUE } DEF T Script { eventIn SFTime in eventOut "
                   "SFTime out url \"test:in: echo out\" } ROUTE C.time TO T.in",
               limits(0.05, 0.6));
    r.log("T", "out");
    r.set("S", "go", true);
    int frames = 0;
    while (r.messages().empty() && frames < 2000) {
      r.browser.tick(r.browser.now() + 1.0 / 60);
      ++frames;
      usleep(16'000);
    }
    EXPECT_LT(frames, 2000);
    EXPECT_GT(frames, 10) << program;
    for (int i = 0; i < 10; ++i) {
      r.browser.tick(r.browser.now() + 1.0 / 60);
      usleep(2000);
    }
    // The other Script runs in every frame in which nothing else does.
    EXPECT_GE(int(r.take().size()), frames / 2) << program;
  }
}

TEST_F(ScriptProcess, ManyLoopsCostOnePatience) {
  std::string text = "DEF G Group {} DEF T Transform {}";
  for (int i = 0; i < 100; ++i)
    text += fmt::format("DEF S{} Script {{ eventIn SFVec3f go url \"hostile:go: spin\" }} ROUTE "
                        "T.translation TO S{}.go\n",
                        i, i);
  Scripted r(text, limits(0.05, 60));
  const auto start = std::chrono::steady_clock::now();
  r.set("T", "translation", Vec3f{1, 2, 3});
  for (int i = 0; i < 10; ++i) r.browser.tick(i);
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
  EXPECT_LT(taken.count(), 3); // not 5, or 50
  EXPECT_EQ(r.messages(), Log{});
}

// A tick waits for at most the patience, however many Scripts are late; and not in every tick for
// one that is always late.
TEST_F(ScriptProcess, SlowScriptsDoNotSlowDownEveryTick) {
  std::string text = "DEF T Transform {}";
  for (int i = 0; i < 6; ++i)
    text +=
        fmt::format("DEF S{} Script {{ eventIn SFVec3f go url \"hostile:go: slow 150\" }} ROUTE "
                    "T.translation TO S{}.go\n",
                    i, i);
  constexpr double patience = 0.1;
  constexpr int ticks = 100;
  Scripted r(text, limits(patience, 60));
  r.browser.tick(1);
  double waited = 0;
  std::vector<double> each;
  for (int i = 0; i < ticks; ++i) {
    const auto start = std::chrono::steady_clock::now();
    r.set("T", "translation", Vec3f{float(i), 0, 0});
    r.browser.tick(1 + i / 30.);
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
    waited += taken.count();
    each.push_back(taken.count());
    usleep(10'000);
  }
  std::nth_element(each.begin(), each.begin() + ticks / 2, each.end());
  EXPECT_LT(each[ticks / 2], patience / 2);
  EXPECT_LT(waited, ticks * patience / 4);
}

TEST_F(ScriptProcess, WithHardlyAnyPatienceScriptsBeginByAndBy) {
  std::string text = "DEF T Transform {}";
  for (int i = 0; i < 100; ++i)
    text += fmt::format(
        "DEF S{} Script {{ eventIn SFVec3f in url \"hostile:initialize: slow 1\ninitialize: print "
        "begins\nin: print event\" }} ROUTE T.translation TO S{}.in\n",
        i, i);
  Scripted r(text, limits(1e-6, 10));
  r.set("T", "translation", Vec3f{1, 2, 3}); // waits for Scripts that have not started
  Log printed = r.printed();
  // Long enough for a busy machine.
  const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(2);
  for (int i = 0; std::chrono::steady_clock::now() < end &&
                  std::count(printed.begin(), printed.end(), "event") < 100;
       ++i) {
    r.browser.tick(i);
    for (std::string& line : r.printed())
      if (line != "slept") printed.push_back(std::move(line));
    usleep(1000);
  }
  std::erase(printed, "slept");
  EXPECT_EQ(std::count(printed.begin(), printed.end(), "begins"), 100);
  EXPECT_EQ(std::count(printed.begin(), printed.end(), "event"), 100);
  EXPECT_EQ(printed.size(), 200u);
  EXPECT_EQ(r.messages(), Log{});
}

TEST_F(ScriptProcess, EventsThatWaitAreBounded) {
  Hostile r("go: slow 300\ngo: print went", limits(0.01, 10));
  for (int i = 0; i < 1500; ++i) r.set("S", "go", true);
  EXPECT_EQ(
      r.messages(),
      Log{"2: Script S: is still busy: the oldest of the events that wait for it are dropped"});
  EXPECT_TRUE(r.lives());
}

// --- Shutdown ---

TEST_F(ScriptProcess, NobodyWaitsForAProgramThatIsStuck) {
  const auto start = std::chrono::steady_clock::now();
  for (const bool loads : {false, true}) {
    Hostile r("go: spin\nshutdown: spin", limits(0.02, 60));
    r.set("S", "go", true);
    r.set("S", "url", MFString{"hostile:go: spin\nshutdown: spin"});
    r.set("S", "go", true);
    if (loads) r.browser.replaceWorld({r.browser.node("E")});
    r.browser.tick(1);
  }
  { Hostile r("shutdown: spin", limits(0, 1)); }
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
  EXPECT_LT(taken.count(), 20); // not minutes
}

size_t openFiles() {
  size_t count = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator("/proc/self/fd"))
    ++count;
  return count;
}

TEST_F(ScriptProcess, NothingIsLeftBehind) {
  { Hostile warm("go: print x"); }
  const size_t before = openFiles();
  {
    Hostile r("go: print x");
    for (int i = 0; i < 10'000; ++i) r.set("S", "url", MFString{"hostile:go: print x"});
    EXPECT_LT(openFiles(), before + 20);
    for (int i = 0; i < 20; ++i) {
      r.set("S", "url", MFString{i % 2 ? "hostile:go: crash" : "hostile:go: exit 1"});
      r.set("S", "go", true);
    }
    EXPECT_LT(openFiles(), before + 20);
    EXPECT_TRUE(r.lives());
  }
  EXPECT_EQ(openFiles(), before);
  EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1); // no child process, running or zombie
  EXPECT_EQ(errno, ECHILD);
}

TEST_F(ScriptProcess, ChildrenOfTheProgramAreLeftAlone) {
  const pid_t child = fork();
  if (child == 0) _exit(7);
  {
    Hostile r("go: crash");
    r.set("S", "go", true);
    EXPECT_TRUE(r.lives());
  }
  int status = 0;
  EXPECT_EQ(waitpid(child, &status, 0), child);
  EXPECT_EQ(WEXITSTATUS(status), 7);
}

// A browser may be passed from thread to thread.
TEST_F(ScriptProcess, AProcessOutlivesTheThreadThatStartedIt) {
  std::unique_ptr<Hostile> r;
  std::thread([&] { r = std::make_unique<Hostile>("go: process out"); }).join();
  const pid_t before = r->process();
  usleep(20'000);
  EXPECT_EQ(r->process(), before);
  EXPECT_EQ(r->messages(), Log{});
}

bool runs(pid_t process) {
  std::ifstream file(fmt::format("/proc/{}/stat", process));
  std::string number, name, state;
  return file >> number >> name >> state && state != "Z";
}

TEST_F(ScriptProcess, ProcessesEndWithTheProgram) {
  int pipes[2];
  ASSERT_EQ(pipe(pipes), 0);
  const pid_t child = fork();
  if (child == 0) {
    Hostile r("go: process out", limits(0.01, 600));
    const pid_t process = r.process();
    r.set("S", "url", MFString{"hostile:go: spin"}); // in the same process
    r.set("S", "go", true);
    if (write(pipes[1], &process, sizeof process) < 0) _exit(1);
    raise(SIGKILL);
  }
  pid_t process = 0;
  ASSERT_EQ(read(pipes[0], &process, sizeof process), ssize_t(sizeof process));
  waitpid(child, nullptr, 0);
  for (int i = 0; i < 1000 && runs(process); ++i) usleep(5000);
  EXPECT_FALSE(runs(process));
  close(pipes[0]);
  close(pipes[1]);
}

// A program that waits for any of its child processes also reaps the helpers.
TEST_F(ScriptProcess, SomebodyElseMayWaitForTheProcesses) {
  struct sigaction reapAll {
  }, former{};
  reapAll.sa_handler = [](int) {
    const int saved = errno;
    while (waitpid(-1, nullptr, WNOHANG) > 0) {}
    errno = saved;
  };
  sigaction(SIGCHLD, &reapAll, &former);
  {
    Hostile r("go: crash");
    r.set("S", "go", true);
    const Log messages = r.messages();
    ASSERT_EQ(messages.size(), 1u);
    EXPECT_NE(messages[0].find("its process ended"), std::string::npos) << messages[0];
    EXPECT_TRUE(r.lives());
  }
  sigaction(SIGCHLD, &former, nullptr);
}

} // namespace
} // namespace xvrml
