// x3d_scenes.cpp: scenes of X3D's programs as text (ISO/IEC 19777-1): that of an Inline, and scenes
// that a program has made. What a program makes may go on making, up to a limit. Names of fields
// belong to the version of a node's file.
#include "conformance/events/ecmascript_world.h"
#include "conformance/events/media_files.h"

namespace xvrml {
namespace {

const std::string header = "#X3D V3.3 utf8\nPROFILE Immersive\n";

class EcmaScenes : public EcmaScript {
 protected:
  // Runs a file until its Scripts have begun. Returns what they print, one line each.
  std::string printed(const std::string& path, const LoadOptions& loading = {}) {
    BrowserOptions options;
    options.scriptPath = XVRML_SCRIPTS;
    std::string lines;
    options.print = [&](const std::string& text) { lines += text + "\n"; };
    Browser browser(loadWorld(path, loading), options);
    for (const Diagnostic& one : browser.world().diagnostics.list()) lines += one.message + "\n";
    return lines;
  }
  const Folder folder_;
};

std::string scriptThat(const std::string& program) {
  return EcmaWorld::script("directOutput TRUE",
                           "function initialize() { var s = Browser.currentScene; " + program +
                               " }");
}

// Returns how often a text holds another one.
int count(const std::string& text, const std::string& part) {
  int found = 0;
  for (size_t at = 0; (at = text.find(part, at)) != std::string::npos; at += part.size()) ++found;
  return found;
}

TEST_F(EcmaScenes, AnInlineWritesItsOwnScene) {
  folder_.write("inner.x3dv",
                "#X3D V3.1 utf8\nPROFILE Full\nPROTO Ball [ ] { Group { } }\nDEF Inner Ball { }\n"
                "DEF Clock TimeSensor { }\nDEF Path PositionInterpolator { }\n"
                "ROUTE Clock.fraction_changed TO Path.set_fraction\n" +
                    scriptThat("print(s.toVRMLString()); print(s.toXMLString());"));
  folder_.write("outer.x3dv", header + "DEF Outer Group { }\nInline { url \"inner.x3dv\" }\n");
  const std::string text = printed(folder_ / "outer.x3dv");
  EXPECT_EQ(text.find("#X3D V3.1 utf8\n"), 0u) << text;
  EXPECT_EQ(count(text, "Outer"), 0) << text;
  EXPECT_EQ(count(text, "DEF Inner Ball"), 1) << text;
  EXPECT_EQ(count(text, "PROTO Ball ["), 1) << text;
  EXPECT_EQ(count(text, "ROUTE Clock.fraction_changed TO Path.set_fraction"), 1) << text;
  EXPECT_EQ(count(text, "<X3D profile='Immersive' version='3.1'>"), 1) << text;
  EXPECT_EQ(count(text, "<ProtoDeclare name='Ball'>"), 1) << text;
  EXPECT_EQ(count(text, "<ROUTE "), 1) << text;
}

// A prototype that only another one uses is written before it, one within another stays there.
TEST_F(EcmaScenes, AMadeSceneHasItsPrototypesAndRoutes) {
  folder_.write(
      "w.x3dv",
      header + scriptThat("var made = Browser.createX3DFromString("
                          "'PROTO Leaf [ ] { Group { } }'"
                          "+ ' PROTO Tree [ ] { PROTO Own [ ] { Group { } } Group { children [ Own "
                          "{ } Leaf { } ] } }'"
                          "+ ' DEF T Tree { } DEF C TimeSensor { } DEF P PositionInterpolator { }'"
                          "+ ' ROUTE C.fraction_changed TO P.set_fraction');"
                          "var text = made.toVRMLString(); print(text);"
                          "var again = Browser.createX3DFromString(text);"
                          "print(again.toVRMLString() == text, again.rootNodes.length);"
                          "print(made.toXMLString());"));
  const std::string text = printed(folder_ / "w.x3dv");
  EXPECT_EQ(text.find("#X3D V3.3 utf8\nPROFILE Immersive\n"), 0u) << text;
  EXPECT_LT(text.find("PROTO Leaf ["), text.find("PROTO Tree [")) << text;
  EXPECT_EQ(count(text, "PROTO Own ["), 1) << text;
  EXPECT_LT(text.find("PROTO Tree ["), text.find("PROTO Own [")) << text;
  EXPECT_EQ(count(text, "ROUTE C.fraction_changed TO P.set_fraction"), 1) << text;
  EXPECT_EQ(count(text, "true 3\n"), 1) << text;
  EXPECT_EQ(count(text, "<ProtoDeclare name='"), 3) << text;
  EXPECT_EQ(count(text, "<ROUTE "), 1) << text;
}

// Routes are those of the moment.
TEST_F(EcmaScenes, RoutesOfProgramsAreWritten) {
  folder_.write("w.x3dv",
                header +
                    scriptThat("var made = Browser.createX3DFromString("
                               "'DEF C TimeSensor { } DEF P PositionInterpolator { }');"
                               "var c = made.rootNodes[0], p = made.rootNodes[1];"
                               "s.addRoute(c, 'fraction_changed', p, 'set_fraction');"
                               "print(/ROUTE C.fraction_changed TO P/.test(made.toVRMLString()));"
                               "s.deleteRoute(c, 'fraction_changed', p, 'set_fraction');"
                               "print(/ROUTE/.test(made.toVRMLString()));"));
  EXPECT_EQ(printed(folder_ / "w.x3dv"), "true\nfalse\n");
}

// A text of VRML97 stays one, also in a world of X3D.
TEST_F(EcmaScenes, AMadeSceneHasTheVersionOfItsText) {
  folder_.write("w.x3dv", header + scriptThat("print(Browser.createX3DFromString("
                                              "'#VRML V2.0 utf8\\nSwitch { choice Group { } }')"
                                              ".toVRMLString());"));
  EXPECT_EQ(printed(folder_ / "w.x3dv").find("#VRML V2.0 utf8\n\nSwitch {\n  choice"), 0u)
      << printed(folder_ / "w.x3dv");
}

TEST_F(EcmaScenes, PrototypesThatMakeThemselvesEndAtTheLimit) {
  folder_.write("w.x3dv", header + "PROTO P [ ] { " +
                              scriptThat("print('made'); Browser.currentScene.createProto('P');") +
                              " }\nP { }\n");
  for (const int most : {3, 7, 32}) {
    LoadOptions options;
    options.limits.inlineDepth = uint64_t(most);
    const std::string text = printed(folder_ / "w.x3dv", options);
    EXPECT_EQ(count(text, "made\n"), most + 2) << text;
    EXPECT_EQ(count(text, fmt::format("limit inlineDepth={}", most)), 1) << text;
  }
}

// By prototype and by text in turn: both count.
TEST_F(EcmaScenes, ChainsOfTextsAndPrototypesEndAtTheLimit) {
  folder_.write("w.x3dv",
                header + "PROTO P [ ] { " +
                    scriptThat("print('made'); Browser.createX3DFromString("
                               "'Script { url \\\"javascript: function initialize() { "
                               "Browser.currentScene.createProto(\\\\'P\\\\'); }\\\" }');") +
                    " }\nP { }\n");
  LoadOptions options;
  options.limits.inlineDepth = 6;
  const std::string text = printed(folder_ / "w.x3dv", options);
  EXPECT_EQ(count(text, "limit inlineDepth=6"), 1) << text;
  EXPECT_EQ(count(text, "made\n"), 4) << text;
}

// VRML97's names are known for nodes of all files, X3D's for nodes of X3D's files.
TEST_F(EcmaScenes, NamesOfBothStandards) {
  folder_.write(
      "w.x3dv",
      header + scriptThat(
                   "var w = new SFNode('Switch { children Group { } }');"
                   "print(w.choice.length, w.children.length); w.choice = new MFNode();"
                   "print(w.children.length, w.choice.length);"
                   "var c = new SFNode('Collision { enabled FALSE }');"
                   "c.collide = true; print(c.enabled, c.set_collide === undefined);"
                   "var v = Browser.createX3DFromString('#VRML V2.0 utf8\\nSwitch { choice Group { "
                   "} } Collision { }').rootNodes;"
                   "print(v[0].choice.length, v[0].children, v[1].enabled, v[1].collide);"
                   "try { v[0].children = new MFNode(); print('taken'); }"
                   "catch (e) { print(e.message); }"));
  EXPECT_EQ(printed(folder_ / "w.x3dv"),
            "1 1\n0 0\ntrue false\n1 undefined undefined true\nthe node has no 'children'\n");
}

} // namespace
} // namespace xvrml
