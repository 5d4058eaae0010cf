// xvrml_x3d.cpp: files in X3D ClassicVRML: how they are found out, what their head says, and the
// messages about what X3D has and this library lacks.
#include <algorithm>

#include <gtest/gtest.h>

#include "base/x3d.h"
#include "nodes/registry.h"
#include "xvrml/nodes.h"
#include "xvrml/world.h"

namespace {

using namespace xvrml;
using Messages = std::vector<std::string>;

std::unique_ptr<World> load(std::string text, const std::string& name = "test.x3dv") {
  return loadWorldFromMemory(text, name);
}

Messages messagesOf(const World& world) {
  Messages all;
  for (const Diagnostic& one : world.diagnostics.list())
    all.push_back(one.text().substr(0, one.text().find('\n')));
  return all;
}

TEST(X3d, ContentDecidesBeforeTheSuffix) {
  EXPECT_EQ(load("#X3D V3.2 utf8\nGroup { }", "a.wrl")->head.version,
            (FileVersion{Encoding::x3dClassic, 3, 2}));
  EXPECT_EQ(load("#VRML V2.0 utf8\nGroup { }", "a.x3dv")->head.version, FileVersion());
  const auto headless = load("Group { }", "a.x3dv");
  EXPECT_EQ(headless->head.version, (FileVersion{Encoding::x3dClassic, 3, 3}));
  EXPECT_EQ(messagesOf(*headless), Messages{"a.x3dv:1:1: warning: the header '#X3D V3.3 utf8' is "
                                            "missing; read as X3D 3.3 anyway"});
  EXPECT_TRUE(load("PROFILE Core\nGroup { }", "a.wrl")->head.version.isX3d());
  EXPECT_FALSE(load("Group { }", "a.wrl")->head.version.isX3d());
}

TEST(X3d, HeadersThatDiffer) {
  for (const char* good : {"#X3D V3.0 utf8\n", "#X3D V3.3 utf8 Titania V1.2\r\n", "#X3D V4.0 utf8",
                           "\n\n#X3D V3.1 utf8\n"}) {
    const auto world = load(good);
    EXPECT_EQ(messagesOf(*world), Messages()) << good;
    EXPECT_TRUE(world->head.version.isX3d());
  }
  for (const char* odd : {"#X3D\n", "#X3D V\n", "#X3D V3\n", "#X3D V3.3 iso8859\n",
                          "#X3D V9.0 utf8\n", "#X3D V2.0 utf8\n", "#X3Dx"}) {
    const auto world = load(odd);
    EXPECT_EQ(world->diagnostics.warnings(), 1u) << odd;
    EXPECT_TRUE(world->head.version.isX3d()) << odd;
    EXPECT_LE(world->head.version.major, 4);
  }
}

TEST(X3d, TheHeadIsKept) {
  const auto world =
      load("#X3D V3.3 utf8\nPROFILE Interchange\nCOMPONENT Text:1\nCOMPONENT Shape : 3\n"
           "UNIT length foot 0.3048\nMETA \"a\" \"b\"\nMETA \"a\" \"c\"\nGroup { }");
  const FileHead& head = world->head;
  EXPECT_EQ(head.profile, "Interchange");
  ASSERT_EQ(head.components.size(), 2u);
  EXPECT_EQ(head.components[0].name, "Text");
  EXPECT_EQ(head.components[1].name, "Shape");
  EXPECT_EQ(head.components[1].level, 3);
  ASSERT_EQ(head.units.size(), 1u);
  EXPECT_EQ(head.units[0].factor, 0.3048);
  ASSERT_EQ(head.meta.size(), 2u);
  EXPECT_EQ(head.meta[1].content, "c");
  EXPECT_EQ(messagesOf(*world), Messages());
  EXPECT_TRUE(versionOf(*world->scope.roots[0]).isX3d());
}

TEST(X3d, MissingNodesAndFieldsAreSaidOnce) {
  const auto world = load("#X3D V3.3 utf8\nCollisionSpace { }\nDEF L LinePickSensor { }\n"
                          "LinePickSensor { }\nShape { geometry PointSet { normal NULL } }\n"
                          "Shape { geometry PointSet { normal NULL } }\n"
                          "ROUTE L.enabled TO L.enabled");
  EXPECT_EQ(
      messagesOf(*world),
      (Messages{"test.x3dv:2:1: warning: nodes of type 'CollisionSpace' (physics) are not "
                "supported and are left out here and below, with all that they hold: bodies do not "
                "move",
                "test.x3dv:3:7: warning: nodes of type 'LinePickSensor' (sensor) are not supported "
                "and are left out here and below, with all that they hold: it sends no events",
                "test.x3dv:5:29: warning: field 'normal' of PointSet is not "
                "supported: it is left out here and below",
                "test.x3dv:7:7: warning: 'L' was left out above"}));
  EXPECT_EQ(world->scope.roots.size(), 2u);
}

// Nodes that one browser has are known by name, so that the message says whose they are. A file of
// VRML97 that does not declare them is wrong (4.9), and keeps what such a node holds.
TEST(X3d, NodesOfOtherBrowsersAreKnownByName) {
  const std::string text = "Shape { geometry Teapot { } }\nShape { geometry Teapot { } }\n"
                           "TouchGroup { children Shape { } }";
  const auto world = load("#X3D V3.3 utf8\n" + text);
  EXPECT_EQ(
      messagesOf(*world),
      (Messages{"test.x3dv:2:18: warning: nodes of type 'Teapot' (geometry of Castle Game "
                "Engine) are not supported and are left out here and below, with all that "
                "they hold: Shapes with it are not drawn",
                "test.x3dv:4:1: warning: nodes of type 'TouchGroup' (grouping of Titania) are "
                "not supported and are left out here and below, with all that they hold: what "
                "it holds is not drawn"}));
  EXPECT_EQ(world->diagnostics.errors(), 0u);
  const auto older = load("#VRML V2.0 utf8\n" + text, "a.wrl");
  EXPECT_EQ(older->diagnostics.errors(), 3u);
  EXPECT_NE(nodeCast<nodes::Group>(older->scope.roots.back()), nullptr);
}

// Clause 31: programs for graphics processors are reported once, however many a file has.
TEST(X3d, ProgramsForGraphicsProcessorsAreSaidOnce) {
  const auto world = load("#X3D V3.3 utf8\nShape { appearance Appearance { shaders [ DEF S "
                          "ComposedShader { parts ShaderPart { } } ] material DEF M Material { } "
                          "}\n geometry IndexedFaceSet { attrib [ ] } }\n"
                          "Shape { appearance Appearance { shaders [ ] } }");
  EXPECT_EQ(messagesOf(*world),
            (Messages{"test.x3dv:2:33: warning: 'shaders' is a part of a program for graphics "
                      "processors: such programs are not run, and shapes look as their materials "
                      "say"}));
  EXPECT_NE(world->scope.names.find("M"), world->scope.names.end());
}

// The reader knows imported names. conformance/events/imports.cpp tests the routes to them.
TEST(X3d, ImportedNamesAreNamesForRoutes) {
  const auto world =
      load("#X3D V3.3 utf8\nDEF I Inline { }\nIMPORT I.Arm AS A\nDEF T Transform { }\n"
           "ROUTE A.translation TO T.translation\nPROTO P [ ] { DEF I Inline { }\nIMPORT I.Arm\n"
           "ROUTE Arm.translation TO I.url }");
  EXPECT_EQ(messagesOf(*world),
            (Messages{"test.x3dv:7:1: warning: IMPORT in a prototype is not supported: what refers "
                      "to 'Arm' is left out",
                      "test.x3dv:8:7: warning: 'Arm' was left out above"}));
}

// VRML97 keeps its own rules: none of X3D's words is accepted there.
TEST(X3d, NothingOfItIsReadInVrml97) {
  for (const char* text :
       {"Switch { children Group { } }", "PROTO P [ inputOnly SFBool b ] { Group { } }",
        "VolumeData { }", "DEF S Script { inputOnly SFBool b }"})
    EXPECT_GT(load(std::string("#VRML V2.0 utf8\n") + text)->diagnostics.errors(), 0u) << text;
}

// Nodes and fields that X3D adds and this library has work in VRML97, too. Other browsers would not
// know it, so each name is reported once in a file.
TEST(X3d, NodesAndFieldsOfItWorkInVrml97WithAWarning) {
  const char* const text =
      "StaticGroup { children Shape { geometry DEF S Sphere { solid FALSE } } }\n"
      "StaticGroup { }\nShape { geometry Sphere { solid FALSE } }\n"
      "PROTO P [ field SFBool solid FALSE ] { Shape { geometry Box { "
      "solid IS solid } } }";
  const auto world = load(std::string("#VRML V2.0 utf8\n") + text, "a.wrl");
  EXPECT_EQ(messagesOf(*world),
            (Messages{"a.wrl:2:1: warning: 'StaticGroup' is a node of X3D: other browsers of "
                      "VRML97 do not know it",
                      "a.wrl:2:56: warning: 'solid' is a field that X3D adds to Sphere: other "
                      "browsers of VRML97 do not know it",
                      "a.wrl:5:63: warning: 'solid' is a field that X3D adds to Box: other "
                      "browsers of VRML97 do not know it"}));
  ASSERT_EQ(world->scope.roots.size(), 3u);
  EXPECT_FALSE(nodeCast<nodes::Sphere>(world->scope.names.at("S"))->solid);
  std::string inX3d = text;
  inX3d.replace(inX3d.find("field SFBool"), 5, "initializeOnly");
  EXPECT_EQ(messagesOf(*load("#X3D V3.3 utf8\n" + inX3d)), Messages());
}

// VRML97 does not know the names of X3D's nodes, so its prototypes may have them.
TEST(X3d, PrototypesTakeItsNamesInVrml97) {
  const auto world =
      load("#VRML V2.0 utf8\nPROTO StaticGroup [ field SFFloat height 2 ] { Group { } }\n"
           "EXTERNPROTO TriangleSet [ ] \"none.wrl\"\nStaticGroup { height 1 }",
           "a.wrl");
  EXPECT_EQ(messagesOf(*world), Messages());
  ASSERT_EQ(world->scope.roots.size(), 1u);
  EXPECT_LT(world->scope.roots[0]->type().index, 0);
}

// The lists of what X3D has and this library lacks name nothing that it has.
TEST(X3d, NothingThatIsThereIsListedAsMissing) {
  for (const NodeType* type : nodeTypes()) {
    EXPECT_EQ(findAbsentNode(type->name), nullptr) << type->name;
    for (const FieldInfo& field : type->fields)
      EXPECT_FALSE(isX3dField(type->name, field.name)) << type->name << '.' << field.name;
  }
}

// Groups without an implementation keep what they hold. A message for each type says
// what is not done.
TEST(X3d, GroupsWithoutImplementationKeepWhatTheyHold) {
  const auto world =
      load("#X3D V3.3 utf8\nLayerSet { order [ 1 ] layers Layer { children DEF A "
           "Group { } } }\nPickableGroup { children DEF B Group { } }\n"
           "PickableGroup { children USE A }\n"
           "HAnimHumanoid { skinCoord DEF C Coordinate { } skin Shape { geometry "
           "PointSet { coord USE C } } joints USE J skeleton DEF K HAnimJoint { } }\n"
           "RigidBodyCollection { bodies RigidBody { geometry DEF D CollidableShape "
           "{ } } }");
  EXPECT_EQ(
      messagesOf(*world),
      (Messages{"test.x3dv:2:1: warning: 'LayerSet' is not supported wholly: its layers are drawn "
                "in the space of the world, in one picture",
                "test.x3dv:2:31: warning: 'Layer' is not supported wholly: it is drawn in the "
                "space of the world, without a viewport or a viewpoint of its own",
                "test.x3dv:3:1: warning: 'PickableGroup' is not supported wholly: all picking "
                "sensors see its children",
                "test.x3dv:5:108: error: no node is named 'J' by a DEF above",
                "test.x3dv:6:1: warning: 'RigidBodyCollection' is not supported wholly: bodies do "
                "not move",
                "test.x3dv:6:57: warning: 'CollidableShape' is not supported wholly: it does not "
                "move by itself"}));
  for (const char* name : {"A", "B", "C", "D", "K"})
    EXPECT_TRUE(world->scope.names.contains(name)) << name;
}

// A written world is VRML97, whatever it was read from.
TEST(X3d, IsWrittenAsVrml97) {
  const auto world = load("#X3D V3.3 utf8 by hand\n# a comment\nSwitch { children Group { } }");
  EXPECT_TRUE(writeWorld(*world).starts_with("#VRML V2.0 utf8\n# a comment\n"))
      << writeWorld(*world);
  EXPECT_EQ(load(writeWorld(*world))->diagnostics.list().size(), 0u);
}

} // namespace
