// xvrml_values_kept.cpp: what is left of a world in which a value, a number of a list or a
// statement cannot be read: all but that. Every error is still reported, in its place.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "xvrml/nodes.h"
#include "xvrml/world.h"

namespace {

using namespace xvrml;

struct Read {
  std::unique_ptr<World> world;
  std::string errors; // "line:column message", one in each line

  explicit Read(const std::string& text, const std::string& name = "a.wrl")
      : world(loadWorldFromMemory(text, name)) {
    for (const Diagnostic& one : world->diagnostics.list())
      errors += fmt::format("{}:{} {}\n", one.line, one.column, one.message);
  }
  template <class T> T* node(size_t root = 0) const {
    const auto& roots = world->scope.roots;
    return root < roots.size() ? nodeCast<T>(roots[root].get()) : nullptr;
  }
  template <class T> T* named(const char* name) const {
    const auto found = world->scope.names.find(name);
    return found == world->scope.names.end() ? nullptr : nodeCast<T>(found->second.get());
  }
};

Read vrml(const std::string& text) { return Read("#VRML V2.0 utf8\n" + text); }
// The node of a face set that stands in a field, on a line of its own.
Read faces(const std::string& fields) {
  return vrml("Shape { geometry DEF F IndexedFaceSet {\n" + fields + "\n} }\nDEF G Group { }");
}

TEST(ValuesKept, AValueThatCannotBeReadCostsItselfAlone) {
  for (const char* value :
       {"nan 0 0", "1.0f 0 0", "1.0D+00 0 0", "-1.#IND00 0 0", "1 2", "1 2 3 4", "TRUE",
        "\"1 2 3\"", "[ 1 2 3 ]", "1e99 0 0", "", "Box { }", "5 { 6 }"}) {
    const Read r = vrml(fmt::format("Transform {{ scale 2 2 2 translation {} rotation 0 1 0 1 "
                                    "children [ Group {{ }} DEF T Transform {{ }} ] }} Group {{ }}",
                                    value));
    EXPECT_NE(r.errors, "") << value;
    auto* transform = r.node<nodes::Transform>();
    ASSERT_TRUE(transform) << value;
    EXPECT_EQ(transform->children.size(), 2u) << value << r.errors;
    EXPECT_EQ(transform->scale, (Vec3f{2, 2, 2})) << value;
    EXPECT_EQ(transform->rotation, (Rotation{0, 1, 0, 1})) << value << r.errors;
    const bool superfluous = value == std::string("1 2 3 4");
    EXPECT_EQ(transform->translation, (superfluous ? Vec3f{1, 2, 3} : Vec3f{})) << value;
    EXPECT_TRUE(r.node<nodes::Group>(1)) << value << r.errors;
  }
}

TEST(ValuesKept, OtherTypesToo) {
  const Read r = vrml("NavigationInfo { headlight 0 speed 3 type FLY visibilityLimit 5 }\n"
                      "Switch { whichChoice one choice [ Group { } ] }\n"
                      "DEF S Shape { appearance 7 geometry Box { size 1 2 3 } }\n"
                      "Group { children DEF G Group { } bboxSize 1 }");
  auto* info = r.node<nodes::NavigationInfo>();
  ASSERT_TRUE(info && r.node<nodes::Switch>(1) && r.named<nodes::Shape>("S"));
  EXPECT_EQ(info->speed, 3);
  EXPECT_EQ(info->visibilityLimit, 5);
  EXPECT_TRUE(info->headlight);
  EXPECT_EQ(r.node<nodes::Switch>(1)->choice.size(), 1u);
  EXPECT_TRUE(r.named<nodes::Shape>("S")->geometry);
  EXPECT_EQ(r.node<nodes::Group>(3)->children.size(), 1u);
  EXPECT_EQ(std::count(r.errors.begin(), r.errors.end(), '\n'), 5) << r.errors; // no more follow
}

TEST(ValuesKept, AnElementThatCannotBeReadCostsItselfAlone) {
  const Read r = faces("coord DEF C Coordinate { point [ 0 0 0, nan 1 0, 1 1 1, 2 2 x, 3 3 3 ] }\n"
                       "coordIndex [ 0 1 one -1 2 3 4 -1 ]\n"
                       "color DEF K Color { color [ 1 0 0, 0 1.#QNAN 0, 0 0 1 ] }");
  EXPECT_NE(r.errors.find("3:41 expected a component"), std::string::npos) << r.errors;
  EXPECT_NE(r.errors.find("3:61 1 more of this list cannot be read"), std::string::npos)
      << r.errors;
  const MFVec3f& points = r.named<nodes::Coordinate>("C")->point;
  ASSERT_EQ(points.size(), 5u);
  EXPECT_TRUE(std::isnan(points[1].x) && std::isnan(points[3].x));
  EXPECT_EQ(points[4], (Vec3f{3, 3, 3}));
  const MFInt32& index = r.named<nodes::IndexedFaceSet>("F")->coordIndex;
  ASSERT_EQ(index.size(), 8u);
  EXPECT_GT(index[2], 1'000'000); // no list has it, so that nothing is drawn there
  EXPECT_EQ(index[6], 4);
  EXPECT_EQ(r.named<nodes::Color>("K")->color, (MFColor{{1, 0, 0}, {0, 0, 0}, {0, 0, 1}}));
  const Read texts = vrml("DEF W WorldInfo { info [ \"a\" 5 \"b\" ] }");
  EXPECT_EQ(texts.named<nodes::WorldInfo>("W")->info, (MFString{"a", "b"})) << texts.errors;
}

TEST(ValuesKept, NumbersLeftOverCountForNothing) {
  for (const char* rest : {"7", "7 8", "7 nan"}) {
    const Read r =
        faces(fmt::format("coord DEF C Coordinate {{ point [ 0 0 0, 1 1 1, {} ] }}", rest));
    EXPECT_NE(r.errors.find("left over"), std::string::npos) << r.errors;
    EXPECT_EQ(r.named<nodes::Coordinate>("C")->point.size(), 2u) << rest;
    EXPECT_TRUE(r.named<nodes::Group>("G"));
  }
}

TEST(ValuesKept, AListEndsWhereItsBracketIsMissing) {
  const Read r = faces("coordIndex [ 0 1 x -1 convex FALSE");
  EXPECT_EQ(r.named<nodes::IndexedFaceSet>("F")->coordIndex.size(), 4u) << r.errors;
  EXPECT_FALSE(r.named<nodes::IndexedFaceSet>("F")->convex);
  EXPECT_TRUE(r.named<nodes::Group>("G"));
  const Read end =
      vrml("Shape { geometry IndexedFaceSet { coord DEF C Coordinate { point [ 0 0 0, 1 1 "
           "1, 2 2");
  EXPECT_EQ(end.named<nodes::Coordinate>("C")->point.size(), 2u) << end.errors;
}

TEST(ValuesKept, NumbersOfOldCLibrariesAreNoComments) {
  const Read r =
      faces("coord DEF C Coordinate { point [ -1.#IND00 0 1.#QNAN0, 1 1 1 #INF\n, 2 2 2 ] }");
  EXPECT_EQ(r.named<nodes::Coordinate>("C")->point.size(), 3u) << r.errors;
  const Read comment = faces("coord DEF C Coordinate { point [ 1 1 1#a\n 2 2 2# INF\n ] }");
  EXPECT_EQ(comment.named<nodes::Coordinate>("C")->point.size(), 2u) << comment.errors;
  EXPECT_EQ(comment.errors, "");
}

TEST(ValuesKept, RoutesAndPrototypesInListsOfNodes) {
  const Read r = vrml("Group { children [ DEF T TimeSensor { }\nPROTO P [ ] { Group { } }\nDEF I "
                      "ScalarInterpolator { }\nROUTE T.fraction_changed TO I.set_fraction\nDEF U P "
                      "{ } ROUTE T DEF G Group { } ] }");
  EXPECT_EQ(r.world->scope.routes.size(), 1u) << r.errors;
  EXPECT_NE(r.errors.find("5:1 ROUTE cannot stand in a list of nodes"), std::string::npos);
  EXPECT_NE(r.errors.find("3:1 PROTO cannot stand in a list of nodes"), std::string::npos);
  EXPECT_TRUE(r.world->scope.names.contains("G")) << r.errors;
  EXPECT_EQ(r.node<nodes::Group>()->children.size(), 4u) << r.errors;
}

TEST(ValuesKept, InterfacesOfScriptsAndPrototypes) {
  const Read r =
      vrml("DEF S Script { field SFVec3f v nan 0 0 field MFInt32 l [ 1 x 3 ] field SFBool b "
           "maybe field SFFloat f 2 eventIn SFBool in url \"javascript:\" }\n"
           "PROTO P [ field SFVec3f v 1 nan 3 exposedField MFFloat l [ 1 x ] eventIn SFBool "
           "in field SFFloat f 2 ] { Group { } }\nDEF I P { v 1 2 3 f 5 }");
  const auto& script = *r.world->scope.names.at("S");
  const auto value = [](const Node& node, const char* name) {
    const FieldInfo* field = node.type().find(name);
    return field ? node.get(*field) : Value(false);
  };
  EXPECT_EQ(value(script, "v"), Value(Vec3f{}));
  EXPECT_EQ(std::get<MFInt32>(value(script, "l")).size(), 3u);
  EXPECT_EQ(value(script, "f"), Value(2.0f)) << r.errors;
  EXPECT_EQ(value(script, "url"), Value(MFString{"javascript:"}));
  EXPECT_TRUE(script.type().findEventIn("in"));
  const auto& instance = *r.world->scope.names.at("I");
  EXPECT_EQ(value(instance, "v"), Value(Vec3f{1, 2, 3})) << r.errors;
  EXPECT_EQ(value(instance, "f"), Value(5.0f));
  EXPECT_EQ(std::get<MFFloat>(value(instance, "l")).size(), 2u);
}

TEST(ValuesKept, StatementsInNodesThatCannotBeRead) {
  const Read r = vrml("DEF G Group { ROUTE x bboxSize 1 1 1 7 \"a\" ] children DEF T Transform { "
                      "translation IS 5 scale 2 2 2 } }");
  ASSERT_TRUE(r.named<nodes::Group>("G") && r.named<nodes::Transform>("T")) << r.errors;
  EXPECT_EQ(r.named<nodes::Group>("G")->bboxSize, (Vec3f{1, 1, 1})) << r.errors;
  EXPECT_EQ(r.named<nodes::Transform>("T")->scale, (Vec3f{2, 2, 2})) << r.errors;
}

TEST(ValuesKept, TheSameInXmlAndVrml1) {
  const Read xml("<X3D version='3.3'><Scene><Shape><IndexedFaceSet coordIndex='0 1 2 -1 0 x 2 -1'>"
                 "<Coordinate DEF='C' point='0 0 0, 1 0 0, 1 1 nan, 7'/></IndexedFaceSet></Shape>"
                 "</Scene></X3D>",
                 "a.x3d");
  EXPECT_EQ(xml.named<nodes::Coordinate>("C")->point.size(), 3u) << xml.errors;
  const Read old("#VRML V1.0 ascii\nSeparator { Coordinate3 { point [ 0 0 0, 1 0 0, 1 1 0, 7 ] } "
                 "IndexedFaceSet { coordIndex [ 0 1 2 -1 ] } }",
                 "a.wrl");
  EXPECT_NE(writeWorld(*old.world).find("1 1 0 ]"), std::string::npos) << writeWorld(*old.world);
}

TEST(ValuesKept, ColoursAsPagesWriteThem) {
  const auto colour = [](const char* text) {
    const Read r(fmt::format("<X3D version='3.3'><Scene><Shape><Appearance><Material DEF='M' "
                             "emissiveColor='{}'/></Appearance></Shape></Scene></X3D>",
                             text),
                 "a.x3d");
    EXPECT_NE(r.errors.find("#"), std::string::npos) << r.errors;
    return r.named<nodes::Material>("M")->emissiveColor;
  };
  EXPECT_EQ(colour("#FF0000"), (Color{1, 0, 0}));
  EXPECT_EQ(colour(" #00ff33 "), (Color{0, 1, 0.2f}));
  EXPECT_EQ(colour("#FF00"), Color{});
}

TEST(ValuesKept, PaddingBehindTheEndIsNoContent) {
  const char* const texts[][2] = {{"#VRML V2.0 utf8\nGroup { }\r\n\x1a", "a.wrl"},
                                  {"#VRML V1.0 ascii\nSeparator { }\x1a\x1a", "a.wrl"},
                                  {"#X3D V3.3 utf8\nPROFILE Full\nGroup { }\n\x1a\n", "a.x3dv"},
                                  {"<X3D version='3.3'><Scene/></X3D>\n\x1a", "a.x3d"},
                                  {R"({"X3D":{"@version":"3.3","Scene":{}}})"
                                   "\x1a",
                                   "a.x3dj"},
                                  {"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n\x1a", "a.obj"},
                                  {"solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex "
                                   "1 0 0\nvertex 0 1 0\nendloop\n"
                                   "endfacet\nendsolid a\n\x1a",
                                   "a.stl"},
                                  {R"({"asset":{"version":"2.0"}})"
                                   "\x1a",
                                   "a.gltf"},
                                  {"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n\x1a", "a.off"},
                                  {"ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\n"
                                   "property float y\nproperty float z\nend_header\n0 0 0\n\x1a",
                                   "a.ply"}};
  for (const auto& [text, name] : texts) {
    EXPECT_EQ(Read(text, name).errors, "") << name;
    // Files of CP/M and of tapes end with a whole sector.
    const std::string zeros(100, '\0');
    EXPECT_EQ(Read(text + zeros, name).errors, "") << name;
    std::string plain = text;
    plain.erase(plain.find('\x1a'));
    EXPECT_EQ(Read(plain + zeros, name).errors, "") << name;
    EXPECT_EQ(Read(plain + zeros + "\r\n", name).errors, "") << name;
  }
  // Zeros before other text are no padding.
  EXPECT_NE(vrml("Group { }" + std::string(9, '\0') + "Group { }").errors, "");
}

TEST(ValuesKept, ChildrenOfUnknownNodes) {
  const Read r =
      vrml("DEF M MegaGroup { power 9 label \"} children [\" parts [ Gear { children Fog { "
           "} } ]\n children [ DEF A Group { } Gear { children DEF B Group { } } ]\n"
           "  bboxSize 1 2 3 glow 1 mood NULL other DEF X Group { } }\nDEF C Group { }");
  EXPECT_EQ(r.errors, "2:7 'MegaGroup' is not a known node type\n"
                      "3:29 'Gear' is not a known node type\n");
  ASSERT_EQ(r.world->scope.roots.size(), 2u) << writeWorld(*r.world);
  auto* const kept = r.node<nodes::Group>();
  ASSERT_TRUE(kept && r.named<nodes::Group>("C"));
  EXPECT_EQ(kept->bboxSize, (Vec3f{-1, -1, -1})); // no field of the unknown node but its children
  ASSERT_EQ(kept->children.size(), 2u) << writeWorld(*r.world);
  EXPECT_EQ(kept->children[0].get(), r.named<nodes::Group>("A"));
  auto* const inner = nodeCast<nodes::Group>(kept->children[1].get());
  ASSERT_TRUE(inner && inner->children.size() == 1);
  EXPECT_EQ(inner->children[0].get(), r.named<nodes::Group>("B"));
  EXPECT_FALSE(r.named<nodes::Group>("X"));
}

TEST(ValuesKept, UnknownNodesWhereNoGroupMayStandAreLeftOut) {
  const Read r = vrml("Shape { appearance Look { children [ Group { } ] } geometry Box { } }\n"
                      "Collision { proxy Gear { } children [ DEF A Group { } ] }\n"
                      "Gear { children 5 }\nGear { size 1 }\nDEF B Group { }");
  EXPECT_EQ(r.errors, "2:20 'Look' is not a known node type\n3:19 'Gear' is not a known node type\n"
                      "4:1 'Gear' is not a known node type\n5:1 'Gear' is not a known node type\n");
  EXPECT_EQ(r.world->scope.roots.size(), 3u) << writeWorld(*r.world);
  EXPECT_TRUE(r.named<nodes::Group>("A") && r.named<nodes::Group>("B"));
  // Braces that are missing lose no more than in other nodes.
  const Read open = vrml("Group { children [ Gear { children [ DEF A Group { } ]\n ] }\n"
                         "DEF C Group { }");
  EXPECT_TRUE(open.named<nodes::Group>("A") && open.named<nodes::Group>("C")) << open.errors;
}

TEST(ValuesKept, UnknownNodesTakeLinearTime) {
  std::string deep, wide;
  for (int i = 0; i < 2000; ++i) deep += "Gear { a [ 1 2 3 ] children [ ";
  for (int i = 0; i < 100'000; ++i) wide += "Gear { a 1 ";
  EXPECT_GT(vrml(deep).world->diagnostics.errors(), 0u);
  EXPECT_GT(vrml(wide).world->diagnostics.errors(), 0u);
}

// --- Names of files ---

class FilesNamed : public testing::Test {
 protected:
  // Each test has a folder of its own: tests run side by side.
  std::string folder = testing::TempDir() + "files_named_" +
                       testing::UnitTest::GetInstance()->current_test_info()->name() + "/";
  void SetUp() override {
    std::filesystem::create_directories(folder + "Maps");
    for (const char* name : {"Maps/Red.PNG", "a#1.png", "b.wrl", "B2.WRL"})
      std::ofstream(folder + name) << "x";
  }
  void TearDown() override { std::filesystem::remove_all(folder); }
  std::string found(const char* url) const {
    const ResolvedUrl resolved = resolveUrl(url, folder + "world.wrl", {});
    return resolved.path.substr(folder.size()) +
           (resolved.fragment.empty() ? "" : " " + resolved.fragment);
  }
};

TEST_F(FilesNamed, InAnotherCaseAreFound) {
  EXPECT_EQ(found("maps/red.png"), "Maps/Red.PNG");
  EXPECT_EQ(found("MAPS\\RED.png"), "Maps/Red.PNG");
  EXPECT_EQ(found("./maps/../maps/red.png"), "./Maps/../Maps/Red.PNG");
  EXPECT_EQ(found("b2.wrl#View"), "B2.WRL View");
  EXPECT_EQ(found("c.wrl"), "c.wrl"); // as it is written, for the message
  std::ofstream(folder + "MAPS.TXT") << "x";
  EXPECT_EQ(found("maps.txt"), "MAPS.TXT"); // also a file that has come since
}

TEST_F(FilesNamed, WithAHashAreFound) {
  EXPECT_EQ(found("a#1.png"), "a#1.png");
  EXPECT_EQ(found("A#1.PNG"), "a#1.png");
  EXPECT_EQ(found("a%231.png"), "a#1.png");
  EXPECT_EQ(found("b.wrl#1.png"), "b.wrl 1.png");
}

} // namespace
