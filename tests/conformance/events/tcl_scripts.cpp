// tcl_scripts.cpp: Scripts in Tcl: events, nodes, the Browser, messages, timers. See
// docs/scripts.md "Tcl/Tk".
#include <cstdlib>

#include "conformance/events/tcl_world.h"

namespace xvrml {
namespace {

class TclScripts : public Tcl {};
using W = TclWorld;

TEST_F(TclScripts, EventsCallProcedures) {
  W r(W::script(
      "eventIn SFInt32 in eventIn SFInt32 none eventIn SFBool set eventOut SFInt32 out",
      "proc in {value time} {set ::out [expr {$value * 2}]; puts \"$value $time\"}\nproc "
      "initialize t {puts \"i $t\"}\n"
      "proc eventsProcessed {} {puts processed}\nproc shutdown {time args} {puts \"s $time\"}"));
  r.log("S", "out");
  EXPECT_EQ(r.printed(), Log{"i 0.0"});
  r.browser.tick(2);
  r.set("S", "in", 3);
  EXPECT_EQ(r.take(), Log{"2 S.out 6"});
  EXPECT_EQ(r.printed(), (Log{"3 2.0", "processed"}));
  r.set("S", "none", 3);   // no such procedure
  r.set("S", "set", true); // a command of Tcl, but not a procedure of the program
  r.printed();
  r.set("S", "url", MFString{});
  EXPECT_EQ(r.printed(), Log{"s 2.0"});
  EXPECT_EQ(r.messages(), Log{});
}

TEST_F(TclScripts, ProgramsComeFromDataUrlsToo) {
  W r("Script { url \"data:application/x-tcl,puts%20a\" } Script { url "
      "\"data:text/x-tcl,puts%20b\" } Script { url \" TCL:puts c\" }");
  EXPECT_EQ(r.printed(), (Log{"a", "b", "c"}));
}

TEST_F(TclScripts, NodesAreCommands) {
  W q("DEF T Transform { children Shape {} } " +
      W::script(
          "directOutput TRUE field SFNode t USE T field SFNode none NULL eventOut SFVec3f own "
          "eventIn SFBool go",
          "proc go {} {\n"
          "  global t none self\n"
          "  puts [$t type]/[$t name]/[$t get translation]/$none\n"
          "  $t set translation {0 1 0}\n"
          "  $t set set_scale {2 2 2}\n"
          "  puts [lindex [$t fields] 2]\n"
          "  puts [$self type]/[$self name]/[$self get own]\n"
          "  $self set own {1 2 3}\n"
          "  puts [llength [$t get children]]/[[lindex [$t get children] 0] type]\n"
          "  foreach wrong {{$t get bboxSize} {$t get nothing} {$t set translation {0 1}} {$t set "
          "bboxSize {1 1 1}} {$t} {$t fly} {$t get} {$t set x}} {catch $wrong why; puts $why}\n}"));
  q.set("S", "go", true);
  EXPECT_EQ(
      q.printed(),
      (Log{"Transform/T/0.0 0.0 0.0/NULL", "exposedField SFVec3f center", "Script/S/0.0 0.0 0.0",
           "1/Shape", "Transform has no exposedField or eventOut 'bboxSize'",
           "Transform has no exposedField or eventOut 'nothing'",
           "expected SFVec3f, 3 numbers, but got \"0 1\"",
           "Transform has no eventIn or exposedField 'bboxSize'",
           "wrong # args: should be \"node2 option ?arg ...?\"",
           "bad option \"fly\": must be get, set, fields, type, name, or release",
           "wrong # args: should be \"node2 get field\"",
           "wrong # args: should be \"node2 set field value\""}));
  EXPECT_EQ(q.get("T", "translation"), "0 1 0");
  EXPECT_EQ(q.get("T", "scale"), "2 2 2");
  EXPECT_EQ(q.get("S", "own"), "1 2 3");
}

TEST_F(TclScripts, ANodeIsGoodUntilItsCommandGoes) {
  W r("DEF T Transform {} " +
      W::script("directOutput TRUE eventIn SFNode keep eventIn SFBool use eventIn SFBool drop "
                "eventIn SFBool rename_",
                "proc keep n {set ::n $n}\nproc use {} {$::n set translation {1 0 0}}\nproc drop "
                "{} {$::n release}\nproc rename_ {} {rename $::n thing; set ::n thing}"));
  r.set("S", "keep", r.browser.node("T"));
  r.set("S", "rename_", true);
  r.set("S", "keep", r.browser.node("T"));
  r.set("S", "use", true);
  EXPECT_EQ(r.get("T", "translation"), "1 0 0");
  r.set("S", "drop", true);
  r.set("S", "use", true);
  EXPECT_EQ(r.messages(), Log{"3: Script S: invalid command name \"thing\" (in procedure use)"});
  r.set("S", "keep", r.browser.node("T"));
  r.set("S", "use", true);
  EXPECT_EQ(r.messages(), Log{});
}

TEST_F(TclScripts, ANodeThatIsReleasedEnds) {
  W r(W::script("eventIn SFBool make eventIn SFBool drop",
                "proc make {} {set ::n [Browser createVrmlFromString {Script {url \"tcl:proc "
                "shutdown {} {puts gone}\"}}]}\n"
                "proc drop {} {$::n release}"));
  r.set("S", "make", true);
  r.browser.tick(1);
  EXPECT_EQ(r.printed(), Log{});
  r.set("S", "drop", true);
  r.browser.tick(2);
  EXPECT_EQ(r.printed(), Log{"gone"});
}

TEST_F(TclScripts, EventsToOtherNodesNeedDirectOutput) {
  W r("DEF T Transform {} " +
      W::script("field SFNode t USE T eventIn SFBool go",
                "proc go {} {catch {$::t set translation {0 1 0}} why; puts $why}"));
  r.set("S", "go", true);
  EXPECT_EQ(r.printed(), Log{"an event to another node needs directOutput TRUE"});
}

TEST_F(TclScripts, TheBrowserIsACommand) {
  W r("DEF G Group {} DEF A Transform {} DEF B Transform {} " +
      W::script(
          "directOutput TRUE field SFNode g USE G field SFNode a USE A field SFNode b USE B "
          "eventIn SFBool go eventIn SFBool routes eventIn SFBool replace eventIn SFBool load",
          "proc go {} {\n puts [Browser getName]/[expr {[Browser getVersion] ne {}}]/[Browser "
          "getCurrentSpeed]/[Browser getCurrentFrameRate]/[Browser getWorldURL]/[Browser now]\n "
          "Browser setDescription {about it}\n Browser print hello\n set new [Browser "
          "createVrmlFromString {Transform { translation 1 2 3 } Shape {}}]\n $::g set children "
          "$new\n catch {Browser createVrmlFromString {Nothing}} why; puts $why\n catch {Browser "
          "fly} why; puts $why\n"
          " catch {Browser getName x} why; puts $why\n"
          " Browser createVrmlFromURL tests/conformance/good/def-use.wrl $::g addChildren}\n"
          "proc routes v {if {$v} {Browser addRoute $::a translation $::b set_translation} else "
          "{Browser deleteRoute $::a translation_changed $::b translation}}\n"
          "proc replace {} {Browser replaceWorld [Browser createVrmlFromString {DEF New Group "
          "{}}]}\n"
          "proc load {} {Browser loadURL {x.wrl y.wrl} {target=frame}}"));
  r.browser.tick(3);
  r.set("S", "go", true);
  const Log printed = r.printed();
  ASSERT_EQ(printed.size(), 5u);
  EXPECT_EQ(printed[0], r.browser.name() + "/1/0.0/0.0/test.wrl/3.0");
  EXPECT_EQ(printed[1], "hello");
  EXPECT_EQ(printed[2], "");
  EXPECT_EQ(printed[3].find("bad function \"fly\": must be getName, getVersion, getCurrentSpeed,"),
            0u);
  EXPECT_EQ(printed[4], "wrong # args: should be \"Browser getName\"");
  EXPECT_EQ(r.browser.description(), "about it");
  EXPECT_GE(std::get<MFNode>(r.browser.get(r.node("G"), "children")).size(), 2u);
  r.set("S", "routes", true);
  r.set("A", "translation", Vec3f{1, 0, 0});
  EXPECT_EQ(r.get("B", "translation"), "1 0 0");
  r.set("S", "routes", false);
  r.set("A", "translation", Vec3f{2, 0, 0});
  EXPECT_EQ(r.get("B", "translation"), "1 0 0");
  r.messages();
  r.set("S", "load", true);
  EXPECT_EQ(r.messages().size(), 1u); // neither can be read
  const uint64_t generation = r.browser.generation();
  r.set("S", "replace", true);
  EXPECT_EQ(r.browser.generation(), generation + 1);
}

TEST_F(TclScripts, ErrorsCarryTheLineOfTheFile) {
  W r("\n\n" + W::script("eventIn SFBool top eventIn SFBool deep eventIn SFBool nested eventIn "
                         "SFBool spaced eventIn SFBool loose",
                         "# line 4 of the file\n"
                         "proc inner {x} {\n"
                         "  set y 1\n"
                         "  nothing $x\n" // line 7
                         "}\n"
                         "proc deep {} {\n"
                         "  inner 1\n"
                         "}\n"
                         "proc nested {} {\n"
                         "  foreach i {1 2} {\n"
                         "    if {$i == 2} {\n"
                         "      error \"two\"\n" // line 15
                         "    }\n"
                         "  }\n"
                         "}\n"
                         "namespace eval n {\n"
                         "  proc spaced {} {\n"
                         "    expr {1 / 0}\n" // line 21
                         "  }\n"
                         "}\n"
                         "proc spaced {} {n::spaced}\n"
                         "proc loose {} {eval {return -code break}}\n"));
  EXPECT_EQ(r.messages(), Log{});
  r.set("S", "deep", true);
  EXPECT_EQ(r.messages(),
            Log{"7: Script S: invalid command name \"nothing\" (in procedure inner)"});
  r.set("S", "nested", true);
  EXPECT_EQ(r.messages(), Log{"15: Script S: two (in procedure nested)"});
  r.set("S", "spaced", true);
  EXPECT_EQ(r.messages(), Log{"21: Script S: divide by zero (in procedure spaced)"});
  r.set("S", "loose", true);
  const Log loose = r.messages();
  ASSERT_EQ(loose.size(), 1u);
  EXPECT_NE(loose[0].find("outside of a loop"), std::string::npos) << loose[0];
}

TEST_F(TclScripts, ErrorsOfTheOutermostStatementsHaveALineAndTheNextUrlIsTried) {
  W r("Script { url [ \"tcl:set a 1\nset b 2\nset c [nothing]\" \"tcl:puts second\" ] }");
  const Log messages = r.messages();
  ASSERT_EQ(messages.size(), 1u);
  EXPECT_EQ(messages[0], "4: Script: invalid command name \"nothing\"");
  EXPECT_EQ(r.printed(), Log{"second"});
}

TEST_F(TclScripts, PutsWritesLines) {
  W r(W::script("", "puts -nonewline a\nputs -nonewline stdout b\nputs c\nputs stderr d\nputs "
                    "{}\ncatch {puts other x} why; puts $why"));
  EXPECT_EQ(r.printed(), (Log{"abc", "d", "", "can not find channel named \"other\""}));
}

TEST_F(TclScripts, AfterFollowsTheClockOfTheWorld) {
  W r(W::script(
      "eventOut SFTime out eventIn SFBool go",
      "after 1500 {puts late; set out [Browser now]}\nafter 500 puts early\nset c [after 700 {puts "
      "never}]\nafter cancel $c\n"
      "after 600 {puts no}\nafter cancel {puts no}\nafter idle {puts idle}\nproc again {} {puts "
      "again; after 0 again}\n"
      "puts [llength [after info]]\nputs [after info after#1]\n"
      "proc go {} {again; catch {after 10} why; puts $why; catch {after soon x} why; puts $why}"));
  r.log("S", "out");
  EXPECT_EQ(r.printed(), (Log{"3", "{puts late; set out [Browser now]} timer"}));
  r.browser.tick(0.4);
  EXPECT_EQ(r.printed(), Log{"idle"});
  r.browser.tick(3);
  EXPECT_EQ(r.printed(), (Log{"early", "late"}));
  EXPECT_EQ(r.take(), Log{"3 S.out 3"});
  r.set("S", "go", true);
  r.printed();
  r.browser.tick(4);
  EXPECT_EQ(r.printed(), Log{"again"}); // events added while running wait for the next tick
  r.browser.tick(5);
  EXPECT_EQ(r.printed(), Log{"again"});
}

TEST_F(TclScripts, AnErrorInAfterIsToldWithItsLineAndTheRestGoesOn) {
  W r(W::script("", "after 100 {\n  set x\n}\nafter 200 {puts b}"));
  r.browser.tick(1);
  EXPECT_EQ(r.messages(), Log{"3: Script S: can't read \"x\": no such variable"});
  EXPECT_EQ(r.printed(), Log{"b"});
}

TEST_F(TclScripts, ExitEndsTheScriptOnly) {
  for (const bool trusted : {false, true}) {
    BrowserOptions options;
    options.trustScripts = trusted;
    W r(W::script("eventIn SFBool go eventOut SFInt32 out",
                  "after 100 {puts timer}\nproc go {} {set ::out 1; catch {exit 3}; puts no; set "
                  "::out 2}"),
        options);
    r.set("S", "go", true);
    EXPECT_EQ(r.printed(), Log{});
    EXPECT_EQ(r.get("S", "out"), "1");
    r.browser.tick(1);
    r.set("S", "go", true);
    EXPECT_EQ(r.printed(), Log{});
    EXPECT_EQ(r.messages(), Log{}) << trusted;
  }
}

TEST_F(TclScripts, TheSameWorldDrawsTheSameNumbers) {
  const auto numbers = [] { return W(W::script("", "puts [expr {rand()}]")).printed(); };
  EXPECT_EQ(numbers(), numbers());
}

TEST_F(TclScripts, ATrustedWorldHasAllOfTcl) {
  BrowserOptions options;
  options.trustScripts = true;
  W r(W::script("eventIn SFBool wait eventIn SFBool go",
                "puts [file exists /]\nputs [info script]\nputs [string match *8.6* [package "
                "require Tcl]]\n"
                "proc wait {} {catch {vwait ::x} why; puts $why; coroutine c apply {{} {vwait ::x; "
                "puts \"x is $::x\"}}}\n"
                "proc go {} {set ::x 5}"),
      options);
  EXPECT_EQ(r.printed(), (Log{"1", "test.wrl", "1"}));
  r.set("S", "wait", true);
  EXPECT_EQ(
      r.printed(),
      Log{"vwait would stop the world; it can wait within a coroutine: coroutine NAME COMMAND"});
  r.set("S", "go", true);
  r.browser.tick(1);
  EXPECT_EQ(r.printed(), Log{"x is 5"});
  EXPECT_EQ(r.messages(), Log{});
}

TEST_F(TclScripts, TkWithoutADisplayIsAnError) {
  BrowserOptions options;
  options.trustScripts = true;
  const char* display = getenv("DISPLAY");
  const std::string kept = display ? display : "";
  unsetenv("DISPLAY");
  W r(W::script("", "if {[catch {package require Tk} why]} {puts $why}\nputs on"), options);
  const Log printed = r.printed();
  if (display) setenv("DISPLAY", kept.c_str(), 1);
  ASSERT_EQ(printed.size(), 2u);
  EXPECT_EQ(printed[0].find("Tk cannot be used here: "), 0u) << printed[0];
  EXPECT_EQ(printed[1], "on");
}

} // namespace
} // namespace xvrml
