// tcl_limits.cpp: actions that Tcl Scripts of untrusted worlds cannot do, and how endless ones are
// stopped. In this process; the separate process in which they usually run has tests of its own.
#include <clocale>
#include <csignal>

#include "conformance/events/tcl_world.h"

namespace xvrml {
namespace {

class TclLimits : public Tcl {};
using W = TclWorld;

TEST_F(TclLimits, WhatReachesOutIsRefusedByName) {
  const char* const forbidden[] = {"open /etc/passwd",
                                   "socket localhost 80",
                                   "exec ls",
                                   "source x.tcl",
                                   "load x.so",
                                   "cd /",
                                   "pwd",
                                   "glob *",
                                   "file exists /",
                                   "file delete x",
                                   "file mkdir x",
                                   "file normalize .",
                                   "chan open x",
                                   "chan pipe",
                                   "chan create r x",
                                   "chan names",
                                   "vwait x",
                                   "update",
                                   "update idletasks",
                                   "interp create",
                                   "interp invokehidden {} open x",
                                   "interp expose {} open",
                                   "encoding system",
                                   "encoding dirs",
                                   "fconfigure stdout",
                                   "fileevent stdin readable x",
                                   "fcopy a b",
                                   "gets stdin",
                                   "read stdin",
                                   "close stdout",
                                   "flush stdout",
                                   "seek stdin 0",
                                   "tell stdin",
                                   "eof stdin",
                                   "fblocked stdin",
                                   "unload x",
                                   "pid",
                                   "package require Tk",
                                   "package require http",
                                   "package ifneeded x 1 y",
                                   "info nameofexecutable",
                                   "info hostname",
                                   "info library",
                                   "info script",
                                   "info loaded",
                                   "info sharedlibextension",
                                   "clock format 0",
                                   "clock scan now",
                                   "zlib compress x",
                                   "oo::class create c",
                                   "tk appname",
                                   "button .b",
                                   "set env(PATH)",
                                   "set ::tcl_library",
                                   "set ::auto_path",
                                   "auto_load x",
                                   "unknown x",
                                   "::tcl::chan::pipe",
                                   "::tcl::chan::names",
                                   "::tcl::file::exists /",
                                   "::tcl::clock::getenv HOME",
                                   "::tcl::info::nameofexecutable",
                                   "::tcl::info::hostname",
                                   "::tcl::encoding::dirs",
                                   "::tcl::unsupported::assemble {push x}",
                                   "::tcl::pkgconfig list",
                                   "tcl:file:exists /",
                                   "thread::create",
                                   "namespace eval ::tcl::file {exists /}",
                                   "memory info",
                                   "dde x",
                                   "registry get x",
                                   "after 10"};
  std::string program = "proc go {} {\n";
  for (const char* command : forbidden)
    program += std::string("if {![catch {uplevel #0 {") + command +
               "}} why]} {puts {LET THROUGH: " + command + "}}\n";
  program += "puts done}";
  W r(W::script("eventIn SFBool go", program));
  r.set("S", "go", true);
  EXPECT_EQ(r.printed(), Log{"done"});
  EXPECT_EQ(r.messages(), Log{});
}

TEST_F(TclLimits, RefusalsSayWhy) {
  W r(W::script("", "foreach c {{open x} {exec ls} {socket a 1} {vwait x} {package require Tk}} "
                    "{catch $c why; puts $why}"));
  EXPECT_EQ(r.printed(), (Log{"open: allowed only in a trusted world (vv --trust)",
                              "exec: allowed only in a trusted world (vv --trust)",
                              "socket: allowed only in a trusted world (vv --trust)",
                              "vwait: allowed only in a trusted world (vv --trust)",
                              "package Tk: allowed only in a trusted world (vv --trust)"}));
}

TEST_F(TclLimits, WhatComputesIsThere) {
  W r(W::script("",
                "package require Tcl 8.6\nputs [lsort -integer {3 1 2}][dict get {a b} a][string "
                "toupper x][format %03d 7][expr {2**10}]"
                "[regsub a bab c][clock seconds]\nnamespace eval n {variable v 1}\ncoroutine c "
                "apply {{} {yield 1; yield 2}}; puts [c]\n"
                "puts [binary encode hex ab][llength [info commands]][apply {x {incr x}} 1][expr "
                "{max(1, 3.5, 2) + min(4, 2)}]\nputs [try {error a} on error m {set m}]"));
  EXPECT_EQ(r.printed().size(), 4u);
  EXPECT_EQ(r.messages(), Log{});
}

// Each of these would run forever.
TEST_F(TclLimits, ProgramsThatDoNotEndAreStopped) {
  const char* const programs[] = {
      "while 1 {set x 1}",
      "while 1 {}",
      "for {} 1 {} {}",
      "while 1 {catch {while 1 {}}}",
      "proc f {} {catch f; f}\nwhile 1 {catch f}",
      "while 1 {try {while 1 {set x 1}} finally {while 1 {}}}",
      "while 1 {catch {error x}}",
      "coroutine c apply {{} {while 1 {yield}}}\nwhile 1 c",
      "set l {}\nwhile 1 {lappend l 1; set l {}}",
      "proc unwind {} {while 1 {catch {unwind2} m o}}\nproc unwind2 {} {while 1 {set x 1}}\nunwind",
      "trace add variable x write {apply {args {while 1 {set y 1}}}}\nset x 1",
      "while 1 {catch {$::self get url}}",
      "proc ever {} {tailcall ever}\never"};
  for (const char* program : programs) {
    BrowserOptions options;
    options.scriptSteps = 300'000;
    options.scriptSeconds = 0.3;
    W r(W::script("eventIn SFBool go eventIn SFBool again eventOut SFInt32 out",
                  "proc go {} {" + std::string(program) +
                      "}\nproc again {} {puts alive}\nproc shutdown {} {puts bye}",
                  "DEF T Script { eventIn SFBool go url \"tcl:proc go {} {puts other}\" }"),
        options);
    r.set("S", "go", true);
    EXPECT_EQ(r.messages(), Log{"2: Script S: event took too long: the Script is stopped"})
        << program;
    r.set("S", "again", true);
    r.browser.tick(1);
    EXPECT_EQ(r.printed(), Log{}) << program;
    r.set("T", "go", true);
    EXPECT_EQ(r.printed(), Log{"other"}) << program;
  }
}

TEST_F(TclLimits, TheOutermostStatementsAreBoundedToo) {
  BrowserOptions options;
  options.scriptSeconds = 0.3;
  W r("DEF S Script { url \"tcl:while 1 {set x 1}\" }", options);
  EXPECT_EQ(r.messages(), Log{"2: Script S: create took too long: the Script is stopped"});
}

TEST_F(TclLimits, StepsAreTheSameOnAnyMachine) {
  const auto until = [] {
    BrowserOptions options;
    options.scriptSteps = 100'000;
    W r(W::script("eventIn SFBool go field SFInt32 n 0", "proc go {} {while 1 {incr ::n}}"),
        options);
    r.set("S", "go", true);
    return r.get("S", "n");
  };
  EXPECT_EQ(until(), until());
}

TEST_F(TclLimits, RecursionIsAnError) {
  W r(W::script("eventIn SFBool go eventIn SFBool again",
                "proc f n {f [expr {$n + 1}]}\nproc go {} {f 0}\nproc again {} {catch {f 0} why; "
                "puts $why}"));
  r.set("S", "go", true);
  const Log messages = r.messages();
  ASSERT_EQ(messages.size(), 1u);
  EXPECT_EQ(messages[0],
            "2: Script S: too many nested evaluations (infinite loop?) (in procedure f)");
  r.set("S", "again", true);
  EXPECT_EQ(r.printed(), Log{"too many nested evaluations (infinite loop?)"});
}

// Nested brackets are another matter: Tcl's own stack overflows, which ends the process of the
// scripts.
TEST_F(TclLimits, TextsNestedDeeplyDoNotOverflow) {
  W r(W::script(
      "eventIn SFBool go",
      "proc go {} {\n catch {eval [string repeat {[set x } 1000][string repeat \\] 1000]}\n"
      " catch {expr [string repeat ( 30000]}\n catch {expr [string repeat - 30000]1}\n set l x\n"
      " for {set i 0} {$i < 30000} {incr i} {set l [list $l]}\n unset l\n puts done\n}"));
  r.set("S", "go", true);
  EXPECT_EQ(r.printed(), Log{"done"});
}

TEST_F(TclLimits, AfterIsBounded) {
  W r(W::script("", "if {[catch {while 1 {after 100000 x}} why]} {puts $why}"));
  EXPECT_EQ(r.printed(), Log{"after: more than 10000 scripts are waiting"});
}

TEST_F(TclLimits, ATimerThatDoesNotEndIsStopped) {
  BrowserOptions options;
  options.scriptSteps = 100'000;
  W r(W::script("", "after 100 {while 1 {set x 1}}\nafter 200 {puts no}"), options);
  r.browser.tick(1);
  EXPECT_EQ(r.messages(), Log{"2: Script S: tick took too long: the Script is stopped"});
  r.browser.tick(2);
  EXPECT_EQ(r.printed(), Log{});
}

TEST_F(TclLimits, TrustedProgramsAreStoppedToo) {
  BrowserOptions options;
  options.scriptSteps = 100'000;
  options.trustScripts = true;
  W r(W::script("eventIn SFBool go", "proc go {} {while 1 {catch {set x 1}}}"), options);
  r.set("S", "go", true);
  EXPECT_EQ(r.messages(), Log{"2: Script S: event took too long: the Script is stopped"});
}

TEST_F(TclLimits, TheHostKeepsItsSignalsAndItsLocale) {
  const auto before = signal(SIGPIPE, SIG_DFL);
  W r(W::script("", "puts x"));
  const auto after = signal(SIGPIPE, before);
  EXPECT_EQ(after, SIG_DFL);
  EXPECT_STREQ(setlocale(LC_ALL, nullptr), "C");
}

} // namespace
} // namespace xvrml
