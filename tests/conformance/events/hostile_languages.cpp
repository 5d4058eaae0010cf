// hostile_languages.cpp: the same misbehaviour in every language that untrusted worlds may use. A
// program that does not end, takes all memory, recurses, or accesses files, the network, processes
// or the environment is stopped or refused. A message names file, line and node, and the world
// continues frame by frame. Languages whose engines are not built are skipped.
#include <unistd.h>

#include "conformance/events/scripted.h"
#include "xvrml/script_engines.h"

namespace xvrml {
namespace {

// The required outcome:
// * stopped: the program is stopped or has an error of the language; either way there is a message
//   with a position;
// * refused: there is a message, or the program prints "refused"; it never prints "reached";
// * computes: the program prints "done", or is stopped.
enum class End { stopped, refused, computes };

struct Case {
  const char* language; // the scheme
  const char* name;
  End end;
  const char* program; // run when the event `go` arrives
};

void PrintTo(const Case& c, std::ostream* out) { *out << c.program; }

constexpr Case cases[] = {
    // --- Tcl ---
    {"tcl", "EndlessLoop", End::stopped, "while 1 {}"},
    {"tcl", "EndlessLoopThatCatches", End::stopped, "while 1 {catch {while 1 {set x 1}}}"},
    {"tcl", "EndlessLoopInFinally", End::stopped, "try {while 1 {}} finally {while 1 {}}"},
    {"tcl", "EndlessLoopThatLiftsItsLimits", End::stopped,
     "while 1 {catch {interp limit {} time -seconds {}}; catch {interp limit {} commands -value "
     "{}}}"},
    {"tcl", "OneLongBignumCommand", End::stopped,
     "while 1 {string length [expr {7**30000000 % 3**20000000}]}"},
    {"tcl", "BacktrackingRegularExpression", End::stopped,
     "regexp {^(.*)(.*)(.*)(.*)(.*)\\1\\2\\3\\4\\5$} [string repeat a 2001]"},
    {"tcl", "LongSort", End::stopped,
     "set l {}; for {set i 0} {$i < 100000} {incr i} {lappend l $i}\n"
     "while 1 {lsort -command {apply {{a b} {expr {$b - $a}}}} $l}"},
    {"tcl", "EndlessCallsOfTheHost", End::stopped, "while 1 {catch {Browser getName}}"},
    {"tcl", "EndlessMessages", End::stopped, "while 1 {puts x}"},
    {"tcl", "MemoryBomb", End::stopped, "set a xxxxxxxx; while 1 {append a $a}"},
    {"tcl", "MemoryBombOfLists", End::stopped, "while 1 {lappend l [string repeat x 1000000]}"},
    {"tcl", "HugeString", End::stopped, "string length [string repeat x 2000000000]"},
    {"tcl", "HugeList", End::stopped, "llength [lrepeat 500000000 x]"},
    {"tcl", "HugeFormat", End::stopped, "string length [format %2000000000s x]"},
    {"tcl", "Recursion", End::stopped, "proc f {} {f; f}; f"},
    {"tcl", "RecursionThatCatches", End::stopped, "proc f {} {catch f; f}; while 1 {catch f}"},
    {"tcl", "EndlessTimers", End::stopped,
     "proc again {} {after 0 again; while 1 {}}; after 0 again"},
    {"tcl", "Vwait", End::refused, "vwait forever; puts reached"},
    {"tcl", "File", End::refused, "puts reached[open /etc/passwd]"},
    {"tcl", "HiddenFile", End::refused, "puts reached[interp invokehidden {} open /etc/passwd]"},
    {"tcl", "FileOfAChild", End::refused,
     "interp create child; puts reached[interp eval child {open /etc/passwd}]"},
    {"tcl", "Source", End::refused, "source /etc/passwd; puts reached"},
    {"tcl", "Library", End::refused, "load /usr/lib/libtcl8.6.so; puts reached"},
    {"tcl", "Socket", End::refused, "puts reached[socket localhost 80]"},
    {"tcl", "Process", End::refused, "puts reached[exec true]"},
    {"tcl", "Pipe", End::refused, "puts reached[open |true]"},
    {"tcl", "Environment", End::refused,
     "if {[info exists ::env(PATH)]} {puts reached} else {puts refused}"},
    {"tcl", "EndOfTheProgram", End::computes, "exit 0"},

    // --- ECMAScript ---
    {"javascript", "EndlessLoop", End::stopped, "while (1);"},
    {"javascript", "EndlessLoopThatCatches", End::stopped,
     "while (1) { try { while (1); } catch (e) {} }"},
    {"javascript", "EndlessLoopInFinally", End::stopped,
     "try { while (1); } finally { while (1); }"},
    {"javascript", "EndlessLoopOfAnotherText", End::stopped, "new Function('while (1);')();"},
    {"javascript", "EndlessValueOf", End::stopped,
     "var o = { valueOf: function() { while (1); } }; o + 1;"},
    {"javascript", "BacktrackingRegularExpression", End::stopped,
     "var s = ''; for (var i = 0; i < 40; i++) s += 'a'; while (1) { try { /^(a*)*b$/.test(s); } "
     "catch (e) {} }"},
    {"javascript", "LongSort", End::stopped,
     "var l = []; for (var i = 0; i < 10000; i++) l.push(i); while (1) l.sort(function(a, b) { "
     "return b - a; });"},
    {"javascript", "LongText", End::stopped,
     "while (1) { try { var s = 'x'; while (1) s = s + s; } catch (e) {} }"},
    {"javascript", "EndlessCallsOfTheHost", End::stopped,
     "while (1) { try { Browser.getName(); } catch (e) {} }"},
    {"javascript", "EndlessMessages", End::stopped, "while (1) print('x');"},
    {"javascript", "MemoryBomb", End::stopped,
     "var a = []; while (1) a.push(new Array(1000).join('xyz') + a.length);"},
    {"javascript", "HugeString", End::stopped,
     "var s = new Array(1000000000).join('x'); while (1);"},
    {"javascript", "Recursion", End::stopped, "function f() { f(); f(); } f();"},
    {"javascript", "RecursionThatCatches", End::stopped,
     "function f() { try { f(); } catch (e) { f(); } } while (1) { try { f(); } catch (e) {} }"},
    {"javascript", "DeepText", End::stopped,
     "var s = ''; for (var i = 0; i < 1000000; i++) s += '['; eval(s);"},
    {"javascript", "EndlessJobs", End::stopped,
     "if (typeof Promise == 'undefined') while (1);\n"
     "function f() { Promise.resolve().then(f) } f();"},
    {"javascript", "EndlessJobsThatCatch", End::stopped,
     "if (typeof Promise == 'undefined') while (1);\n"
     "function f() { Promise.reject(1).then(f, f); while (1); } f();"},
    {"javascript", "WaitingThread", End::refused,
     "Atomics.wait(new Int32Array(new SharedArrayBuffer(4)), 0, 0); print('reached');"},
    {"javascript", "OtherModule", End::refused,
     "(0, eval)('import(\"/etc/passwd\")').then(function() { print('reached') }); "
     "print('refused');"},
    {"javascript", "Module", End::refused, "require('fs'); print('reached');"},
    {"javascript", "Network", End::refused, "new XMLHttpRequest(); print('reached');"},
    {"javascript", "Process", End::refused, "process.exit(0); print('reached');"},
    {"javascript", "Environment", End::refused, "print('reached' + process.env.PATH);"},
    {"javascript", "File", End::refused, "print('reached' + readFile('/etc/passwd'));"},
};

std::string nameOf(const testing::TestParamInfo<Case>& info) {
  return std::string(info.param.language) + "_" + info.param.name;
}

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    result += c;
  }
  return result + '"';
}

