// script_ends.cpp: Scripts and worlds end in any order. Handles of Scripts may hold the last
// reference to other Scripts, and to their own nodes; each Script must still be shut down once,
// with its own fields. The last test makes worlds at random; HACKING.md says how to run many.
#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <map>
#include <random>
#include <stdexcept>
#include <thread>

#include "conformance/events/ecmascript_world.h"

namespace xvrml {
namespace {

// The text of a program, or of a world in a program, between quotes.
std::string quoted(const std::string& text, char quote) {
  std::string out(1, quote);
  for (const char c : text) {
    if (c == quote || c == '\\') out += '\\';
    out += c;
  }
  return out + quote;
}
std::string javascript(const std::string& program) {
  return " url " + quoted("javascript:" + program, '"') + " ";
}
std::string made(const std::string& vrml) {
  return "Browser.createVrmlFromString(" + quoted(vrml, '\'') + ")";
}
// Returns a Script that prints its number, which it keeps in a field, when it is shut down.
std::string telling(int number, const std::string& program = "") {
  return fmt::format("Script {{ field SFInt32 id {} {} }}", number,
                     javascript("function shutdown() { print(id) } " + program));
}
std::string keeping(int number, const std::string& kept) {
  return telling(number, "var kept; function initialize() { kept = " + made(kept) + " }");
}

BrowserOptions printingInto(const std::shared_ptr<Log>& lines) {
  BrowserOptions options;
  options.scriptPath = XVRML_SCRIPTS ":" XVRML_TEST_SCRIPTS;
  options.scriptIsolation = BrowserOptions::Isolation::never;
  options.print = [lines](const std::string& text) { lines->push_back(text); };
  return options;
}

class ScriptEnds : public EcmaScript {
 protected:
  std::shared_ptr<Log> lines = std::make_shared<Log>();
  Log sorted() const {
    Log out = *lines;
    std::sort(out.begin(), out.end());
    return out;
  }
};

TEST_F(ScriptEnds, AHandleMayHoldTheLastReferenceToAScriptWhenTheWorldEnds) {
  { Running r(keeping(1, keeping(2, telling(3))), 0, printingInto(lines)); }
  EXPECT_EQ(sorted(), (Log{"1", "2", "3"}));
}

TEST_F(ScriptEnds, AScriptThatEndedBeforeMayHoldTheLastReferenceWhenTheWorldEnds) {
  {
    Running r("Group { }", 0, printingInto(lines));
    MFNode made = r.browser.createVrmlFromString(keeping(1, telling(2)));
    made.clear(); // the Script ends here, and is shut down later
  }
  EXPECT_EQ(sorted(), (Log{"1", "2"}));
}

// A machine that is busy with other programs must not decide which Scripts of a world live.
TEST_F(ScriptEnds, TimeInWhichAProgramDoesNotComputeDoesNotStopIt) {
  BrowserOptions options = printingInto(lines);
  options.scriptSeconds = 0.05;
  options.print = [lines = lines](const std::string& text) {
    if (text == "wait") std::this_thread::sleep_for(std::chrono::milliseconds(100));
    lines->push_back(text);
  };
  Running r("DEF S Script { eventIn SFBool go" +
                javascript("function go() { print('wait'); for (var i = 0; i < 1000; i++); "
                           "print('went on') } function shutdown() { print('end') }") +
                "}",
            0, options);
  r.set("S", "go", true);
  r.set("S", "go", true);
  EXPECT_EQ(*lines, (Log{"wait", "went on", "wait", "went on"}));
}

TEST_F(ScriptEnds, AFunctionMayLetGoOfItsOwnNodeWhileEventsWait) {
  Running r("Group { }", 0, printingInto(lines));
  MFNode made = r.browser.createVrmlFromString(
      "Group { children Script { eventIn SFNode put eventIn SFBool go eventIn SFBool a eventIn "
      "SFBool b url \"test:put: keep\ngo: post self a\ngo: post self b\na: drop\nb: print "
      "late\nshutdown: print end\" } }");
  Node* script = std::get<MFNode>(r.browser.get(*made[0], "children"))[0].get();
  r.browser.set(*script, "put", made[0]);
  made.clear(); // now only the Script itself holds the Group that holds it
  r.browser.set(*script, "go", true);
  EXPECT_EQ(*lines, (Log{"late", "end"}));
}

TEST_F(ScriptEnds, AScriptMayLoseItsLastReferenceWhenTheTimeOfAllIsUsedUp) {
  BrowserOptions options = printingInto(lines);
  options.scriptIsolation = BrowserOptions::Isolation::always;
  options.scriptSeconds = 1;
  RunOptions run{.epoch = 0};
  run.worldScriptSeconds = 0.5;
  Running r("DEF W Group { } DEF B Script { eventIn SFBool burn" +
                javascript("function burn() { for (;;); }") + "}",
            0, options, run);
  MFNode made = r.browser.createVrmlFromString(
      "Group { children Script { directOutput TRUE field SFNode w NULL eventIn SFNode put eventIn "
      "SFBool go" +
      javascript("var kept; function put(v) { w = v } function go() { kept = w.children; "
                 "w.children = new MFNode() }") +
      "} }");
  Node* script = std::get<MFNode>(r.browser.get(*made[0], "children"))[0].get();
  r.browser.set(*script, "put", r.browser.node("W"));
  r.set("W", "children", made);
  made.clear();
  r.browser.set(*script, "go", true); // now only the Script holds the Group that holds it
  EXPECT_EQ(r.get("W", "children"), "[]");
  const ScriptCounts before = r.browser.scripts();
  r.set("B", "burn", true);
  r.browser.tick(0.001);
  EXPECT_EQ(before.started, 2u);
  std::string told;
  for (const Diagnostic& one : r.browser.world().diagnostics.list()) told += one.message + '\n';
  EXPECT_NE(told.find("1 of 2 Scripts are stopped"), told.npos) << told;
}

TEST_F(ScriptEnds, AnExceptionOfAProgramLeavesAWorldThatGoesOn) {
  Running r("DEF A Transform { } DEF B Transform { } ROUTE A.translation TO B.translation", 0,
            printingInto(lines));
  bool throws = true;
  r.browser.listen(r.node("A"), "translation", [&](Node&, const FieldInfo&, const Value&) {
    if (std::exchange(throws, false)) throw std::runtime_error("listener");
  });
  EXPECT_THROW(r.set("A", "translation", Vec3f{1, 0, 0}), std::runtime_error);
  r.set("A", "translation", Vec3f{2, 0, 0});
  EXPECT_EQ(r.get("B", "translation"), "2 0 0");
}

TEST_F(ScriptEnds, AnExceptionWhileScriptsStartEndsThoseThatHaveStarted) {
  RunOptions run{.epoch = 0};
  run.onScriptStart = [](const ScriptCounts& counts) {
    if (counts.started == 2) throw std::runtime_error("enough");
  };
  EXPECT_THROW(Running(keeping(1, telling(2)) + telling(3), 0, printingInto(lines), run),
               std::runtime_error);
  EXPECT_EQ(sorted().front(), "1");
}

// --- Worlds made at random ---

class RandomWorld {
 public:
  RandomWorld(uint64_t seed, std::string path) : random_(seed), path_(std::move(path)) {}

