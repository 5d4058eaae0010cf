// imports.cpp: IMPORT and EXPORT of X3D (ISO/IEC 19775-1 4.4.6), and the units of the files of
// Inlines (4.3.6).
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "conformance/events/scripted.h"
#include "xvrml/nodes.h"

namespace xvrml {
namespace {

// A temporary folder with some files, for one test.
struct Folder {
  Folder()
      : path(std::filesystem::temp_directory_path() /
             fmt::format("xvrml_imports_{}_{}", ::getpid(),
                         testing::UnitTest::GetInstance()->current_test_info()->name())) {
    std::filesystem::create_directories(path);
    file("arm.x3dv", "#X3D V3.3 utf8\nDEF T Transform { }\nDEF S Switch { children Group { } }\n"
                     "DEF Hidden Transform { }\nEXPORT T AS Arm\nEXPORT S\n");
  }
  ~Folder() { std::filesystem::remove_all(path); }
  std::string file(const std::string& name, const std::string& text) const {
    std::ofstream(path / name) << text;
    return (path / name).string();
  }
  std::filesystem::path path;
};

const std::string world = R"(#X3D V3.3 utf8
DEF I Inline { url "arm.x3dv" }
DEF J Inline { url "arm.x3dv" }
IMPORT I.Arm
IMPORT J.Arm AS Other
DEF P PositionInterpolator { key [ 0 1 ] keyValue [ 0 0 0, 2 4 6 ] }
DEF Q Transform { }
ROUTE P.value_changed TO Arm.set_translation
ROUTE Arm.translation_changed TO Q.scale
)";

// Returns the value of a field as text.
std::string valueOf(const Node& node, std::string_view field) {
  return textOf(node.get(*node.type().find(field)));
}

std::string translationIn(const Node& inlineNode) {
  const Scope* const content = inlineScope(inlineNode);
  return content ? valueOf(*content->names.at("T"), "translation") : "none";
}

TEST(Imports, RoutesReachTheNodesOfOneInline) {
  const Folder f;
  Browser browser(loadWorld(f.file("a.x3dv", world)));
  EXPECT_EQ(browser.world().diagnostics.list().size(), 0u);
  EXPECT_TRUE(browser.set(*browser.node("P"), "set_fraction", 0.5f));
  EXPECT_EQ(translationIn(*browser.node("I")), "1 2 3");
  EXPECT_EQ(translationIn(*browser.node("J")), "0 0 0");
  EXPECT_EQ(textOf(browser.get(*browser.node("Q"), "scale")), "1 2 3");
}

TEST(Imports, InlinesMayBeLoadedLaterAndAgain) {
  const Folder f;
  f.file("leg.x3dv", "#X3D V3.3 utf8\nDEF T Transform { translation 7 7 7 }\nEXPORT T AS Leg\n");
  LoadOptions options;
  options.loadInlines = false;
  Browser browser(loadWorld(f.file("a.x3dv", world), options));
  EXPECT_TRUE(browser.set(*browser.node("P"), "set_fraction", 0.5f));
  EXPECT_TRUE(browser.loadInline(*browser.node("I")));
  EXPECT_TRUE(browser.set(*browser.node("P"), "set_fraction", 1.0f));
  EXPECT_EQ(translationIn(*browser.node("I")), "2 4 6");
  EXPECT_EQ(browser.world().diagnostics.list().size(), 0u);
  // Content without the name: one message, and nothing is connected.
  EXPECT_TRUE(browser.set(*browser.node("I"), "url", MFString{"leg.x3dv"}));
  EXPECT_TRUE(browser.set(*browser.node("P"), "set_fraction", 0.5f));
  EXPECT_EQ(translationIn(*browser.node("I")), "7 7 7");
  EXPECT_EQ(browser.world().diagnostics.warnings(), 1u);
  EXPECT_EQ(textOf(browser.get(*browser.node("Q"), "scale")), "2 4 6");
  EXPECT_TRUE(browser.set(*browser.node("I"), "url", MFString{"arm.x3dv"}));
  EXPECT_TRUE(browser.set(*browser.node("P"), "set_fraction", 0.5f));
  EXPECT_EQ(translationIn(*browser.node("I")), "1 2 3");
  EXPECT_EQ(browser.world().diagnostics.warnings(), 1u);
}

TEST(Imports, WrongNamesAreSaidOnce) {
  const Folder f;
  f.file("closed.x3dv", "#X3D V3.3 utf8\nDEF T Transform { }\n");
  const auto loaded = loadWorld(f.file("a.x3dv", R"(#X3D V3.3 utf8
DEF I Inline { url "arm.x3dv" }
DEF C Inline { url "closed.x3dv" }
DEF G Group { children DEF T Transform { } }
IMPORT I.Hidden
IMPORT C.T AS U
IMPORT G.T AS V
IMPORT I.S
IMPORT I.Arm AS S
ROUTE T.translation_changed TO Hidden.set_translation
ROUTE T.translation_changed TO S.set_whichChoice
ROUTE T.nothing TO S.set_whichChoice
ROUTE T.translation_changed TO V.set_translation
Group { children USE S }
EXPORT S
EXPORT Nobody
)"));
  std::string messages;
  for (const Diagnostic& one : loaded->diagnostics.list()) {
    const std::string text = one.text().substr(0, one.text().find('\n'));
    messages += text.substr(text.find("a.x3dv:") + 7) + '\n';
  }
  EXPECT_EQ(messages,
            "7:8: error: IMPORT takes nodes from the file of an Inline, but 'G' is a node of type "
            "Group\n"
            "9:17: error: the name 'S' of an imported node is taken already (ISO/IEC 19775-1 "
            "4.4.6)\n"
            "12:9: error: Transform has no outputOnly 'nothing'\n"
            "13:32: warning: 'V' was left out above\n"
            "14:22: error: 'S' is imported: only routes can refer to it (ISO/IEC 19775-1 4.4.6)\n"
            "15:8: error: 'S' is imported: a file exports its own nodes only (ISO/IEC 19775-1 "
            "4.4.6)\n"
            "16:8: error: no node is named 'Nobody' by a DEF above\n"
            "5:1: warning: the file of Inline 'I' exports no node 'Hidden', so routes of 'Hidden' "
            "do nothing: it exports Arm, S\n"
            "6:1: warning: the file of Inline 'C' exports no node 'T', so routes of 'U' do "
            "nothing: it has no statement EXPORT\n"
            "11:1: error: route of an imported node: a route joins events of one type: "
            "'translation_changed' is SFVec3f, 'set_whichChoice' is SFInt32\n");
}

TEST(Imports, AllEncodingsOfX3dSayTheSame) {
  const Folder f;
  const auto classic = loadWorld(f.file("a.x3dv", world + "EXPORT Q AS R\n"));
  const std::string xml = writeWorld(*classic, "", Encoding::x3dXml);
  EXPECT_NE(xml.find("<IMPORT inlineDEF='J' importedDEF='Arm' AS='Other'/>"), std::string::npos);
  EXPECT_NE(xml.find("<EXPORT localDEF='Q' AS='R'/>"), std::string::npos);
  const auto again = loadWorld(f.file("b.x3d", xml));
  EXPECT_EQ(again->diagnostics.list().size(), 0u);
  EXPECT_EQ(writeWorld(*again, "", Encoding::x3dClassic),
            writeWorld(*classic, "", Encoding::x3dClassic));
  Browser browser(loadWorld(f.file("c.x3dj", R"({"X3D":{"@version":"3.3","Scene":{"-children":[
{"Inline":{"@DEF":"I","@url":["b.x3d"]}},
{"IMPORT":{"@inlineDEF":"I","@importedDEF":"R"}},
{"PositionInterpolator":{"@DEF":"P","@key":[0,1],"@keyValue":[0,0,0,2,4,6]}},
{"ROUTE":{"@fromNode":"P","@fromField":"value_changed","@toNode":"R","@toField":"scale"}}]}}})")));
  EXPECT_EQ(browser.world().diagnostics.list().size(), 0u);
  EXPECT_TRUE(browser.set(*browser.node("P"), "set_fraction", 0.5f));
  EXPECT_EQ(valueOf(*inlineScope(*browser.node("I"))->names.at("Q"), "scale"), "1 2 3");
}

