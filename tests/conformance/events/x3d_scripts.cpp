// x3d_scripts.cpp: inputOutput fields of Scripts (ISO/IEC 19775-1 29.2.2): they take events as x
// and set_x, send x_changed when a route or the program writes them, and are variables of the
// program, in all languages. Languages that are not built are skipped.
#include "conformance/events/ecmascript_world.h"
#include "xvrml/script_engines.h"

namespace xvrml {
namespace {

const std::string header = "#X3D V3.3 utf8\nPROFILE Immersive\n";
const std::string fields = "inputOutput SFFloat x 1 inputOnly SFFloat put outputOnly SFFloat out";

// Each program sends x + 1 to `out` when x arrives, and writes x = put * 10 when `put` arrives.
struct Language {
  const char* name;
  const char* url;
};
void PrintTo(const Language& language, std::ostream* out) { *out << language.name; }

class InputOutput : public testing::TestWithParam<Language> {
 protected:
  void SetUp() override {
    setenv("XVRML_NATIVE_PATH", XVRML_TEST_NATIVE, 1);
    if (!hasScriptEngine(GetParam().name, XVRML_SCRIPTS)) GTEST_SKIP() << "not built";
  }
  static BrowserOptions trusting() {
    BrowserOptions options;
    options.scriptPath = XVRML_SCRIPTS;
    options.trustScripts = true;
    return options;
  }
  static std::string world(const std::string& more = "") {
    return header + "DEF S Script { " + fields + " url \"" + GetParam().url + "\" }\n" + more;
  }
};

TEST_P(InputOutput, TakesAndSendsEventsAndIsAVariable) {
  Scripted r(world(), trusting());
  for (const char* out : {"x", "out"}) r.log("S", out);
  EXPECT_EQ(r.get("S", "x"), "1");
  EXPECT_TRUE(r.set("S", "set_x", 4.f));
  EXPECT_EQ(r.take(), (Log{"0 S.x 4", "0 S.out 5"}));
  EXPECT_EQ(r.get("S", "x"), "4");
  EXPECT_TRUE(r.set("S", "put", 2.f));
  EXPECT_EQ(r.take(), (Log{"0 S.x 20"}));
  EXPECT_EQ(r.get("S", "x_changed"), "20");
  EXPECT_TRUE(r.set("S", "x", 7.f));
  EXPECT_EQ(r.take(), (Log{"0 S.x 7", "0 S.out 8"}));
  EXPECT_EQ(r.messages(), Log());
}

TEST_P(InputOutput, IsRoutedUnderAllItsNames) {
  for (const char* in : {"x", "set_x"})
    for (const char* out : {"x", "x_changed"}) {
      Scripted r(
          world("DEF A Transform { } DEF F ScalarInterpolator { key [0 1] keyValue [0 10] }\n"
                "DEF P PointLight { }\nROUTE F.value_changed TO S." +
                std::string(in) + "\nROUTE S." + out + " TO P.set_intensity\n"),
          trusting());
      r.set("F", "set_fraction", 0.05f);
      EXPECT_EQ(r.get("P", "intensity"), "0.5") << in << " " << out;
      r.set("S", "put", 0.1f);
      EXPECT_EQ(r.get("P", "intensity"), "1") << in << " " << out;
      EXPECT_EQ(r.messages(), Log());
    }
}

TEST_P(InputOutput, IsAnInterfaceOfItsPrototype) {
  Scripted r(header + "PROTO P [ inputOutput SFFloat level 3 inputOnly SFFloat put ] {\n" +
                 "DEF S Script { inputOutput SFFloat x IS level inputOnly SFFloat put IS put\n"
                 "outputOnly SFFloat out url \"" +
                 GetParam().url + "\" } }\nDEF I P { }\nDEF J P { level 9 }\n",
             trusting());
  r.log("I", "level");
  EXPECT_EQ(r.get("J", "level"), "9");
  r.set("I", "put", 2.f);
  EXPECT_EQ(r.take(), (Log{"0 I.level 20"}));
  EXPECT_EQ(r.get("I", "level"), "20");
  r.set("I", "level", 5.f);
  EXPECT_EQ(r.take(), (Log{"0 I.level 5"}));
  EXPECT_EQ(r.get("J", "level"), "9");
  EXPECT_EQ(r.messages(), Log());
}

INSTANTIATE_TEST_SUITE_P(
    Languages, InputOutput,
    testing::Values(Language{"ecmascript", "ecmascript:\nfunction set_x(v) { out = x + 1; }\n"
                                           "function put(v) { x = v * 10; }"},
                    Language{"tcl",
                             "tcl:\nproc set_x {v t} {global x out; set out [expr {$x + 1}]}\n"
                             "proc put {v t} {global x; set x [expr {$v * 10}]}"},
                    Language{"python", "python:\ndef set_x(v, t): script.out = script.x + 1\n"
                                       "def put(v, t): script.x = v * 10"},
                    Language{"native", "native:native_test#set_x: out = addOne(x)\n"
                                       "put: x = tenTimes(put)"}),
    [](const testing::TestParamInfo<Language>& info) { return std::string(info.param.name); });

// --- Names of other nodes' fields ---

// In a world of X3D these names work in all languages: children of Switch and LOD, enabled of
// Collision (ISO/IEC 19775-1 10.4.3, 23.4.2, 23.4.3). Each program notes what it reads, disables
// the Collision, and routes the children of the Switch to itself.
class NamesOfX3d : public InputOutput {};

TEST_P(NamesOfX3d, AreReadWrittenAndRouted) {
  Scripted r(
      header +
          "DEF W Switch { whichChoice 0 children [ Group { } Group { } ] }\n"
          "DEF L LOD { children [ Group { } Group { } Group { } ] }\n"
          "DEF C Collision { enabled TRUE }\nDEF N Group { }\n"
          "DEF S Script { directOutput TRUE inputOnly SFBool go inputOnly MFNode got\n"
          "outputOnly SFInt32 two outputOnly SFInt32 three outputOnly SFBool on\n"
          "outputOnly SFInt32 now initializeOnly SFNode w USE W initializeOnly SFNode l USE L\n"
          "initializeOnly SFNode c USE C initializeOnly SFNode n USE N\n"
          "initializeOnly SFNode me USE S url \"" +
          GetParam().url + "\" }\n",
      trusting());
  r.set("S", "go", true);
  EXPECT_EQ(r.get("S", "two"), "2");
  EXPECT_EQ(r.get("S", "three"), "3");
  EXPECT_EQ(r.get("S", "on"), "TRUE");
  EXPECT_EQ(r.get("C", "enabled"), "FALSE");
  EXPECT_EQ(r.get("S", "now"), "3");
  EXPECT_EQ(r.messages(), Log());
}

INSTANTIATE_TEST_SUITE_P(
    Languages, NamesOfX3d,
    testing::Values(
        Language{
            "ecmascript",
            "ecmascript:\nfunction go() { two = w.children.length; three = l.children.length;\n"
            "on = c.enabled; c.enabled = false;\n"
            "Browser.currentScene.addRoute(w, 'children_changed', me, 'got');\n"
            "w.addChildren = new MFNode(n); }\nfunction got(v) { now = v.length; }"},
        Language{"tcl",
                 "tcl:\nproc go {v t} {global w l c n me two three on\n"
                 "set two [llength [$w get children]]; set three [llength [$l get children]]\n"
                 "set on [$c get enabled]; $c set enabled FALSE\n"
                 "Browser addRoute $w children_changed $me got\n"
                 "$w set addChildren [list $n]}\n"
                 "proc got {v t} {global now; set now [llength $v]}"},
        Language{"python", "python:\ndef go(v, t):\n    script.two = len(script.w.children)\n"
                           "    script.three = len(script.l.children)\n"
                           "    script.on = script.c.enabled\n    script.c.enabled = False\n"
                           "    browser.add_route(script.w, 'children_changed', script.me, 'got')\n"
                           "    script.w.addChildren = [script.n]\n"
                           "def got(v, t): script.now = len(v)"}),
    [](const testing::TestParamInfo<Language>& info) { return std::string(info.param.name); });

// --- ECMAScript ---

TEST_F(EcmaScript, InputOutputListsAreOneObjectThatEventsRenew) {
  EcmaWorld r(header + EcmaWorld::script("inputOutput MFFloat a [ 1 2 ] inputOnly SFBool go "
                                         "inputOutput SFVec3f v 1 2 3",
                                         "function go() { print(a.length + ' ' + a[0]); a[1] = 9; "
                                         "v.x = 5; print(a_changed[1]); }"));
  r.log("S", "a");
  r.log("S", "v");
  r.set("S", "a", MFFloat{4, 5, 6});
  r.take();
  r.set("S", "go", true);
  EXPECT_EQ(r.takeOutput(), "3 4\n9");
  EXPECT_EQ(r.take(), (Log{"0 S.a [4, 9, 6]", "0 S.v 5 2 3"}));
}

TEST_F(EcmaScript, InputOutputCallsAFunctionOfItsOwnNameToo) {
  EcmaWorld r(header + EcmaWorld::script("inputOutput SFFloat x 1 outputOnly SFFloat y",
                                         "function x(value) { y = 2 * value; }"));
  r.log("S", "y");
  r.set("S", "x", 3.f);
  EXPECT_EQ(r.take(), (Log{"0 S.y 6"}));
}

TEST_F(EcmaScript, InputOutputSendsOncePerCascade) {
  // set_x writes x within the cascade that brought it: the value stays, the second event does not
  EcmaWorld r(header + EcmaWorld::script("inputOutput SFFloat x 1",
                                         "function set_x(v) { if (v > 2) x = 2; }"));
  r.log("S", "x");
  r.set("S", "x", 7.f);
  EXPECT_EQ(r.take(), (Log{"0 S.x 7"}));
  EXPECT_EQ(r.get("S", "x"), "2");
}

TEST_F(EcmaScript, InputOutputNodesAreNotTheirOwnDescendants) {
  EcmaWorld r(header +
              EcmaWorld::script("inputOutput SFNode n NULL inputOnly SFBool go",
                                "function go() { n = Browser.createVrmlFromString('Group { }')[0];"
                                " print(n.children.length); }"));
  r.log("S", "n");
  r.set("S", "go", true);
  EXPECT_EQ(r.takeOutput(), "0");
  EXPECT_EQ(r.take().size(), 1U);
}

TEST_F(EcmaScript, InputOutputInAProcess) {
  BrowserOptions options;
  options.scriptPath = XVRML_SCRIPTS;
  options.scriptIsolation = BrowserOptions::Isolation::always;
  Scripted r(header + EcmaWorld::script("inputOutput SFFloat x 1 outputOnly SFFloat y",
                                        "function set_x() { y = x + 1; }"),
             options);
  r.log("S", "y");
  r.set("S", "x", 3.f);
  EXPECT_EQ(r.take(), (Log{"0 S.y 4"}));
}

// VRML97 has no such fields in Scripts (6.40). The message says so, and the field works.
TEST_F(EcmaScript, ExposedFieldInAFileOfVrml97) {
  EcmaWorld r(EcmaWorld::script("exposedField SFFloat x 1 eventOut SFFloat y",
                                "function set_x() { y = x + 1; }"));
  r.log("S", "y");
  r.set("S", "x", 3.f);
  EXPECT_EQ(r.take(), (Log{"0 S.y 4"}));
  const Log messages = r.messages();
  ASSERT_EQ(messages.size(), 1U);
  EXPECT_NE(messages[0].find("6.40"), messages[0].npos);
}

// --- The Browser object of X3D (ISO/IEC 19777-1) ---

TEST_F(EcmaScript, BrowserHasTheScene) {
  EcmaWorld r(
      header +
      EcmaWorld::script(
          "inputOnly SFBool go directOutput TRUE",
          "function go() { var scene = Browser.currentScene; var t = scene.getNamedNode('T');"
          "print(t.translation.x, scene.rootNodes.length, scene.rootNodes[1].translation.y);"
          "t.translation = new SFVec3f(4, 5, 6);"
          "scene.addRoute(t, 'translation_changed', scene.getNamedNode('U'), 'set_translation');"
          "try { scene.getNamedNode('X'); } catch (e) { print('no X'); } }",
          "DEF T Transform { translation 1 2 3 } DEF U Transform { }"));
  r.set("S", "go", true);
  EXPECT_EQ(r.takeOutput(), "1 3 2\nno X");
  EXPECT_EQ(r.get("T", "translation"), "4 5 6");
  r.set("T", "translation", Vec3f{7, 8, 9});
  EXPECT_EQ(r.get("U", "translation"), "7 8 9");
}

TEST_F(EcmaScript, BrowserHasPropertiesOfX3d) {
  EcmaWorld r(header +
              EcmaWorld::script(
                  "inputOnly SFBool go",
                  "function go() { print(Browser.name == Browser.getName(), Browser.version == "
                  "Browser.getVersion(), Browser.currentSpeed, Browser.currentFrameRate);"
                  "Browser.description = 'said'; print(Browser.description);"
                  "var made = Browser.createX3DFromString('Transform { translation 1 2 3 }');"
                  "print(made.rootNodes.length, made.rootNodes[0].translation.z); "
                  "Browser.println('ln'); }"));
  r.set("S", "go", true);
  EXPECT_EQ(r.takeOutput(), "true true 0 0\nsaid\n1 3\nln");
  EXPECT_EQ(r.browser.description(), "said");
}

// Worlds of other browsers set options that this one does not have, and go on.
TEST_F(EcmaScript, OptionsOfBrowsersDoNothing) {
  EcmaWorld r(
      header +
      EcmaWorld::script("inputOnly SFBool go",
                        "function go() { Browser.setBrowserOption('PrimitiveQuality', 'HIGH');"
                        "Browser.setBrowserOption('Shading', 'PHONG'); Browser.setBrowserOption();"
                        "print(Browser.getBrowserOption('Shading'), "
                        "Browser.getBrowserProperty('x'), Browser.getRenderingProperty('y')); }"));
  r.set("S", "go", true);
  r.set("S", "go", true);
  const std::string output = r.takeOutput(), warning = "setBrowserOption does nothing";
  EXPECT_EQ(output.find("null null null\nnull null null"), 0u) << output;
  EXPECT_NE(output.find(warning), output.npos) << output;
  EXPECT_EQ(output.find(warning), output.rfind(warning)) << output;
}

TEST_F(EcmaScript, BrowserHasTheSceneInAProcess) {
  BrowserOptions options;
  options.scriptPath = XVRML_SCRIPTS;
  options.scriptIsolation = BrowserOptions::Isolation::always;
  Scripted r(header +
                 EcmaWorld::script(
                     "inputOnly SFBool go outputOnly SFVec3f out",
                     "function go() { out = Browser.currentScene.getNamedNode('T').translation; }",
                     "DEF T Transform { translation 1 2 3 }"),
             options);
  r.set("S", "go", true);
  EXPECT_EQ(r.get("S", "out"), "1 2 3");
  EXPECT_EQ(r.messages(), Log());
}

} // namespace
} // namespace xvrml
