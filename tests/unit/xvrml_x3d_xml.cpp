// xvrml_x3d_xml.cpp: what is special to X3D in XML: encodings, places in messages, entities, long
// runs of numbers, and hostile files. Files that are simply right or wrong are in
// tests/conformance.
#include <chrono>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "nodes/registry.h"
#include "xvrml/nodes.h"
#include "xvrml/world.h"

namespace {

using namespace xvrml;

std::unique_ptr<World> load(const std::string& text, const LoadOptions& options = {}) {
  return loadWorldFromMemory(text, "test.x3d", options);
}

std::string scene(const std::string& body) {
  return "<X3D version='3.3' profile='Immersive'><Scene>" + body + "</Scene></X3D>";
}

std::string messages(const World& world) {
  std::string all;
  for (const Diagnostic& one : world.diagnostics.list())
    all += one.text().substr(0, one.text().find('\n')) + '\n';
  return all;
}

template <class T> T& first(const World& world) { return *nodeCast<T>(world.scope.roots.at(0)); }

// Returns n numbers, separated by blanks and ends of lines.
std::string numbers(size_t n) {
  std::string text;
  for (size_t i = 0; i < n; ++i) text += std::to_string(i) + (i % 10 == 9 ? "\n" : " ");
  return text;
}

std::string coordinates(const std::string& point) {
  return scene("<Shape><PointSet><Coordinate DEF='C' point='" + point + "'/></PointSet></Shape>");
}

const MFVec3f& pointsOf(const World& world) {
  return nodeCast<nodes::Coordinate>(world.scope.names.at("C"))->point;
}

TEST(X3dXml, ContentDecidesBeforeTheSuffix) {
  for (const char* name : {"a.wrl", "a.x3dv", "a", "a.x3d"}) {
    const auto world = loadWorldFromMemory(scene("<Group/>"), name);
    EXPECT_EQ(world->head.version, (FileVersion{Encoding::x3dXml, 3, 3})) << name;
  }
  // A long comment hides what follows, so that the suffix decides.
  const std::string late = "<!--" + std::string(20000, 'x') + "-->" + scene("<Group/>");
  EXPECT_EQ(loadWorldFromMemory(late, "a.x3d")->scope.roots.size(), 1u);
  EXPECT_EQ(loadWorldFromMemory(late, "a.x3dz")->scope.roots.size(), 1u);
  EXPECT_THROW(loadWorldFromMemory(late, "a.wrl"), LoadError);
  EXPECT_THROW(loadWorldFromMemory("<html><body/></html>", "a.wrl"), LoadError);
  EXPECT_THROW(loadWorldFromMemory("<!DOCTYPE html><br><X3D>", "a.x3d"), LoadError);
}

TEST(X3dXml, TheVersionIsThatOfTheRoot) {
  EXPECT_EQ(load("<X3D version='4.0'><Scene/></X3D>")->head.version.major, 4);
  EXPECT_EQ(load("<X3D version='3.1'><Scene/></X3D>")->head.version.minor, 1);
  for (const char* odd : {"<X3D><Scene/></X3D>", "<X3D version='x'><Scene/></X3D>",
                          "<X3D version='9.0'><Scene/></X3D>", "<X3D version=''><Scene/></X3D>"}) {
    const auto world = load(odd);
    EXPECT_EQ(world->diagnostics.warnings(), 1u) << odd;
    EXPECT_TRUE(world->head.version.isX3d()) << odd;
    EXPECT_LE(world->head.version.major, 4) << odd;
  }
}

TEST(X3dXml, NodesCarryTheVersionOfTheirFile) {
  const auto world = load("<X3D version='3.2'><Scene><Group/></Scene></X3D>");
  EXPECT_EQ(versionOf(*world->scope.roots.at(0)), (FileVersion{Encoding::x3dXml, 3, 2}));
}

TEST(X3dXml, PlacesAreThoseOfTheFile) {
  const auto world = load("<X3D version='3.3'>\n<Scene>\n  <Group>\n"
                          "    <Shape\n      DEF='S' ><Box\n size='1 x 1'/></Shape>\n"
                          "  </Group>\n</Scene></X3D>");
  EXPECT_EQ(messages(*world), "test.x3d:6:10: error: expected a component of SFVec3f, found 'x'\n");
  EXPECT_EQ(world->scope.names.at("S")->source.line, 4u);
  EXPECT_EQ(world->scope.names.at("S")->source.column, 6u);
  // Columns count characters, not bytes.
  EXPECT_EQ(messages(*load(scene("<!-- äöü --><Group bad='1'/>"))).substr(0, 20),
            "test.x3d:1:66: error");
}

TEST(X3dXml, PlacesInOtherEncodingsAreThoseOfTheCharacters) {
  const std::string text =
      "<?xml version='1.0' encoding='ISO-8859-1'?>\n<!-- \xe4\xf6 -->" + scene("<Group bad='1'/>");
  EXPECT_EQ(messages(*load(text)).substr(0, 20), "test.x3d:2:65: error");
  std::string wide = "\xff\xfe";
  for (const char c : text)
    if (static_cast<unsigned char>(c) < 0x80) wide += {c, '\0'};
  EXPECT_EQ(messages(*load(wide)).substr(0, 20), "test.x3d:2:63: error");
}

TEST(X3dXml, AValueWithAnEntityIsReportedWhereItStands) {
  const auto world = load(scene("<Group/><Transform translation='1 &#120; 3'/>"));
  EXPECT_NE(messages(*world).find("test.x3d:1:79: error: expected a component"), std::string::npos)
      << messages(*world);
}

TEST(X3dXml, LongRunsOfNumbersAreRead) {
  const auto world = load(coordinates(numbers(30000)));
  EXPECT_EQ(messages(*world), "");
  ASSERT_EQ(pointsOf(*world).size(), 10000u);
  EXPECT_EQ(pointsOf(*world)[9999].z, 29999);
}

TEST(X3dXml, PlacesBehindALongRunAndWithinIt) {
  // Ten numbers a line: a number without digits in line 1001, the wrong node behind line 3000.
  std::string text = numbers(30000);
  const size_t at = text.find("10000 ");
  text.replace(at, 5, "e-..e");
  const auto world = load(coordinates(text) + "x");
  ASSERT_EQ(world->diagnostics.list().size(), 2u) << messages(*world);
  EXPECT_EQ(world->diagnostics.list()[0].line, 1001u);
  EXPECT_EQ(world->diagnostics.list()[0].column, 1u);
  EXPECT_EQ(world->diagnostics.list()[1].line, 3001u);
  ASSERT_EQ(pointsOf(*world).size(), 10000u); // the others stay in their places
  EXPECT_EQ(pointsOf(*world)[9999].z, 29999);
}

TEST(X3dXml, LongRunsOfNumbersOutsideOfAttributesStay) {
  const std::string run = numbers(3000);
  const auto world = load(scene("<!-- '" + run + "' --><Script><![CDATA[ecmascript: a = '" + run +
                                "'; b = \"" + run + "\";]]></Script>"));
  EXPECT_EQ(messages(*world), "");
  const auto& script = *world->scope.roots.at(0);
  EXPECT_EQ(std::get<MFString>(script.get(*script.type().find("url"))).at(0),
            "ecmascript: a = '" + run + "'; b = \"" + run + "\";");
}

TEST(X3dXml, LinesOfAProgramAreThoseOfTheFile) {
  const auto world = load("<X3D version='3.3'>\n<Scene><Script url='\"a.js\"'>\n<![CDATA[\n"
                          "\necmascript:\nx]]></Script></Scene></X3D>");
  const auto& script = *world->scope.roots.at(0);
  EXPECT_EQ(std::get<MFString>(script.get(*script.type().find("url"))),
            (MFString{"a.js", "ecmascript:\nx"}));
}

TEST(X3dXml, WhiteSpaceInStringsIsAsXmlHasIt) {
  const auto world = load(scene("<WorldInfo title='a\r\nb\tc&#10;d'/>"));
  EXPECT_EQ(first<nodes::WorldInfo>(*world).title, "a b c\nd");
  const auto info = load(scene("<WorldInfo info='\"a\nb\"\n\"c\"'/>"));
  EXPECT_EQ(first<nodes::WorldInfo>(*info).info, (MFString{"a b", "c"}));
}

TEST(X3dXml, AStringWithoutQuotesIsOne) {
  const auto world = load(scene("<Anchor url='a b.wrl'/>"));
  EXPECT_EQ(first<nodes::Anchor>(*world).url, MFString{"a b.wrl"});
  EXPECT_EQ(world->diagnostics.warnings(), 1u);
  EXPECT_EQ(world->diagnostics.errors(), 0u);
}

TEST(X3dXml, TypesSayWhereTheyStand) {
  EXPECT_EQ(containerOf(*findNodeType("Box")), "geometry");
  EXPECT_EQ(containerOf(*findNodeType("Coordinate")), "coord");
  EXPECT_EQ(containerOf(*findNodeType("TextureCoordinate")), "texCoord");
  EXPECT_EQ(containerOf(*findNodeType("MovieTexture")), "texture");
  EXPECT_EQ(containerOf(*findNodeType("AudioClip")), "source");
  EXPECT_EQ(containerOf(*findNodeType("Transform")), "children");
  EXPECT_EQ(containerOf(*findNodeType("FontStyle")), "fontStyle");
}

TEST(X3dXml, AWrongContainerIsCorrected) {
  const auto world = load(scene("<Shape><Box containerField='children'/></Shape>"));
  EXPECT_NE(first<nodes::Shape>(*world).geometry, NodeRef());
  EXPECT_EQ(messages(*world), "test.x3d:1:75: warning: Shape has no field 'children'; 'Box' is put "
                              "into geometry\n");
}

TEST(X3dXml, EntitiesOfOtherFilesAreNotRead) {
  const std::string path = testing::TempDir() + "x3d-secret.txt";
  std::ofstream(path) << "secret";
  const auto world = load("<!DOCTYPE X3D [<!ENTITY e SYSTEM 'file://" + path +
                          "'>]><X3D version='3.3'><Scene><Script>&e;</Script></Scene></X3D>");
  const auto& script = *world->scope.roots.at(0);
  EXPECT_TRUE(std::get<MFString>(script.get(*script.type().find("url"))).empty());
  std::filesystem::remove(path);
}

TEST(X3dXml, EntitiesThatGrowWithoutEndAreRefused) {
  std::string text = "<!DOCTYPE X3D [<!ENTITY a0 '<Group/><Group/><Group/>'>";
  for (int i = 1; i < 30; ++i) {
    const std::string before = "&a" + std::to_string(i - 1) + ";";
    text += "<!ENTITY a" + std::to_string(i) + " '" + before + before + before + "'>";
  }
  LoadOptions options;
  options.limits.expandedNodes = 100000;
  const auto world = load(text + "]>" + scene("&a29;"), options);
  EXPECT_GE(world->diagnostics.errors(), 1u);
  EXPECT_LE(world->nodeCount, 100000u);
}

TEST(X3dXml, DeepElementsAreBounded) {
  std::string open, close;
  for (int i = 0; i < 200000; ++i) {
    open += "<Group>";
    close += "</Group>";
  }
  const auto world = load(scene(open + close + "<Box/>"));
  EXPECT_NE(messages(*world).find("nodes nested deeper than limit nesting=1000"),
            std::string::npos);
  std::string unknown = open;
  for (size_t at = 0; (at = unknown.find("Group", at)) != std::string::npos;) unknown[at] = 'Q';
  EXPECT_EQ(load(scene(unknown))->scope.roots.size(), 0u);
}

TEST(X3dXml, TheBudgetBoundsCopiesOfTheText) {
  LoadOptions options;
  options.limits.worldBytes = 100000;
  const std::string filler = "<!--" + std::string(200000, 'x') + "-->";
  EXPECT_THROW(load(filler + coordinates(numbers(3000)), options), LoadError);
  options.limits.worldBytes = 30000;
  const auto world = load(coordinates(numbers(30000)), options);
  EXPECT_NE(messages(*world).find("limit worldBytes=30000"), std::string::npos);
}

// Drafts of X3D, and files of their time, say Header.
TEST(X3dXml, AHeaderIsAHead) {
  const auto world = load("<X3D version='3.0' profile='Full'><Header><meta name='a' content='b'/>"
                          "</Header><Scene><Group DEF='G'/></Scene></X3D>");
  EXPECT_NE(messages(*world).find("warning: X3D has no Header: read as head"), std::string::npos);
  EXPECT_EQ(world->diagnostics.list().size(), 1u) << messages(*world);
  EXPECT_EQ(world->head.meta.size(), 1u);
  EXPECT_TRUE(world->scope.names.contains("G"));
}

// Files of Xj3D have values between the tags, which the standard does not know.
TEST(X3dXml, AFieldValueMayBeText) {
  const auto world = load(
      scene("<Shape><IndexedFaceSet DEF='F'><fieldValue count='3' name='coordIndex'>\n 0 1\n 2 "
            "</fieldValue>"
            "<Coordinate DEF='C'><fieldValue name='point'>\n 0 0 0, 1 0 0, 0 1 "
            "0\n</fieldValue></Coordinate>"
            "</IndexedFaceSet></Shape><Shape><Text DEF='T'><fieldValue name='string'>&quot;a&quot; "
            "&quot;b c&quot;</fieldValue></Text></Shape>"));
  EXPECT_EQ(world->diagnostics.list().size(), 1u) << messages(*world);
  EXPECT_EQ(world->diagnostics.warnings(), 1u);
  const auto& names = world->scope.names;
  EXPECT_EQ(nodeCast<nodes::IndexedFaceSet>(names.at("F"))->coordIndex, (MFInt32{0, 1, 2}));
  EXPECT_EQ(nodeCast<nodes::Coordinate>(names.at("C"))->point.size(), 3u);
  EXPECT_EQ(nodeCast<nodes::Text>(names.at("T"))->string, (MFString{"a", "b c"}));
  for (const char* wrong : {"", " \n ", "1 x 2", "<Group/>"}) {
    const auto other = load(scene(std::string("<Shape><IndexedFaceSet DEF='F'><fieldValue "
                                              "name='coordIndex'>") +
                                  wrong + "</fieldValue></IndexedFaceSet></Shape>"));
    EXPECT_GE(other->diagnostics.errors(), 1u) << wrong;
    EXPECT_EQ(nodeCast<nodes::IndexedFaceSet>(other->scope.names.at("F"))->coordIndex.size(),
              wrong == std::string("1 x 2") ? 3u : 0u);
  }
}

TEST(X3dXml, AFileThatEndsEarlyKeepsWhatItHas) {
  const std::string whole =
      scene("<Group DEF='A'><Shape><Box size='1 2 3'/></Shape></Group><Transform DEF='B'/>"
            "<ProtoDeclare name='P'><ProtoInterface><field accessType='inputOutput' "
            "type='SFNode' name='n'><Group/></field></ProtoInterface><ProtoBody><Group><IS>"
            "<connect nodeField='children' protoField='n'/></IS></Group></ProtoBody>"
            "</ProtoDeclare><ProtoInstance name='P'><fieldValue name='n'><Group/></fieldValue>"
            "</ProtoInstance><Script><![CDATA[ecmascript:]]></Script>");
  for (size_t size = 30; size < whole.size(); ++size) {
    const auto world = load(whole.substr(0, size));
    EXPECT_GE(world->diagnostics.errors(), 1u) << size;
    const auto again = loadWorldFromMemory(writeWorld(*world), "a.wrl");
    EXPECT_TRUE(equalScopes(world->scope, again->scope)) << size;
  }
  EXPECT_EQ(load(whole.substr(0, whole.find("<Transform")))->scope.roots.size(), 1u);
}

TEST(X3dXml, DamagedBytesNeverStopTheReader) {
  const std::string whole =
      scene("<Group DEF='A'><Shape><Box size='1 2 3'/></Shape></Group><Group USE='A'/>"
            "<ROUTE fromNode='A' fromField='children' toNode='A' toField='children'/>"
            "<ProtoDeclare name='P'><ProtoBody><Group/></ProtoBody></ProtoDeclare>"
            "<ProtoInstance name='P'/>");
  for (size_t at = 0; at < whole.size(); ++at) {
    for (const char c : {'<', '>', '\'', '&', '\0', ' ', '\xff', '1', '/'}) {
      std::string text = whole;
      text[at] = c;
      try {
        const auto world = load(text);
        EXPECT_NO_THROW(writeWorld(*world));
      } catch (const LoadError&) {} // its first bytes do not say X3D
    }
  }
}

} // namespace