TEST(Units, LengthsOfAnInlineAreConverted) {
  const Folder f;
  f.file("mm.x3dv", "#X3D V3.3 utf8\nUNIT length mm 0.001\nDEF T Transform { translation 500 0 0 "
                    "children Shape { geometry Box { size 200 200 200 } } }\nEXPORT T\n");
  f.file("m.x3d", "<X3D version='3.3'><Scene><Inline url='\"mm.x3dv\"'/></Scene></X3D>");
  const double origin[3] = {0.5, 0, 5}, direction[3] = {0, 0, -1};
  PickHit hit;
  Browser metres(loadWorld(f.file("a.x3dv", "#X3D V3.3 utf8\nInline { url \"m.x3d\" }\n")));
  ASSERT_TRUE(metres.pick(origin, direction, {}, hit));
  EXPECT_NEAR(hit.point[2], 0.1, 1e-6);
  // The unit of the world's own file changes nothing by itself, but is that of the Inlines in it.
  Browser same(loadWorld(f.file("b.x3dv", "#X3D V3.3 utf8\nUNIT length foo 0.001\n"
                                          "Inline { url \"mm.x3dv\" }\n")));
  const double far[3] = {500, 0, 5000};
  ASSERT_TRUE(same.pick(far, direction, {}, hit));
  EXPECT_NEAR(hit.point[2], 100, 1e-4);
  Browser centimetres(loadWorld(f.file("c.x3d", "<X3D version='3.3'><head><unit category='length' "
                                                "name='cm' conversionFactor='0.01'/></head><Scene>"
                                                "<Inline url='\"m.x3d\"'/></Scene></X3D>")));
  const double near[3] = {50, 0, 50};
  ASSERT_TRUE(centimetres.pick(near, direction, {}, hit));
  EXPECT_NEAR(hit.point[2], 10, 1e-5);
}

