// ecmascript_habits.cpp: features beyond Annex C that programs in real worlds rely on, written as
// in VRML files.
#include "conformance/events/ecmascript_world.h"

namespace xvrml {
namespace {

TEST_F(EcmaScript, HabitsOfRealWorlds) {
  EcmaWorld r(R"(Script { field SFBool f TRUE url "vrmlscript:
<!--
function initialize() {
  print('a\tb' + '\x41' + \"quoted\" + 'it\'s');
  if (f == TRUE && FALSE == false) print('constants');
  un = declared(3);  print(un)
  print('x' + 1.50 + true, parseInt('12px'), parseFloat('1.5e3'), Math.PI.toFixed(3), isNaN(0/0), escape('a b'))
  switch (2) { case 2: print('two'); break; default: print('no') }
  with (Math) { print(floor(2.7)) }
  var list = new Array(3); list = new SFColor(1, 0, 0).getHSV(); print(list)
}
function declared(n) { if (n == 0) return 0
  return n + declared(n - 1) }
// -->
" })");
  EXPECT_EQ(r.takeOutput(),
            "a\tbAquotedit's\nconstants\n6\nx1.5true 12 1500 3.142 true a%20b\ntwo\n2\n0,1,1");
}

TEST_F(EcmaScript, ConsolesPrint) {
  EcmaWorld r(EcmaWorld::script("field SFVec3f at 1 2 3",
                                "console.log('at', at); console.warn(1); console.error()"));
  EXPECT_EQ(r.takeOutput(), "at 1 2 3\n1\n");
}

TEST_F(EcmaScript, LinesEndInAnyWay) {
  for (const char* end : {"\n", "\r\n", "\r"}) {
    const std::string e = end;
    EcmaWorld r("Script { url \"javascript:" + e + "// comment" + e + "function initialize() {" +
                e + "  print('a')" + e + "  print('b')" + e + "} // = x" + e + "\" }");
    EXPECT_EQ(r.takeOutput(), "a\nb");
  }
}

// A program prints the same in a process of its own.
TEST_F(EcmaScript, AProcessMakesNoDifference) {
  const std::string world =
      "DEF T Transform { children [ Group { } ] } " +
      EcmaWorld::script("directOutput TRUE field SFNode t USE T field MFVec3f m [1 2 3] eventIn "
                        "SFTime in eventOut SFVec3f out",
                        "function initialize() { print(t, t.children, m, Math.random(), new "
                        "Date().getTime(), Browser.getName()); t.translation.x = 5; m[1] = "
                        "t.translation; out = m[1]; new SFNode('Shape { }') }"
                        "function shutdown() { print(out, m) }");
  const auto play = [&](BrowserOptions::Isolation where) {
    BrowserOptions options;
    options.scriptPath = XVRML_SCRIPTS;
    options.scriptIsolation = where;
    Scripted r(world, options);
    r.log("T", "translation");
    Log all = r.printed();
    all.push_back(r.get("T", "translation") + " " + r.get("S", "out") + " " + r.get("S", "m"));
    r.browser.replaceWorld({});
    for (const std::string& line : r.printed()) all.push_back(line);
    return all;
  };
  const Log here = play(BrowserOptions::Isolation::never);
  ASSERT_EQ(here.size(), 3u);
  EXPECT_EQ(here[1], "5 0 0 5 0 0 [1 2 3, 5 0 0]");
  EXPECT_EQ(here, play(BrowserOptions::Isolation::always));
}

} // namespace
} // namespace xvrml
