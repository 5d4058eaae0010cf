// ecmascript_scripts.cpp: ECMAScript programs in a world (ISO/IEC 14772-1 C.3 to C.5, C.6.2,
// C.6.3): fields, events, conversions, other nodes, the Browser object.
#include "conformance/events/ecmascript_world.h"

namespace xvrml {
namespace {

std::string script(const std::string& declared, const std::string& program) {
  return EcmaWorld::script(declared, program);
}

// --- C.3: where programs come from ---

TEST_F(EcmaScript, ServesItsSchemesFilesAndMimeTypes) {
  for (const char* url :
       {"javascript:print(1)", "vrmlscript:print(1)", "ecmascript:print(1)", "JavaScript:print(1)",
        "data:application/javascript,print(1)", "data:application/x-javascript,print(1)",
        "data:text/javascript,print(1)", "data:text/ecmascript,print(1)",
        "tests/conformance/scripts/prints.js", "tests/conformance/scripts/prints.vs"}) {
    EcmaWorld r(fmt::format("Script {{ url \"{}\" }}", url));
    EXPECT_EQ(r.takeOutput(), "1") << url;
  }
}

TEST_F(EcmaScript, TheNextUrlIsTriedWhenAProgramFails) {
  EcmaWorld r(
      "Script { url [ \"javascript:this is no program\" \"javascript:print('second')\" ] }");
  EXPECT_EQ(r.takeOutput(), "second\n2: Script: SyntaxError: " +
                                wordsOf("unterminated statement (line 1)", "expecting ';'"));
}

// --- C.4: functions ---

TEST_F(EcmaScript, AnEventCallsTheFunctionOfItsNameWithValueAndTime) {
  EcmaWorld r(script("eventIn SFFloat in eventIn SFBool other",
                     "function other(v, t) { print(v, t, typeof v) }"));
  r.browser.tick(2.5);
  r.set("S", "in", 1.0f); // no such function: nothing happens
  r.set("S", "other", true);
  EXPECT_EQ(r.takeOutput(), "true 2.5 boolean");
}

TEST_F(EcmaScript, ValuesOfAllTypesArrive) {
  EcmaWorld r("DEF G Group { } " +
              script("eventIn SFBool a eventIn SFColor b eventIn SFFloat c eventIn SFImage d "
                     "eventIn SFInt32 e eventIn SFNode f eventIn SFRotation g eventIn SFString h "
                     "eventIn SFTime i eventIn SFVec2f j eventIn SFVec3f k eventIn MFColor l "
                     "eventIn MFFloat m eventIn MFInt32 n eventIn MFNode o eventIn MFRotation p "
                     "eventIn MFString q eventIn MFTime r eventIn MFVec2f s eventIn MFVec3f t",
                     "a=b=c=d=e=f=g=h=i=j=k=l=m=n=o=p=q=r=s=t=print"));
  const NodeRef group = r.browser.node("G");
  r.set("S", "a", true);
  r.set("S", "b", Color{1, 0, 0.5f});
  r.set("S", "c", 1.5f);
  r.set("S", "d", Image{1, 2, 1, {255, 16}});
  r.set("S", "e", int32_t(-3));
  r.set("S", "f", group);
  r.set("S", "g", Rotation{0, 1, 0, 2});
  r.set("S", "h", std::string("text"));
  r.set("S", "i", 5.25);
  r.set("S", "j", Vec2f{1, 2});
  r.set("S", "k", Vec3f{1, 2, 3});
  r.set("S", "l", MFColor{{1, 0, 0}, {0, 1, 0}});
  r.set("S", "m", MFFloat{1, 2.5f});
  r.set("S", "n", MFInt32{7, 8});
  r.set("S", "o", MFNode{group, NodeRef()});
  r.set("S", "p", MFRotation{Rotation{1, 0, 0, 3}});
  r.set("S", "q", MFString{"x", "y"});
  r.set("S", "r", MFTime{1, 2});
  r.set("S", "s", MFVec2f{{1, 2}});
  r.set("S", "t", MFVec3f{{1, 2, 3}, {4, 5, 6}});
  EXPECT_EQ(r.takeOutput(), "true 0\n1 0 0.5 0\n1.5 0\n1 2 1 0xFF 0x10 0\n-3 0\nDEF G Group { } "
                            "0\n0 1 0 2 0\ntext 0\n5.25 0\n1 2 0\n"
                            "1 2 3 0\n[1 0 0, 0 1 0] 0\n[1, 2.5] 0\n[7, 8] 0\n[DEF G Group { }, "
                            "NULL] 0\n[1 0 0 3] 0\n[\"x\", \"y\"] 0\n"
                            "[1, 2] 0\n[1 2] 0\n[1 2 3, 4 5 6] 0");
}

TEST_F(EcmaScript, ValuesOfAllTypesAreSent) {
  EcmaWorld r(
      "DEF G Group { } " +
      script(
          "field SFNode g USE G eventIn SFBool go eventOut SFBool a eventOut SFColor b eventOut "
          "SFFloat c eventOut SFImage d eventOut SFInt32 e eventOut SFNode f eventOut SFRotation h "
          "eventOut SFString i eventOut SFTime j eventOut SFVec2f k eventOut SFVec3f l eventOut "
          "MFColor m eventOut MFFloat n eventOut MFInt32 o eventOut MFNode p eventOut MFRotation q "
          "eventOut MFString r eventOut MFTime s eventOut MFVec2f t eventOut MFVec3f u",
          "function go() { a = true; b = new SFColor(1, 0, 0.5); c = 1.5; d = new SFImage(1, 2, 1, "
          "new MFInt32(255, 16)); e = -3; f = g; h = new SFRotation(0, 1, 0, 2); i = 'text'; j = "
          "5.25; k = new SFVec2f(1, 2); l = new SFVec3f(1, 2, 3); m = new MFColor(new SFColor(1, "
          "0, 0)); n = new MFFloat(1, 2.5); o = new MFInt32(7, 8); p = new MFNode(g, null); q = "
          "new MFRotation(new SFRotation(1, 0, 0, 3)); r = new MFString('x', 'y'); s = new "
          "MFTime(1, 2); t = new MFVec2f(new SFVec2f(1, 2)); u = new MFVec3f(new SFVec3f(1, 2, 3)) "
          "}"));
  for (const char c : std::string("abcdefhijklmnopqrstu")) r.log("S", std::string(1, c));
  r.set("S", "go", true);
  std::string all;
  for (const std::string& event : r.take()) all += event + "\n";
  EXPECT_EQ(all, "0 S.a TRUE\n0 S.b 1 0 0.5\n0 S.c 1.5\n0 S.d 1x2x1\n0 S.e -3\n0 S.f G\n0 S.h 0 1 "
                 "0 2\n0 S.i text\n0 S.j 5.25\n0 S.k 1 2\n"
                 "0 S.l 1 2 3\n0 S.m [1 0 0]\n0 S.n [1, 2.5]\n0 S.o [7, 8]\n0 S.p [G, NULL]\n0 S.q "
                 "[1 0 0 3]\n0 S.r [x, y]\n0 S.s [1, 2]\n0 S.t [1 2]\n0 S.u [1 2 3]\n");
  EXPECT_EQ(r.takeOutput(), "");
}

TEST_F(EcmaScript, InitializeEventsProcessedShutdown) {
  EcmaWorld r(
      script("eventIn SFBool in",
             "print('program'); function initialize() { print('initialize') } function "
             "eventsProcessed() { print('processed') } function shutdown() { print('shutdown') }"));
  EXPECT_EQ(r.takeOutput(), "program\ninitialize");
  r.set("S", "in", true);
  EXPECT_EQ(r.takeOutput(), "processed");
  r.browser.replaceWorld({});
  EXPECT_EQ(r.takeOutput(), "shutdown");
}

// --- C.5.1, C.5.3: the Script's own fields and eventOuts ---

TEST_F(EcmaScript, FieldsKeepTheirValueFromCallToCall) {
  EcmaWorld r(
      script("field SFInt32 n 1 field SFVec3f v 1 2 3 field MFInt32 m [1] eventIn SFBool in",
             "this['in'] = function() { n++; v.x += 1; m[m.length] = n; print(n, v, m) }"));
  r.set("S", "in", true);
  r.set("S", "in", true);
  EXPECT_EQ(r.takeOutput(), "2 2 2 3 [1, 2]\n3 3 2 3 [1, 2, 3]");
  EXPECT_EQ(r.get("S", "n"), "3");
  EXPECT_EQ(r.get("S", "v"), "3 2 3");
  EXPECT_EQ(r.get("S", "m"), "[1, 2, 3]");
}

TEST_F(EcmaScript, OfSeveralValuesTheLastIsSentWhenTheFunctionHasReturned) {
  EcmaWorld r(script("eventIn SFBool go eventOut SFInt32 out",
                     "function go() { out = 1; out = 2; print(out); out += 5 }"));
  r.log("S", "out");
  r.set("S", "go", true);
  EXPECT_EQ(r.take(), Log{"0 S.out 7"});
  EXPECT_EQ(r.takeOutput(), "2");
}

TEST_F(EcmaScript, AComponentOrElementOfAnEventOutSendsIt) {
  EcmaWorld r(script("eventIn SFBool go eventOut SFVec3f v eventOut MFFloat m eventOut SFColor c "
                     "eventOut MFVec3f p eventOut SFVec3f same",
                     "function go() { v.x = 1; m[1] = 2; c.setHSV(0, 1, 1); p[0] = new SFVec3f(1, "
                     "1, 1); p[0].y = 5; same.x = 0 }"));
  for (const char* out : {"v", "m", "c", "p", "same"}) r.log("S", out);
  r.set("S", "go", true);
  EXPECT_EQ(r.take(),
            (Log{"0 S.v 1 0 0", "0 S.m [0, 2]", "0 S.c 1 0 0", "0 S.p [1 5 1]", "0 S.same 0 0 0"}));
  EXPECT_EQ(r.takeOutput(), "");
}

TEST_F(EcmaScript, AnEventOutReadsAsLastSent) {
  EcmaWorld r(script(
      "eventIn SFBool go eventIn SFBool ask eventOut SFVec3f v eventOut SFString s",
      "function ask() { print(v, s + '.') } function go() { v = new SFVec3f(1, 2, 3); s = 'x' }"));
  r.set("S", "ask", true);
  r.set("S", "go", true);
  r.browser.tick(1);
  r.set("S", "ask", true);
  EXPECT_EQ(r.takeOutput(), "0 0 0 .\n1 2 3 x.");
}

TEST_F(EcmaScript, AssigningToAFieldCopies) {
  EcmaWorld r(
      script("field SFVec3f f 0 0 0 field MFInt32 m []",
             "var v = new SFVec3f(1, 2, 3), a = new MFInt32(1); f = v; m = a; v.x = 9; a[0] = 9; "
             "print(f, m); var old = f; f = new SFVec3f(5, 5, 5); print(old, f)"));
  EXPECT_EQ(r.takeOutput(), "1 2 3 [1]\n1 2 3 5 5 5");
}

// C.6.2: assignments to variables from fields, eventOuts and elements copy. Objects that the
// program has created are references.
class EcmaScriptAssignments : public EcmaRows {};
TEST_P(EcmaScriptAssignments, CopyOrRefer) {
  EcmaWorld r(
      "DEF T Transform { translation 1 2 3 } " +
      script("directOutput TRUE field SFNode t USE T field SFVec3f f 1 2 3 field MFVec3f m [1 1 1, "
             "2 2 2] field MFFloat n [5, 6] field SFImage i 1 1 1 7 eventOut SFVec3f out",
             GetParam().program));
  EXPECT_EQ(r.takeOutput(), GetParam().printed) << GetParam().program;
}
constexpr EcmaRow assignments[] = {
    {"field", "", "var v = f; v.x = 9; print(f, v)", "1 2 3 9 2 3"},
    {"field_component", "", "f.x = 9; print(f)", "9 2 3"},
    {"field_later_component", "", "var v; v = f\nv.x = 9\nprint(f, v)", "1 2 3 9 2 3"},
    {"eventOut", "", "out = new SFVec3f(1, 1, 1); var v = out; v.x = 5; print(out, v)",
     "1 1 1 5 1 1"},
    {"element", "", "var v = m[1]; v.x = 9; print(m, v)", "[1 1 1, 2 2 2] 9 2 2"},
    {"element_of_variable", "",
     "var a = new MFVec3f(new SFVec3f()); var v = a[0]; v.x = 1; print(a, v)", "[0 0 0] 1 0 0"},
    {"element_index", "",
     "var k = [0, 1], v = m[k[1]], w = m[m.length - 1]; v.x = w.y = 9; print(m, v, w)",
     "[1 1 1, 2 2 2] 9 2 2 2 9 2"},
    {"list", "", "var l = n; l[0] = 9; print(n, l)", "[5, 6] [9, 6]"},
    {"image", "", "var j = i; j.x = 0; print(i.x, j.x, j.array)", "1 0 [7]"},
    {"of_a_node", "",
     "var v = t.translation; v.x = 9; print(t.translation, v); t.translation.x = 8; "
     "print(t.translation)",
     "1 2 3 9 2 3\n8 2 3"},
    {"chain_of_two", "", "var a, b; a = b = f; a.x = 9; print(f, b)", "1 2 3 9 2 3"},
    {"returned", "", "function g() { return f } var v = g(); v.x = 9; print(f, v)", "1 2 3 9 2 3"},
    {"variable", "", "var v = new SFVec3f(1, 2, 3), w = v; w.x = 9; print(v, v == w)",
     "9 2 3 true"},
    {"variable_of_list", "", "var a = new MFFloat(1), b = a; b[0] = 9; print(a, a == b)",
     "[9] true"},
    {"array_element", "", "var a = [new SFVec3f()], v = a[0]; v.x = 1; print(a[0])", "1 0 0"},
    {"argument_refers", "", "function g(v) { v.x = 9 } g(f); print(f)", "9 2 3"},
    {"local_of_the_same_name", "",
     "function g(f) { var v = f; v.x = 9; return v } var o = new SFVec3f(); g(o); print(o)",
     "9 0 0"},
    {"keeps_the_old_value", "", "var old = f; f = new SFVec3f(5, 5, 5); print(old, f)",
     "1 2 3 5 5 5"},
    {"in_texts", "", "var s = 'a = f; b = m[0]', p = /= f;/; print(s, p.test(s)) // = f;",
     "a = f; b = m[0] true"},
    {"backquote_in_a_pattern", "", "if (n) /`/.test(n); var w = n; w[0] = 7; print(n, w)",
     "[5, 6] [7, 6]"},
    {"divided", "", "var a = n[0] / 2, b = n[0]/n[1]/1; print(a, b.toFixed(2))", "2.5 0.83"},
    {"compared", "", "print(n[0] == n[0], f === f, n[1] >= n[0])", "true false true"},
    {"called", "", "var v = f\n.add(f), c = m[0].add(f); print(v, c)", "2 4 6 2 3 4"},
    {"objects", "", "var o = { a: f, b: n[0] }, w = o.b; print(o.a, w)", "1 2 3 5"},
};
INSTANTIATE_TEST_SUITE_P(AnnexC, EcmaScriptAssignments, testing::ValuesIn(assignments), rowName);

TEST_F(EcmaScript, TheProgramsOwnVariablesHideNothing) {
  EcmaWorld r(script("field SFInt32 n 1", "undeclared = 5; function f(n) { n = 7; var undeclared = "
                                          "6; return n + undeclared } print(f(0), n, undeclared)"));
  EXPECT_EQ(r.takeOutput(), "13 1 5");
}

// --- C.6.2: conversions ---

class EcmaScriptConversions : public EcmaRows {};
TEST_P(EcmaScriptConversions, OfWhatIsAssignedToAField) {
  EcmaWorld r("DEF T Transform { } " +
              script(fmt::format("field SFNode t USE T field {}", GetParam().declared),
                     fmt::format("try {{ f = {}; print(f) }} catch (e) {{ print(e.message) }}",
                                 GetParam().program)));
  EXPECT_EQ(r.takeOutput(), GetParam().printed) << GetParam().program;
}
constexpr EcmaRow conversions[] = {
    {"SFBool_number", "SFBool f FALSE", "5", "true"},
    {"SFBool_text", "SFBool f TRUE", "'FALSE'", "false"},
    {"SFBool_TRUE", "SFBool f FALSE", "TRUE", "true"},
    {"SFBool_null", "SFBool f FALSE", "null", "f: expected SFBool, got null"},
    {"SFBool_undefined", "SFBool f FALSE", "undefined", "f: expected SFBool, got undefined"},
    {"SFInt32_fraction", "SFInt32 f 0", "-3.9", "-3"},
    {"SFInt32_text", "SFInt32 f 0", "'12'", "12"},
    {"SFInt32_boolean", "SFInt32 f 0", "true", "1"},
    {"SFInt32_word", "SFInt32 f 0", "'abc'", "f: expected SFInt32, got text 'abc'"},
    {"SFInt32_NaN", "SFInt32 f 5", "0/0", "0"},
    {"SFFloat_text", "SFFloat f 0", "'2.5'", "2.5"},
    {"SFFloat_boxed", "SFFloat f 0", "new Number(2.5)", "2.5"},
    {"SFFloat_single", "SFFloat f 0", "16777217", "16777216"},
    {"SFFloat_object", "SFFloat f 0", "new SFVec3f()", "f: expected SFFloat, got SFVec3f"},
    {"SFTime_Date", "SFTime f 0", "new Date(1500)", "1.5"},
    {"SFTime_precise", "SFTime f 0", "1e9 + 0.25", "1000000000.25"},
    {"SFString_number", "SFString f \"\"", "5", "5"},
    {"SFString_boxed", "SFString f \"\"", "new String('abc')", "abc"},
    {"SFString_vector", "SFString f \"\"", "new SFVec3f(1, 2, 3)", "1 2 3"},
    {"SFString_null", "SFString f \"\"", "null", "f: expected SFString, got null"},
    {"SFString_unicode", "SFString f \"\"", "'\\u00e4\\u20ac\\ud83d\\ude00'",
     "\xc3\xa4\xe2\x82\xac\xf0\x9f\x98\x80"},
    {"SFVec3f_color", "SFVec3f f 0 0 0", "new SFColor(1, 2, 3)", "1 2 3"},
    {"SFVec3f_array", "SFVec3f f 0 0 0", "[1, 2, 3]", "1 2 3"},
    {"SFVec3f_text", "SFVec3f f 0 0 0", "'1 2 3'", "1 2 3"},
    {"SFVec3f_pair", "SFVec3f f 0 0 0", "new SFVec2f(1, 2)", "f: expected SFVec3f, got SFVec2f"},
    {"SFRotation_number", "SFRotation f 0 0 1 0", "7", "f: expected SFRotation, got number 7"},
    {"SFNode_null", "SFNode f USE T", "null", "null"},
    {"SFNode_list", "SFNode f NULL", "new MFNode(t)", "DEF T Transform { }"},
    {"SFNode_text", "SFNode f NULL", "'T'", "f: expected SFNode, got text 'T'"},
    {"SFImage_number", "SFImage f 0 0 0", "1", "f: expected SFImage, got number 1"},
    {"MFFloat_array", "MFFloat f []", "[1, '2', true]", "[1, 2, 1]"},
    {"MFFloat_number", "MFFloat f []", "1.5", "[1.5]"},
    {"MFFloat_ints", "MFFloat f []", "new MFInt32(1, 2)", "[1, 2]"},
    {"MFFloat_typed", "MFFloat f []", "new Float32Array([1, 2.5])", "[1, 2.5]"},
    {"MFInt32_floats", "MFInt32 f []", "new MFFloat(1.5, 2.5)", "[1, 2]"},
    {"MFString_text", "MFString f []", "'abc'", "[\"abc\"]"},
    {"MFString_numbers", "MFString f []", "[1, 2]", "[\"1\", \"2\"]"},
    {"MFVec3f_colors", "MFVec3f f []", "new MFColor(new SFColor(1, 0, 0))", "[1 0 0]"},
    {"MFVec3f_one", "MFVec3f f []", "new SFVec3f(1, 2, 3)", "[1 2 3]"},
    {"MFVec3f_numbers", "MFVec3f f []", "new MFFloat(1, 2, 3)",
     "f: expected SFVec3f, got number 1"},
    {"MFNode_node", "MFNode f []", "t", "[DEF T Transform { }]"},
    {"MFNode_null", "MFNode f []", "null", "[]"},
    {"MFNode_text", "MFNode f []", "'T'", "f: expected SFNode, got text 'T'"},
};
INSTANTIATE_TEST_SUITE_P(AnnexC, EcmaScriptConversions, testing::ValuesIn(conversions), rowName);

TEST_F(EcmaScript, ATextThatIsNoUtf16IsSentWithReplacements) {
  EcmaWorld r(
      script("eventIn SFBool go eventOut SFString out", "function go() { out = 'a\\ud800b' }"));
  r.set("S", "go", true);
  EXPECT_EQ(r.get("S", "out"), "a\xef\xbf\xbd"
                               "b");
  EXPECT_EQ(r.takeOutput(), "");
}

// --- C.5.2: other nodes ---

TEST_F(EcmaScript, FieldsOfOtherNodesAreReadAndSet) {
  EcmaWorld r(
      "DEF T Transform { } Shape { geometry PointSet { coord DEF C Coordinate { point [1 2 3, 4 5 "
      "6] } } } " +
      script("directOutput TRUE field SFNode t USE T field SFNode c USE C eventIn SFBool go",
             "function go() { t.set_translation = new SFVec3f(1, 2, 3); t.scale.x = 2; t.scale.y = "
             "3; print(t.translation, t.scale_changed); c.point[1].z = 9; c.point[2] = new "
             "SFVec3f(7, 7, 7); print(c.point) }"));
  r.log("T", "translation");
  r.log("T", "scale");
  r.log("C", "point");
  r.set("S", "go", true);
  EXPECT_EQ(r.take(),
            (Log{"0 T.translation 1 2 3", "0 T.scale 2 3 1", "0 C.point [1 2 3, 4 5 9, 7 7 7]"}));
  EXPECT_EQ(r.takeOutput(), "1 2 3 2 3 1\n[1 2 3, 4 5 9, 7 7 7]");
}

TEST_F(EcmaScript, AnEventInIsWrittenAnEventOutIsRead) {
  EcmaWorld r(
      "DEF G Group { } DEF K TimeSensor { loop TRUE } " +
      script("directOutput TRUE field SFNode g USE G field SFNode k USE K eventIn SFBool go",
             "function go() { g.addChildren = new MFNode(new SFNode('Shape { }'), new "
             "SFNode('Group { }')); print(g.addChildren, k.time >= 0); try { k.time = 1 } catch "
             "(e) { print(e.message) } }"));
  r.set("S", "go", true);
  EXPECT_EQ(r.takeOutput(), "undefined true\ntime cannot be written");
}

TEST_F(EcmaScript, AnObjectOfAFieldOfAnotherNodeWorksInLaterCalls) {
  EcmaWorld r("Shape { geometry PointSet { coord DEF C Coordinate { point [1 2 3] } } } " +
              script("directOutput TRUE field SFNode c USE C eventIn SFBool go",
                     "var kept = []; function go() { if (!kept.length) kept.push(c.point); else "
                     "kept[0][0].x = 5 }"));
  r.set("S", "go", true);
  r.browser.tick(1);
  r.set("S", "go", true);
  EXPECT_EQ(r.get("C", "point"), "[5 2 3]");
}

TEST_F(EcmaScript, WithoutDirectOutputEventsToOthersAreDropped) {
  EcmaWorld r(
      "DEF T Transform { } " +
      script("field SFNode t USE T",
             "function initialize() { t.translation = new SFVec3f(1, 1, 1); print('on') }"));
  EXPECT_EQ(r.get("T", "translation"), "0 0 0");
  EXPECT_EQ(r.printed(), Log{"on"});
  EXPECT_EQ(r.messages().size(), 1u);
}

TEST_F(EcmaScript, ItsOwnNodeIsAnSFNodeToo) {
  EcmaWorld r(
      "DEF S Script { directOutput TRUE field SFNode me USE S field SFInt32 n 3 eventIn SFInt32 in "
      "eventOut SFInt32 out url \"javascript: function initialize() { me.n = 4; print(n, me.n); "
      "me.in = 5; me.out = 6 } function f(){} this['in'] = function(v) { print('in', v) }\" }");
  EXPECT_EQ(r.takeOutput(), "4 4\nin 5");
  EXPECT_EQ(r.get("S", "out"), "6");
}

TEST_F(EcmaScript, NodesAreLetGo) {
  EcmaWorld r(script("eventIn SFTime go eventIn SFBool drop",
                     "var kept; function go() { kept = new SFNode('Script { url \\\"javascript: "
                     "function shutdown() { print(1) }\\\" }') } function drop() { kept = null }"));
  r.set("S", "go", 0.0);
  r.browser.tick(1);
  EXPECT_EQ(r.takeOutput(), "");
  r.set("S", "drop", true);
  r.browser.tick(2);
  EXPECT_EQ(r.takeOutput(), "1");
}

// --- C.6.3: the Browser object ---

TEST_F(EcmaScript, TheBrowserTells) {
  EcmaWorld r(script(
      "", "print(typeof Browser.getName(), Browser.getVersion() != '', Browser.getCurrentSpeed(), "
          "Browser.getCurrentFrameRate(), Browser.getWorldURL()); Browser.setDescription('about'); "
          "function initialize() { Browser.print(1, 'a'); Browser.println(2); trace(3) }"));
  EXPECT_EQ(r.takeOutput(), "string true 0 0 test.wrl\n1 a\n2\n3");
  EXPECT_EQ(r.browser.description(), "about");
}

TEST_F(EcmaScript, TheBrowserMakesNodes) {
  EcmaWorld r(
      script("eventIn MFNode made directOutput TRUE field SFNode me USE S",
             "var n = Browser.createVrmlFromString('Group { } DEF X Transform { translation 1 2 3 "
             "}'); print(n.length, n[1].translation); try { Browser.createVrmlFromString('Nonsense "
             "{') } catch (e) { print('no') } function initialize() { "
             "Browser.createVrmlFromURL(new MFString('tests/conformance/good/def-use.wrl'), me, "
             "'made') } function made(v) { print('made', v.length > 0) }"));
  Log printed = r.printed();
  ASSERT_GE(printed.size(), 2u);
  EXPECT_EQ(printed.front(), "2 1 2 3");
  EXPECT_EQ(printed.back(), "made true");
}

TEST_F(EcmaScript, TheBrowserRoutes) {
  EcmaWorld r(
      "DEF A Transform { } DEF B Transform { } " +
      script("directOutput TRUE field SFNode a USE A field SFNode b USE B eventIn SFBool on",
             "function on(v) { if (v) Browser.addRoute(a, 'translation_changed', b, "
             "'set_translation'); else deleteRoute(a, 'translation_changed', b, 'set_translation') "
             "}"));
  r.set("S", "on", true);
  r.set("A", "translation", Vec3f{1, 0, 0});
  r.set("S", "on", false);
  r.set("A", "translation", Vec3f{2, 0, 0});
  EXPECT_EQ(r.get("B", "translation"), "1 0 0");
  EXPECT_EQ(r.takeOutput(), "");
}

TEST_F(EcmaScript, TheBrowserReplacesAndLoadsWorlds) {
  EcmaWorld r(script("eventIn SFBool go",
                     "function go() { Browser.replaceWorld(Browser.createVrmlFromString('DEF N "
                     "Group { } Group { }')) }"));
  r.set("S", "go", true);
  EXPECT_EQ(r.browser.world().scope.roots.size(), 2u);
  BrowserOptions options;
  Log asked;
  options.loadUrl = [&](const Log& urls, const Log& parameters, const std::string&) {
    asked = urls;
    asked.insert(asked.end(), parameters.begin(), parameters.end());
    return true;
  };
  EcmaWorld w(script("", "function initialize() { Browser.loadURL(new MFString('a.wrl', 'b.wrl'), "
                         "new MFString('target=x')) }"),
              options);
  EXPECT_EQ(asked, (Log{"a.wrl", "b.wrl", "target=x"}));
  EXPECT_EQ(w.takeOutput(), "");
}

} // namespace
} // namespace xvrml
