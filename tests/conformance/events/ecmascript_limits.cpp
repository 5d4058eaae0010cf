// ecmascript_limits.cpp: failures of ECMAScript programs: positions of errors, limits, and
// everything a program must not reach.
#include "conformance/events/ecmascript_world.h"

namespace xvrml {
namespace {

std::string script(const std::string& declared, const std::string& program) {
  return EcmaWorld::script(declared, program);
}

// --- Errors name the world's line and the function ---

TEST_F(EcmaScript, ErrorsNameTheLineAndTheFunction) {
  const struct {
    const char* program;
    std::string message;
  } cases[] = {
      {"\n\nvar x = ;",
       "4: Script S: SyntaxError: " + wordsOf("empty expression not allowed (line 3, end of input)",
                                              "unexpected token in expression: ';'")},
      {"function initialize() {\n  helper();\n}\nfunction helper() {\n  var o;\n  o.x = 1;\n}",
       "7: Script S: TypeError: cannot " + wordsOf("write", "set") +
           " property 'x' of undefined (in helper)"},
      {"\nfunction initialize() { new SFVec3f(1, 2, 3).add(5) }",
       "3: Script S: TypeError: add: expected SFVec3f, got number 5 (in initialize)"},
      {"function initialize() {\n throw 'words' }", "2: Script S: words (in initialize)"},
      {"function initialize() {\n throw new Error('mine') }",
       "3: Script S: Error: mine (in initialize)"},
      {"noSuchFunction(1)",
       "2: Script S: ReferenceError: " +
           wordsOf("identifier 'noSuchFunction' undefined", "'noSuchFunction' is not defined")},
      {"var a = 'open\nclose'",
       "2: Script S: SyntaxError: " +
           wordsOf("unterminated string (line 1)", "unexpected end of string")},
  };
  for (const auto& one : cases) {
    EcmaWorld r(script("", one.program));
    const Log messages = r.messages();
    ASSERT_GE(messages.size(), 1u) << one.program;
    EXPECT_EQ(messages[0], one.message);
  }
}

TEST_F(EcmaScript, AnErrorEndsTheFunctionNotTheScript) {
  EcmaWorld r(script("eventIn SFInt32 n eventOut SFInt32 out",
                     "function n(v) { out = v; if (v == 1) boom(); print(v) }"));
  r.log("S", "out");
  for (const int v : {0, 1, 2}) r.set("S", "n", int32_t(v));
  EXPECT_EQ(r.printed(), (Log{"0", "2"}));
  EXPECT_EQ(r.messages().size(), 1u);
  EXPECT_EQ(r.take().size(), 3u); // values assigned before the error are sent
}

// --- Secrets ---

TEST_F(EcmaScript, TextsOfFunctionsTellNoAddress) {
  EcmaWorld r(script("", "var v = new SFVec3f(); var all = [v.add, Math.random, Date, SFVec3f, "
                         "Browser.getName, print, Math.sin];"
                         "for (var i = 0; i < all.length; i++) "
                         "print(/[0-9a-f]{6}/.test(String(all[i]) + all[i].name));"));
  EXPECT_EQ(r.printed(), Log(7, "false"));
}

// --- Limits ---

TEST_F(EcmaScript, ABombOfMemoryIsAnError) {
  BrowserOptions options;
  options.scriptMemory = 8 << 20;
  options.scriptSeconds = 60; // a busy machine needs long to fill it
  for (const char* program :
       {"var s = 'x'; for (;;) s += s;", "var a = []; for (;;) a.push(new SFVec3f());",
        "var m = new MFVec3f(); m.length = 15000000;",
        "var m = new MFString(); for (;;) m.push('text' + m.length);", "new Uint8Array(1e9);",
        "var o = {}; for (var i = 0;; i++) o['k' + i] = i;"}) {
    EcmaWorld r(
        script("eventIn SFBool go eventIn SFBool ask",
               std::string("function go() { ") + program + " } function ask() { print('alive') }"),
        options);
    r.set("S", "go", true);
    const Log messages = r.messages();
    ASSERT_EQ(messages.size(), 1u) << program;
    EXPECT_TRUE(messages[0].find("alloc") != std::string::npos ||
                messages[0].find("memory") != std::string::npos ||
                messages[0].find("resize") != std::string::npos ||
                messages[0].find("too long") != std::string::npos)
        << messages[0];
    const bool ends = messages[0].find("the Script ends") != std::string::npos;
    EXPECT_LE(ends, runsEs2020()) << program;
    r.set("S", "ask", true);
    EXPECT_EQ(r.printed(), ends ? Log{} : Log{"alive"}) << program;
  }
}

TEST_F(EcmaScript, TooLittleMemoryForAnInterpreterIsAMessage) {
  for (const uint64_t bytes : {1u << 10, 60u << 10, 100u << 10, 120u << 10, 130u << 10}) {
    BrowserOptions options;
    options.scriptMemory = bytes;
    EcmaWorld r(script("", "print('here')"), options);
    const std::string told = r.takeOutput();
    EXPECT_TRUE(told == "here" || told.find("memory") != std::string::npos ||
                told.find("alloc") != std::string::npos)
        << bytes << ": " << told;
  }
}

TEST_F(EcmaScript, DeepRecursionIsAnError) {
  std::string nested = "1";
  for (int i = 0; i < 20'000; ++i) nested = "(" + nested + ")";
  for (const std::string& program :
       {std::string("function f() { return 1 + f(); } f()"),
        std::string("var o = { toString: function() { return '' + o; } }; '' + o"),
        std::string(
            "var a = []; a[0] = a; for (var i = 0; i < 5000; i++) a = [a]; JSON.stringify(a)"),
        std::string("eval('" + nested + "')"),
        std::string("var m = new MFFloat(); function v() { return { valueOf: function() { m[0] = "
                    "v(); return 1 } } } m[0] = v()"),
        std::string("/(((((((((((((((((((((((((a*)*)*)*)*)*)*)*)*)*)*)*)*)*)*)*)*)*)*)*)*)*)*)*)*b/"
                    ".test('c')"),
        std::string("[1,2].sort(function s() { return [1,2].sort(s) })")}) {
    EcmaWorld r(script("", "try { " + program + " } catch (e) { print(e.name) }"));
    const Log printed = r.printed();
    EXPECT_LE(printed.size(), 1u) << program.substr(0, 60);
    if (printed.empty()) continue;
    EXPECT_TRUE(printed[0] == "RangeError" || printed[0] == "TypeError" ||
                printed[0] == "SyntaxError" || printed[0] == "InternalError")
        << printed[0];
  }
}

TEST_F(EcmaScript, ALoopThatCallsTheHostIsStopped) {
  BrowserOptions options;
  options.scriptSteps = 100'000;
  EcmaWorld r(script("eventIn SFBool go eventOut SFInt32 out",
                     "function go() { out = 1; for (;;) { try { Browser.getCurrentSpeed() } catch "
                     "(e) { if (!once) throw e; once = 0 } } } var once = 1"),
              options);
  r.log("S", "out");
  r.set("S", "go", true);
  ASSERT_EQ(r.messages().size(), 1u);
  EXPECT_EQ(r.take(), Log{});
}

// --- Things a program cannot reach ---

TEST_F(EcmaScript, NothingOfDuktapeIsThere) {
  EcmaWorld r(script(
      "", "print(typeof Duktape, typeof CBOR, typeof Buffer, typeof String.fromBufferRaw, typeof "
          "require, typeof process, typeof Uint8Array.allocPlain, typeof load, typeof alert); "
          "print(Object.getOwnPropertyNames(new SFVec3f()), Object.getOwnPropertyNames(new "
          "SFNode('Group { }')), Object.getOwnPropertySymbols ? 1 : 0)"));
  EXPECT_EQ(
      r.printed().at(0),
      "undefined undefined undefined undefined undefined undefined undefined undefined undefined");
}

TEST_F(EcmaScript, ObjectsOfOtherKindsAreRefused) {
  EcmaWorld r(script(
      "field SFVec3f v 0 0 0 field MFVec3f m []",
      "function tries(f) { try { print(f()) } catch (e) { print(e.name) } }"
      "tries(function() { return SFVec3f.prototype.add.call({}, new SFVec3f()) });"
      "tries(function() { return SFVec3f.prototype.add.call(new SFColor(), new SFVec3f()) });"
      "tries(function() { return SFVec3f.prototype.toString.call(5) });"
      "tries(function() { return VrmlMatrix.prototype.inverse.call(new SFVec3f()) });"
      "tries(function() { return SFVec3f.prototype.x });"
      "tries(function() { return MFVec3f.prototype.length });"
      "tries(function() { return Object.create(new SFVec3f(1, 2, 3)).x });"
      "tries(function() { m = Object.create(new MFVec3f(new SFVec3f())); return m.length });"
      "tries(function() { return new VrmlMatrix()[2][7] });"
      "tries(function() { return new VrmlMatrix(1, 2) });"
      "tries(function() { return Object.create(new SFNode('Group { }')).children.length });"));
  EXPECT_EQ(r.takeOutput(), "TypeError\nTypeError\nTypeError\nTypeError\nundefined\n0\n1\n"
                            "TypeError\nundefined\nTypeError\n0");
}

TEST_F(EcmaScript, ChangesWhileAValueIsConverted) {
  EcmaWorld r(
      script("field MFVec3f m [1 1 1, 2 2 2] field MFFloat f [1, 2, 3]",
             "m[1] = [{ valueOf: function() { m.length = 0; return 5 } }, 6, 7]; print(m);"
             "f = [1, { valueOf: function() { f = new MFFloat(9); return 2 } }, 3]; print(f);"
             "var list = new MFFloat(1, 2, 3); list[0] = { valueOf: function() { list.length = 0; "
             "list.length = 100000; return 4 } }; print(list[0], list.length)"));
  EXPECT_EQ(r.takeOutput(), "[0 0 0, 5 6 7]\n[1, 2, 3]\n4 100000");
}

// --- Determinism: the same input gives the same output ---

TEST_F(EcmaScript, RandomNumbersAndDatesReplay) {
  const auto play = [] {
    EcmaWorld r(script("eventIn SFBool go",
                       "function go() { print(Math.random(), Math.random(), new Date().getTime(), "
                       "Date.now(), typeof Date(), new Date(2000, 0).getFullYear(), new Date() "
                       "instanceof Date, new Date(5).constructor == Date) }"));
    r.browser.tick(2);
    r.set("S", "go", true);
    return r.takeOutput();
  };
  const std::string first = play();
  EXPECT_EQ(first, play());
  EXPECT_TRUE(first.ends_with(" 2000 2000 string 2000 true true")) << first;
}

} // namespace
} // namespace xvrml
