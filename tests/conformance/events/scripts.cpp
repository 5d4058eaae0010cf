// scripts.cpp: Script nodes: clauses 4.12.2 to 4.12.6 and 6.40. The programs are those of the test
// engine.
#include <algorithm>

#include "conformance/events/scripted.h"

namespace xvrml {
namespace {

class Scripts : public ScriptsSomewhere {};
XVRML_SCRIPTS_SOMEWHERE(Scripts);

TEST_P(Scripts, EventsGoInAndComeOut) {
  Scripted r("DEF S Script { eventIn SFInt32 in eventOut SFInt32 out url \"test:in: echo out\" } "
             "DEF T Script { eventIn SFInt32 in field SFInt32 sum 10 eventOut SFInt32 out url "
             "\"test:in: add sum out\" } ROUTE S.out TO T.in");
  r.log("S", "out");
  r.log("T", "out");
  r.browser.tick(2);
  r.set("S", "in", 3);
  EXPECT_EQ(r.take(), (Log{"2 S.out 3", "2 T.out 13"}));
  r.set("S", "in", 4);
  EXPECT_EQ(r.take(), (Log{"2 S.out 4", "2 T.out 17"}));
  EXPECT_EQ(r.get("T", "sum"), "17");
  EXPECT_EQ(r.messages(), Log{});
}

TEST_P(Scripts, InitializeComesBeforeTheFirstEvent) {
  Scripted r("DEF C TimeSensor { loop TRUE } DEF S Script { eventIn SFTime in eventOut SFTime out "
             "url \"test:create: print create\ninitialize: print initialize\ninitialize: now "
             "out\nin: print event\" } ROUTE C.time TO S.in");
  EXPECT_EQ(r.printed(), (Log{"create", "initialize"}));
  EXPECT_EQ(r.get("S", "out"), "0");
  r.browser.tick(1);
  EXPECT_EQ(r.printed(), Log{"event"});
}

TEST_P(Scripts, AnEventOfInitializeReachesItsRoutes) {
  Scripted r("DEF S Script { eventOut SFString out url \"test:initialize: text out hello\" } DEF T "
             "Script { eventIn SFString in eventOut SFString out url \"test:initialize: print "
             "T\nin: echo out\" } ROUTE S.out TO T.in");
  EXPECT_EQ(r.printed(), Log{"T"});
  EXPECT_EQ(r.get("T", "out"), "hello");
}

TEST_P(Scripts, EventsProcessedFollowsTheEventsOfACascade) {
  const std::string program =
      "url \"test:a: print a\nb: print b\neventsProcessed: print processed\"";
  const std::string declared = "eventIn SFBool a eventIn SFBool b ";
  for (const char* must : {"TRUE", "FALSE"}) {
    Scripted r("DEF V Viewpoint {} DEF S Script { mustEvaluate " + std::string(must) + " " +
               declared + program + " } ROUTE V.isBound TO S.a ROUTE V.isBound TO S.b");
    r.printed();
    r.set("V", "set_bind", false);
    EXPECT_EQ(r.printed(), (Log{"a", "b", "processed"})) << must;
  }
}

TEST_P(Scripts, WithoutMustEvaluateEventsWaitForTheEndOfTheCascade) {
  const auto order = [](const char* must) {
    Scripted r(
        fmt::format("DEF A Script {{ eventIn SFBool in url \"test:in: print A\" mustEvaluate {} }} "
                    "DEF B Script {{ eventIn SFBool in url \"test:in: print B\" mustEvaluate TRUE "
                    "}} DEF V Viewpoint {{}} ROUTE V.isBound TO A.in ROUTE V.isBound TO B.in",
                    must));
    r.printed();
    r.set("V", "set_bind", false);
    return r.printed();
  };
  EXPECT_EQ(order("FALSE"), (Log{"B", "A"}));
  EXPECT_EQ(order("TRUE"), (Log{"A", "B"}));
}

TEST_P(Scripts, AnEventOutSendsOnceInACascade) {
  Scripted r(
      "DEF S Script { mustEvaluate TRUE eventIn SFInt32 a eventIn SFInt32 b eventOut SFInt32 out "
      "url \"test:a: echo out\nb: echo out\" } DEF T Script { eventIn SFInt32 in eventOut SFInt32 "
      "out url \"test:in: echo out\" } ROUTE T.out TO S.a ROUTE T.out TO S.b");
  r.log("S", "out");
  r.set("T", "in", 1);
  EXPECT_EQ(r.take(), Log{"0 S.out 1"});
}

TEST_P(Scripts, OfSeveralValuesInOneFunctionTheLastOneIsSent) {
  Scripted r("DEF S Script { eventIn SFBool in eventOut SFString out url \"test:in: text out "
             "one\nin: text out two\" }");
  r.log("S", "out");
  r.set("S", "in", true);
  EXPECT_EQ(r.take(), Log{"0 S.out two"});
}

TEST_P(Scripts, EventsToOtherNodesNeedDirectOutput) {
  const auto world = [](const char* direct) {
    return fmt::format("DEF T Transform {{}} DEF S Script {{ directOutput {} field SFNode to USE T "
                       "eventIn SFVec3f in url \"test:in: post to set_translation\" }}",
                       direct);
  };
  Scripted refused(world("FALSE"));
  refused.set("S", "in", Vec3f{1, 2, 3});
  EXPECT_EQ(refused.get("T", "translation"), "0 0 0");
  EXPECT_EQ(refused.printed(), Log{"post: 4 an event to another node needs directOutput TRUE"});
  EXPECT_EQ(refused.messages(), Log{"2: Script S: an event to another node needs directOutput TRUE "
                                    "(6.40); ignored, --compat scripts allows it"});
  refused.set("S", "in", Vec3f{1, 2, 3});
  EXPECT_EQ(refused.messages(), Log{}); // reported once
  Scripted allowed(world("TRUE"));
  EXPECT_TRUE(reaches(allowed.node("T"), Change::transform));
  EXPECT_EQ(reachReason(allowed.node("T"), Change::transform), "Script field to");
  EXPECT_FALSE(reaches(refused.node("S"), Change::transform));
  allowed.set("S", "in", Vec3f{1, 2, 3});
  EXPECT_EQ(allowed.get("T", "translation"), "1 2 3");
  EXPECT_EQ(allowed.messages(), Log{});
}

TEST_P(Scripts, ReadsTheFieldsOfNodesItKnows) {
  Scripted r(
      "DEF T Transform { translation 1 2 3 } DEF S Script { field SFNode to USE T eventIn SFBool a "
      "eventIn SFBool b eventIn SFBool c eventOut SFVec3f out eventOut SFBool no url \"test:a: "
      "read to translation out\na: read to translation_changed out\nb: read to bboxCenter out\n"
      "c: read self directOutput no\nc: read to out out\" }");
  r.set("S", "a", true);
  EXPECT_EQ(r.get("S", "out"), "1 2 3");
  r.set("S", "b", true);
  r.set("S", "c", true);
  EXPECT_EQ(r.get("S", "no"), "FALSE");
  EXPECT_EQ(r.printed(), (Log{"read: 2 Transform has no exposedField or eventOut 'bboxCenter'",
                              "read: 2 Transform has no exposedField or eventOut 'out'"}));
}

TEST_P(Scripts, NodesAreDescribed) {
  Scripted r("DEF T Group {} DEF S Script { field SFNode to USE T eventIn SFBool in url \"test:in: "
             "describe to\nin: find to set_children\nin: find to nothing\" }");
  r.set("S", "in", true);
  EXPECT_EQ(r.printed(),
            (Log{"Group 'T'", "eventIn 15 addChildren", "eventIn 15 removeChildren",
                 "exposedField 15 children", "field 11 bboxCenter", "field 11 bboxSize",
                 "exposedField 1 bboxDisplay", "exposedField 1 visible", "exposedField 6 metadata",
                 "set_children is 15 children", "find: 2 Group has no field or event 'nothing'"}));
}

TEST_P(Scripts, HandlesEndWithTheCallUnlessRetained) {
  Scripted r("DEF T Transform {} DEF S Script { directOutput TRUE eventIn SFNode keep eventIn "
             "SFNode borrow eventIn SFBool drop eventIn SFVec3f in url \"test:keep: keep\nborrow: "
             "borrow\ndrop: drop\nin: post kept set_translation\" }");
  r.set("S", "borrow", r.browser.node("T"));
  r.set("S", "in", Vec3f{1, 0, 0});
  EXPECT_EQ(r.get("T", "translation"), "0 0 0");
  ASSERT_EQ(r.printed().size(), 1u); // it has no access to that node
  r.set("S", "keep", r.browser.node("T"));
  r.set("S", "in", Vec3f{1, 0, 0});
  EXPECT_EQ(r.get("T", "translation"), "1 0 0");
  r.set("S", "drop", true);
  r.set("S", "in", Vec3f{2, 0, 0});
  EXPECT_EQ(r.get("T", "translation"), "1 0 0");
  r.set("S", "drop", true);
  EXPECT_EQ(r.printed().size(), 2u);
  r.set("S", "keep", NodeRef());
  EXPECT_EQ(r.printed(), Log{"keep: 1 no node 0"});
}

TEST_P(Scripts, WrongValuesAreRefused) {
  Scripted r("DEF S Script { eventIn SFBool in eventOut MFString out url \"test:in: wrong out\" }");
  r.log("S", "out");
  r.set("S", "in", true);
  EXPECT_EQ(r.take(), Log{});
  EXPECT_EQ(
      r.printed(),
      (Log{"wrong: 3 out: expected MFString, got SFInt32", "wrong: 3 out: no value",
           "wrong: 3 out: a value without data", "wrong: 3 out: a text that is not UTF-8",
           "wrong: 3 out: a text without characters",
           "wrong: 2 Script has no eventOut 'noSuchEvent'", "wrong: 2 Script has no eventOut ''",
           "wrong: 1 the Script does not know a node 123456789",
           "wrong: 1 the Script does not know a node 123456789"}));
}

TEST_P(Scripts, AProgramThatDoesNotEndIsStopped) {
  BrowserOptions options;
  options.scriptSteps = 100'000;
  Scripted r("DEF S Script { eventIn SFBool in eventIn SFInt32 other eventOut SFInt32 out url "
             "\"test:in: loop\nother: echo out\nshutdown: print bye\" }",
             options);
  r.set("S", "in", true);
  EXPECT_EQ(r.messages(), Log{"2: Script S: event took too long: the Script is stopped"});
  r.log("S", "out");
  r.set("S", "other", 1);
  EXPECT_EQ(r.take(), Log{});
  r.set("S", "url", MFString{"test:other: echo out"}); // the new program starts from the beginning
  EXPECT_EQ(r.printed(), Log{"bye"});
  r.set("S", "other", 1);
  EXPECT_EQ(r.take(), Log{"0 S.out 1"});
}

TEST_P(Scripts, ErrorsSayFileAndLine) {
  Scripted r("\nDEF S Script {\n eventIn SFBool in eventIn SFBool plain\n url [ \"none:\"\n\n  "
             "\"test:\nin: error 2 went\\\\wrong\nplain: fail\" ]\n}");
  r.messages();
  r.set("S", "in", true);
  r.set("S", "plain", true);
  // The program begins in line 7 of the file; its second line is line 8.
  EXPECT_EQ(r.messages(), (Log{"8: Script S: went\\wrong", "3: Script S: event failed"}));
  EXPECT_EQ(r.browser.world().diagnostics.list().back().file, "test.wrl");
}

TEST_P(Scripts, AMissingEngineIsToldOnceForEachProtocol) {
  Scripted r("Script { url \"lisp:a\" } Script { url \"Lisp:b\" } DEF S Script { eventIn SFBool in "
             "url [ \"x.class\" \"prolog:c\" ] } Script { url [ \"prolog:d\" \"test:initialize: "
             "print d\" ] } Script {}");
  const Log messages = r.messages();
  ASSERT_EQ(messages.size(), 3u) << messages[0];
  EXPECT_EQ(messages[0].find("2: Script: no script engine for 'lisp:' is installed (looked in: "),
            0u)
      << messages[0];
  EXPECT_NE(messages[1].find("Java Scripts are not supported"), std::string::npos);
  EXPECT_NE(messages[2].find("'prolog:'"), std::string::npos);
  EXPECT_EQ(r.printed(), Log{"d"}); // the first URL that can be run
  r.set("S", "in", true);           // silent
}

TEST_P(Scripts, AnEngineThatNeedsTrustRunsInTrustedWorldsOnly) {
  const std::string world = "Script { url \"trusted-test:initialize: print x\" }";
  Scripted refused(world);
  EXPECT_EQ(refused.printed(), Log{});
  ASSERT_EQ(refused.messages().size(), 1u);
  BrowserOptions options;
  options.trustScripts = true;
  Scripted trusted(world, options);
  EXPECT_EQ(trusted.printed(), Log{"x"});
}

TEST_P(Scripts, ShutdownComesWhenANodeIsGone) {
  Scripted r("DEF G Group {}");
  r.set("G", "children",
        r.browser.createVrmlFromString(
            "Script { field SFString a \"x\" eventOut SFString b eventOut SFString c url "
            "\"test:initialize: print begins\nshutdown: print ends\nshutdown: read self a "
            "c\nshutdown: text b more\" }"));
  EXPECT_EQ(r.printed(), Log{"begins"});
  EXPECT_EQ(r.get("G", "children"), "[Script]");
  r.set("G", "children", MFNode{});
  EXPECT_EQ(r.printed(), (Log{"ends", "read: 4 the Script is being shut down",
                              "text: 4 the Script is being shut down"}));
}

TEST_P(Scripts, ShutdownComesAtTheEndOfTheWorld) {
  auto lines = std::make_shared<Log>();
  BrowserOptions options = scriptOptions();
  options.print = [lines](const std::string& text) { lines->push_back(text); };
  {
    Running r("Script { url \"test:shutdown: print a\" } Script { url \"test:shutdown: print b\" }",
              0, options);
  }
  EXPECT_EQ(*lines, (Log{"a", "b"}));
}

TEST_P(Scripts, RoutesAreAddedAndDeleted) {
  const auto world = [](const char* direct) {
    return fmt::format("DEF A Transform {{}} DEF B Transform {{}} DEF S Script {{ directOutput {} "
                       "field SFNode a USE A field SFNode b USE B eventIn SFBool add eventIn "
                       "SFBool delete url \"test:add: addRoute a translation b "
                       "translation\ndelete: deleteRoute a translation b translation\" }}",
                       direct);
  };
  Scripted r(world("TRUE"));
  r.set("S", "add", true);
  r.set("A", "translation", Vec3f{1, 0, 0});
  EXPECT_EQ(r.get("B", "translation"), "1 0 0");
  r.set("S", "delete", true);
  r.set("A", "translation", Vec3f{2, 0, 0});
  EXPECT_EQ(r.get("B", "translation"), "1 0 0");
  Scripted refused(world("FALSE"));
  refused.set("S", "add", true);
  EXPECT_EQ(refused.printed(), Log{"addRoute: 4 a change of routes needs directOutput TRUE"});
}

TEST_P(Scripts, TickComesWithTime) {
  Scripted r("DEF S Script { eventOut SFTime out url \"test:tick: now out\" }");
  r.log("S", "out");
  r.browser.tick(1);
  r.browser.tick(1.5);
  EXPECT_EQ(r.take(), (Log{"1 S.out 1", "1.5 S.out 1.5"}));
}

// No interpreter is called while another one is running.
TEST_P(Scripts, WhatTickMakesBeginsAfterIt) {
  Scripted r("DEF S Script { eventOut MFNode out url \"test:tick: create out Script { url "
             "\\\"test:initialize: print child\\\" }\n"
             "tick: print made\" }");
  r.browser.tick(1);
  EXPECT_EQ(r.printed(), (Log{"made", "child"}));
}

// The functions of the ABI about scenes (xscript.h, 1.2 to 1.4), here and in a process.
TEST_P(Scripts, ScenesAndNodesSayWhatTheyAre) {
  Scripted r("PROTO Ball [ ] { Group { } }\nDEF T Transform { children DEF G Group { } }\n"
             "DEF S Script { field SFNode t USE T url \"test:initialize: scene roots\n"
             "initialize: scene named G\ninitialize: scene named X\ninitialize: scene facts\n"
             "initialize: scene instance Ball\ninitialize: scene instance Box\n"
             "initialize: scene within t G\ninitialize: scene within t T\n"
             "initialize: scene within t S\ninitialize: scene types self\n"
             "initialize: scene types none\ninitialize: scene text self XML\n"
             "initialize: scene text t JPEG\ninitialize: scene file t VRML\" }");
  const Log printed = r.printed();
  ASSERT_EQ(printed.size(), 14u) << fmt::format("{}", fmt::join(printed, "\n"));
  EXPECT_EQ(printed[0], "roots Transform:T Script:S");
  EXPECT_EQ(printed[1], "named Group:G");
  EXPECT_EQ(printed[2], "scene: 1 the scene has no node 'X'");
  EXPECT_EQ(printed[3].find("facts 2.0 VRML "), 0u) << printed[3];
  EXPECT_EQ(printed[4], "instance Ball:");
  EXPECT_EQ(printed[5], "scene: 1 the scene has no prototype 'Box'");
  EXPECT_EQ(printed[6], "within Group:G");
  EXPECT_EQ(printed[7], "within Transform:T");
  EXPECT_EQ(printed[8], "scene: 1 no node 'S' in the scene");
  EXPECT_EQ(printed[9], "types X3DNode X3DChildNode X3DScriptNode");
  EXPECT_EQ(printed[10], "scene: 1 NULL");
  EXPECT_EQ(printed[11].find("text <Script DEF='S'"), 0u) << printed[11];
  EXPECT_EQ(printed[12], "scene: 6 'JPEG' is no encoding: expected XML or VRML");
  EXPECT_EQ(printed[13].find("file #VRML V2.0 utf8\n\nDEF T Transform {"), 0u) << printed[13];
}

TEST_P(Scripts, RunawayPostsEndWithAMessage) {
  BrowserOptions options;
  options.maximumEvents = 1000;
  Scripted r("DEF S Script { mustEvaluate TRUE eventIn SFBool in url \"test:in: post self in\" }",
             options);
  r.set("S", "in", true);
  EXPECT_EQ(r.messages(), Log{"0: more than 1000 events at time 0: the rest is dropped"});
  r.set("S", "in", true);
}

TEST_P(Scripts, BadPluginsAreRefusedWithTheReason) {
  BrowserOptions options;
  options.scriptPath = XVRML_BAD_SCRIPTS;
  Scripted r("Script { url \"broken:x\" }", options);
  const Log messages = r.messages();
  const auto told = [&](const char* library, const char* reason) {
    return std::any_of(messages.begin(), messages.end(), [&](const std::string& m) {
      return m.find(std::string(library) + ".so: ") != m.npos && m.find(reason) != m.npos;
    });
  };
  EXPECT_TRUE(told("missing_symbol", "exports no xsPlugin"));
  EXPECT_TRUE(told("small_symbol", "its xsPlugin has 4 bytes"));
  EXPECT_TRUE(told("wrong_magic", "wrong magic number"));
  EXPECT_TRUE(told("other_major", "made for script ABI 2.0; this library has 1.0"));
  EXPECT_TRUE(told("newer_minor", "made for script ABI 1.1; this library has 1.0"));
  EXPECT_TRUE(told("plugin_size", "claims a plug-in structure of 8 bytes"));
  EXPECT_TRUE(told("engine_size", "claims an engine structure of 40 bytes"));
  EXPECT_TRUE(told("no_create", "lacks the function create"));
  EXPECT_EQ(messages.size(), 9u); // and that there is no engine
}

TEST_P(Scripts, AProgramComesFromADataUrl) {
  Scripted r("Script { url \"data:text/x-test,initialize:%20print%20plain\" } Script { url "
             "\"data:Text/X-Test;base64,aW5pdGlhbGl6ZTogcHJpbnQgYmFzZTY0\" } Script { url [ "
             "\"data:text/x-other,x\" \"data:;base64,*\" ] }");
  EXPECT_EQ(r.printed(), (Log{"plain", "base64"}));
  const Log messages = r.messages();
  ASSERT_EQ(messages.size(), 2u);
  EXPECT_NE(messages[0].find("'data:text/x-other'"), std::string::npos);
  EXPECT_NE(messages[1].find("not base64"), std::string::npos);
}

TEST_P(Scripts, AProgramComesFromAFile) {
  const auto world = loadWorld("tests/conformance/good/script-from-file.wrl");
  EXPECT_EQ(world->diagnostics.warnings(), 0u);
  BrowserOptions options = scriptOptions();
  Log lines;
  options.print = [&](const std::string& text) { lines.push_back(text); };
  Browser browser(loadWorld("tests/conformance/good/script-from-file.wrl"), options);
  EXPECT_EQ(lines, Log{"read from a file"});
  browser.set(*browser.node("S"), "in", true);
  const Diagnostic& last = browser.world().diagnostics.list().back();
  EXPECT_EQ(last.file, "tests/conformance/good/library/program.test");
  EXPECT_EQ(last.line, 2u);
}

} // namespace
} // namespace xvrml