  std::string world() {
    std::string text = "#VRML V2.0 utf8\nDEF T TimeSensor { loop TRUE }\n";
    for (int i = 0; i < groups; ++i) text += fmt::format("DEF G{} Group {{ }}\n", i);
    const int scripts = 1 + below(4);
    for (int i = 0; i < scripts; ++i)
      text += fmt::format("{}DEF S{} {}\n",
                          below(3) ? "" : fmt::format("DEF H{} Group {{ children ", i), i,
                          script(2, i)) +
              (text.ends_with("children ") ? "}" : "");
    for (int i = 0; i < scripts; ++i) {
      if (below(4)) text += fmt::format("ROUTE T.time TO S{}.tick\n", i);
      if (below(2)) text += fmt::format("ROUTE S{}.out TO S{}.in\n", i, below(scripts));
      if (below(3) == 0)
        text += fmt::format("ROUTE S{}.out TO G{}.addChildren\n", i, below(groups));
    }
    return text;
  }
  int below(int n) { return int(random_() % uint64_t(n)); }

  static constexpr int groups = 3;

 private:
  template <size_t n> const char* one(const char* const (&of)[n]) { return of[below(int(n))]; }

  // depth: how many levels of Scripts its programs may make.
  std::string script(int depth, int own = -1) {
    const int id = ++last_;
    std::string fields = fmt::format("field SFInt32 id {}", id);
    const bool inFile = own >= 0;
    for (int i = 0; i < 2; ++i)
      fields += fmt::format(" field SFNode n{} {}", i,
                            inFile ? fmt::format("USE G{}", below(groups)) : "NULL");
    fields += inFile && below(3) == 0 ? fmt::format(" field SFNode me USE S{}", own)
                                      : " field SFNode me NULL";
    fields += inFile ? " field SFNode t USE T" : " field SFNode t NULL";
    std::string program = fmt::format(
        "var k = [], n = 0; function initialize() {{ print('+{} ' + id); {} }} "
        "function tick() {{ if (++n > 6) return; {} }} function take(v) {{ {} }} "
        "function eventsProcessed() {{ {} }} function shutdown() {{ print('-{} ' + id); {} }}",
        id, statements(depth, 2), statements(depth, 3), statements(depth, 2),
        below(3) ? "" : statements(depth, 1), id,
        one({"", "print(n0 ? 'n' : '0')", "try { print('r ' + k[0][0]) } catch (e) { }",
             "try { print('r ' + k[0][0].getName()) } catch (e) { }", "k = null", "n0 = null"}));
    program.insert(0, "this['in'] = function(v) { take(v) }; ");
    return fmt::format("Script {{ {} {} {} field MFNode list [ ] eventIn SFTime tick eventIn "
                       "MFNode in eventOut MFNode out {} }}",
                       below(4) ? "directOutput TRUE" : "", below(3) ? "" : "mustEvaluate TRUE",
                       fields, javascript(program));
  }
  std::string statements(int depth, int most) {
    std::string text;
    for (int i = below(most + 1); i > 0; --i)
      text += "try { " + statement(depth) + " } catch (e) { } ";
    return text;
  }
  std::string statement(int depth) {
    const int a = below(3), b = below(3), g = below(2);
    switch (below(22)) {
    case 0:
    case 1:
    case 2: return fmt::format("k[{}] = {}", a, made(content(depth - 1)));
    case 3: return fmt::format("n{}.children = {}", g, made(content(depth - 1)));
    case 4: return fmt::format("n{}.children = k[{}]", g, a);
    case 5: return fmt::format("n{}.children = new MFNode()", g);
    case 6: return fmt::format("k[{}] = n{}.children", a, g);
    case 7: return fmt::format("k[{}] = null", a);
    case 8: return "k = []";
    case 9: return fmt::format("n{} = k[{}][0]", g, a);
    case 10: return fmt::format("list = k[{}]", a);
    case 11: return fmt::format("out = k[{}]", a);
    case 12: return fmt::format("Browser.addRoute(t, 'time', k[{}][0], 'tick')", a);
    case 13: return fmt::format("Browser.deleteRoute(t, 'time', k[{}][0], 'tick')", a);
    case 14: return fmt::format("k[{}][0].n0 = {}", a, one({"me", "n0", "n1", "k[0][0]", "null"}));
    case 15:
      return fmt::format("k[{}][0].children = {}", a, one({"k[0]", "k[1]", "new MFNode(me)"}));
    case 16: return fmt::format("k[{}][0].list = k[{}]", a, b);
    case 17: return "k.push(v)";
    case 18:
      return below(6) ? "list = new MFNode()" : fmt::format("Browser.replaceWorld(k[{}])", a);
    case 19:
      return below(6)
                 ? "n0 = null"
                 : "Browser.loadURL(new MFString(" + quoted(path_, '\'') + "), new MFString())";
    case 20:
      return below(3) ? fmt::format("k[{}] = n{}.children; n{}.children = new MFNode()", a, g, g)
                      : "Browser.createVrmlFromURL(new MFString(" + quoted(path_, '\'') +
                            fmt::format("), n{}, 'children')", g);
    default: return fmt::format("k[{}] = k[{}]", a, b);
    }
  }
  std::string content(int depth) {
    switch (below(depth > 0 ? 7 : 2)) {
    case 0: return "Group { }";
    case 1:
      return below(4) ? "Shape { geometry Box { } }" : "Inline { url " + quoted(path_, '"') + " }";
    case 2: return "Group { children " + script(depth) + " }";
    case 3: return "PROTO P [ ] { Group { children " + script(depth) + " } } P { } P { }";
    case 4: return script(depth) + " " + script(depth);
    case 5: return "DEF A " + script(depth) + " DEF B " + script(depth) + " ROUTE A.out TO B.in";
    default: return script(depth);
    }
  }