// Returns the complete program of a Script with the eventIn `go`.
std::string programOf(const Case& c) {
  const bool tcl = std::string_view(c.language) == "tcl";
  return fmt::format(fmt::runtime(tcl ? "tcl:proc go {{args}} {{\n{}\n}}"
                                      : "javascript:function go(value) {{\n{}\n}}"),
                     c.program);
}

class HostileLanguages : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(Every, HostileLanguages, testing::ValuesIn(cases), nameOf);

TEST_P(HostileLanguages, AProgramCannotHoldTheWorldUp) {
  const Case& c = GetParam();
  if (!hasScriptEngine(c.language, XVRML_SCRIPTS)) GTEST_SKIP() << "no engine for " << c.language;
  BrowserOptions options;
  options.scriptPath = engineFolders() + ":" XVRML_TEST_SCRIPTS;
  options.scriptSeconds = 0.15;
  options.scriptMemory = 32 << 20;
  options.scriptPatience = 0.02;
  Scripted r("DEF S Script { eventIn SFBool go url\n" + quoted(programOf(c)) +
                 " }\nDEF C TimeSensor { loop TRUE } DEF T Script { eventIn SFTime in eventOut "
                 "SFTime out url \"test:in: echo out\" } ROUTE C.time TO T.in",
             options);
  ASSERT_EQ(r.messages(), Log{});
  r.log("T", "out");
  r.set("S", "go", true);
  Log messages;
  bool done = false, refused = false, reached = false;
  int frames = 0;
  while (messages.empty() && !done && !refused && !reached && frames < 3000) {
    r.browser.tick(r.browser.now() + 1.0 / 60);
    ++frames;
    messages = r.messages();
    for (const std::string& line : r.printed()) {
      refused = refused || line.find("refused") == 0;
      reached = reached || line.find("reached") == 0;
    }
    done = c.end == End::computes && frames > 20;
    usleep(4000);
  }
  EXPECT_FALSE(reached);
  EXPECT_LT(frames, 3000) << "not stopped";
  EXPECT_EQ(int(r.take().size()), frames); // the other Script, once per frame
  if (c.end == End::computes || refused) return;
  ASSERT_FALSE(messages.empty());
  EXPECT_NE(messages[0].find(": Script S: "), std::string::npos) << messages[0];
  EXPECT_EQ(r.browser.world().diagnostics.list().back().file, "test.wrl");
  // A line of the program or after it.
  EXPECT_GE(r.browser.world().diagnostics.list().back().line, 2u);
  EXPECT_EQ(r.browser.world().diagnostics.list().back().severity, Severity::error) << messages[0];
}

// Programs in these languages can do whatever the user can.
TEST(HostileLanguages, SomeLanguagesAreForTrustedWorldsOnly) {
  for (const char* language : {"python", "native"}) {
    if (!hasScriptEngine(language, XVRML_SCRIPTS)) continue;
    BrowserOptions options;
    options.scriptPath = XVRML_SCRIPTS;
    for (const auto isolation :
         {BrowserOptions::Isolation::automatic, BrowserOptions::Isolation::always}) {
      options.scriptIsolation = isolation;
      Scripted r(
          fmt::format("DEF S Script {{ eventIn SFBool go url \"{}:print('reached')\" }}", language),
          options);
      r.set("S", "go", true);
      const Log messages = r.messages();
      ASSERT_EQ(messages.size(), 1u) << language;
      EXPECT_NE(messages[0].find("only in worlds that are trusted"), std::string::npos)
          << messages[0];
      EXPECT_EQ(r.printed(), Log{});
    }
  }
}

} // namespace
} // namespace xvrml