TEST(Units, AnglesAreConvertedWhereTheyAreRead) {
  const auto loaded = loadWorldFromMemory(R"(#X3D V3.3 utf8
UNIT angle degree 0.017453292519943295
PROTO Lamp [ initializeOnly SFFloat beam 90  initializeOnly SFRotation turn 0 0 1 180
             initializeOnly SFFloat radius 3 ] {
  Transform { rotation IS turn children SpotLight { cutOffAngle IS beam radius IS radius } }
}
DEF V Viewpoint { fieldOfView 60 orientation 0 1 0 90 }
DEF L Lamp { }
DEF M Lamp { beam 45 turn 1 0 0 90 radius 5 }
DEF S Script { initializeOnly SFRotation r 0 0 1 180 initializeOnly SFFloat f 180 }
DEF B Background { skyAngle [ 90 180 ] skyColor [ 0 0 0, 1 1 1, 0 1 0 ] }
DEF O OrientationInterpolator { key [ 0 1 ] keyValue [ 0 1 0 0, 0 1 0 180 ] }
DEF A Shape { geometry IndexedFaceSet { } }
)",
                                          "a.x3dv");
  EXPECT_EQ(loaded->diagnostics.list().size(), 0u)
      << (loaded->diagnostics.list().empty() ? "" : loaded->diagnostics.list()[0].text());
  const auto number = [&](const char* name, const char* field) {
    const Node& node = *loaded->scope.names.at(name);
    const Value value = node.get(*node.type().find(field));
    if (const auto* one = std::get_if<SFFloat>(&value)) return double(*one);
    if (const auto* one = std::get_if<MFFloat>(&value)) return double(one->back());
    if (const auto* one = std::get_if<SFRotation>(&value)) return double(one->angle);
    return double(std::get<MFRotation>(value).back().angle);
  };
  constexpr double pi = 3.14159265358979;
  EXPECT_NEAR(number("V", "fieldOfView"), pi / 3, 1e-6);
  EXPECT_NEAR(number("V", "orientation"), pi / 2, 1e-6);
  EXPECT_NEAR(number("L", "beam"), pi / 2, 1e-6);
  EXPECT_NEAR(number("L", "turn"), pi, 1e-6);
  EXPECT_EQ(number("L", "radius"), 3);
  EXPECT_NEAR(number("M", "beam"), pi / 4, 1e-6);
  EXPECT_NEAR(number("M", "turn"), pi / 2, 1e-6);
  EXPECT_EQ(number("M", "radius"), 5);
  EXPECT_NEAR(number("S", "r"), pi, 1e-6);
  EXPECT_EQ(number("S", "f"), 180);
  EXPECT_NEAR(number("B", "skyAngle"), pi, 1e-6);
  EXPECT_NEAR(number("O", "keyValue"), pi, 1e-6);
  // A written file has radians, and no unit for them.
  const std::string text = writeWorld(*loaded, "", Encoding::x3dClassic);
  EXPECT_EQ(text.find("UNIT"), std::string::npos);
  EXPECT_EQ(writeWorld(*loadWorldFromMemory(text, "b.x3dv"), "", Encoding::x3dClassic), text);
}

TEST(Units, WrongOnesAreSaidAndLeftOut) {
  const auto loaded = loadWorldFromMemory(
      "#X3D V3.3 utf8\nUNIT length a 0\nUNIT length b -1\nUNIT length c 1e300\nUNIT speed d 2\n"
      "UNIT length e 2\nUNIT length f 3\nUNIT mass g 0.001\nGroup { }\n",
      "a.x3dv");
  EXPECT_EQ(loaded->diagnostics.errors(), 3u);
  EXPECT_EQ(loaded->diagnostics.warnings(), 2u);
  ASSERT_EQ(loaded->head.units.size(), 2u);
  EXPECT_EQ(loaded->head.units[0].name, "e");
  const std::string text = writeWorld(*loaded, "", Encoding::x3dXml);
  EXPECT_NE(text.find("<unit category='length' name='e' conversionFactor='2'/>"),
            std::string::npos);
  EXPECT_EQ(loadWorldFromMemory(text, "a.x3d")->head.units.size(), 2u);
}

} // namespace
} // namespace xvrml