  std::mt19937_64 random_;
  const std::string path_;
  int last_ = 0; // numbers of the Scripts so far
};

// Runs the world of a seed to one of its ends. Returns what was printed.
Log runAndEnd(uint64_t seed, const std::string& path) {
  const auto lines = std::make_shared<Log>();
  RandomWorld random(seed, "random.wrl");
  std::ofstream(path) << random.world();
  BrowserOptions options = printingInto(lines);
  if (everythingInProcesses) options.scriptIsolation = BrowserOptions::Isolation::always;
  options.maximumEvents = 2000;
  LoadOptions load;
  load.limits.inlineDepth = 3;
  load.limits.expandedNodes = 300;
  RunOptions run{.epoch = 0};
  const uint64_t failing = random.below(8) ? ~uint64_t(0) : uint64_t(1 + random.below(4));
  run.onScriptStart = [failing](const ScriptCounts& counts) {
    if (counts.started >= failing) throw std::runtime_error("enough");
  };
  try {
    Browser browser(loadWorld(path, load), options, 0, run);
    std::vector<NodeRef> held; // by the program that shows the world
    const int ticks = random.below(6);
    for (int i = 1; i <= ticks; ++i) {
      browser.tick(0.1 * i);
      const NodeRef group = browser.node(fmt::format("G{}", random.below(RandomWorld::groups)));
      if (!group) continue;
      if (random.below(3) == 0) held.push_back(group);
      if (random.below(4) == 0)
        for (const Value children = browser.get(*group, "children");
             const NodeRef& child : std::get<MFNode>(children))
          held.push_back(child);
      if (random.below(4) == 0) held.clear();
      if (random.below(5) == 0) browser.set(*group, "children", MFNode{});
      if (random.below(8) == 0)
        browser.createVrmlFromString(keeping(1'000'000, telling(1'000'001)));
    }
    if (random.below(4) == 0) browser.replaceWorld({});
    if (random.below(3) == 0) held.clear();
  } catch (const std::runtime_error&) {}
  return *lines;
}

// $XVRML_RANDOM_WORLDS=FIRST:COUNT runs other worlds.
TEST_F(ScriptEnds, WorldsOfScriptsMadeAtRandomShutEveryScriptDownOnce) {
  uint64_t first = 1, count = everythingInProcesses ? 5 : 150;
  if (const char* wanted = std::getenv("XVRML_RANDOM_WORLDS")) {
    char* end = nullptr;
    first = std::strtoull(wanted, &end, 10);
    count = *end == ':' ? std::strtoull(end + 1, nullptr, 10) : 1;
  }
  const std::string folder = testing::TempDir() + fmt::format("random_worlds_{}_{}", first, count);
  std::filesystem::create_directories(folder);
  size_t scripts = 0;
  for (uint64_t seed = first; seed < first + count; ++seed) {
    std::map<std::string, int> running; // by number and the content of the field `id`
    for (const std::string& line : runAndEnd(seed, folder + "/random.wrl")) {
      if (line.starts_with('+')) scripts += ++running[line.substr(1)] > 0;
      if (line.starts_with('-')) --running[line.substr(1)];
    }
    for (const auto& [script, times] : running)
      ASSERT_EQ(times, 0) << "Script " << script << " of the world of seed " << seed;
    if (seed % 1000 == 0 && count > 1000)
      fmt::print(stderr, "seed {}, {} Scripts\n", seed, scripts);
  }
  EXPECT_GT(2 * scripts, count);
  std::filesystem::remove_all(folder);
}

} // namespace
} // namespace xvrml
