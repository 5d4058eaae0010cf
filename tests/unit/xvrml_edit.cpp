// xvrml_edit.cpp: Tests edits of a world's file: what becomes of its text, undo, and what is
// refused.
#include "edit/gzip.h"
#include <thread>

#include "unit/xvrml_edit_support.h"

namespace {

using namespace edit_test;

INSTANTIATE_TEST_SUITE_P(World, Edited, testing::Bool(),
                         [](const auto& info) { return info.param ? "Running" : "Resting"; });

TEST_P(Edited, AValueChangesInItsPlace) {
  load("# a lamp\nDEF L PointLight {\n  intensity 0.50 # half\n\tlocation 0 1 0\n}\n");
  editor->set(node("L"), "intensity", 0.75f);
  EXPECT_EQ(text(), "# a lamp\nDEF L PointLight {\n  intensity 0.75 # half\n\tlocation 0 1 0\n}\n");
  EXPECT_EQ((field<SFFloat>(node("L"), "intensity")), 0.75f);
  EXPECT_TRUE(editor->isChanged());
  EXPECT_EQ(editor->undoName(), "Set PointLight.intensity");
  undoAll();
}

// Axes are normalised when they are read, so no component of an old one may stay beside a new one.
TEST_P(Edited, AnAxisOfAnotherLengthIsReplacedAsAWhole) {
  load("DEF T Transform { rotation 1 1 0 .5 }\n"
       "DEF O OrientationInterpolator { key [ 0, 1 ] keyValue [ 1 1 0 .5, 1 1 0 1 ] }\n");
  editor->set(node("T"), "rotation", Rotation{1, 0, 1, .5f});
  editor->set(node("O"), "keyValue", MFRotation{{0, 0, 1, .5f}, {.70710678f, .70710678f, 0, 2}});
  EXPECT_NE(text().find("keyValue [ 0 0 1 .5, 1 1 0 2 ]"), std::string::npos) << text();
  undoAll();
}

TEST_P(Edited, AbsentFieldsAreAdded) {
  load("Transform {\n    children [\n        DEF L PointLight { intensity 0 }\n"
       "        DEF M PointLight {}\n        DEF N PointLight {\n            intensity 0\n"
       "        }\n        DEF O PointLight {\n        }\n    ]\n}\n");
  for (const char* name : {"L", "M", "N", "O"}) editor->set(node(name), "radius", 5.f);
  EXPECT_EQ(text(),
            "Transform {\n    children [\n        DEF L PointLight { intensity 0 radius 5 }\n"
            "        DEF M PointLight { radius 5 }\n        DEF N PointLight {\n"
            "            intensity 0\n            radius 5\n"
            "        }\n        DEF O PointLight {\n          radius 5\n        }\n    ]\n}\n");
  undoAll();
}

TEST_P(Edited, NodesAreInsertedRemovedAndMoved) {
  load("DEF G Group {\n  children [\n    DEF A Shape { } # the first\n    DEF B Shape { }\n"
       "  ]\n}\nDEF H Group { children [ ] }\nDEF I Group { }\n");
  editor->insert({&node("G"), "children", 1}, "DEF C Shape { geometry Box { } }");
  EXPECT_EQ(text(), "DEF G Group {\n  children [\n    DEF A Shape { } # the first\n"
                    "    DEF C Shape { geometry Box { } }\n    DEF B Shape { }\n"
                    "  ]\n}\nDEF H Group { children [ ] }\nDEF I Group { }\n");
  undoAll();
  editor->remove({&node("G"), "children", 2});
  EXPECT_EQ(text(), "DEF G Group {\n  children [\n    DEF A Shape { } # the first\n"
                    "    DEF C Shape { geometry Box { } }\n"
                    "  ]\n}\nDEF H Group { children [ ] }\nDEF I Group { }\n");
  editor->move({&node("G"), "children", 0}, {&node("H"), "children", 0});
  EXPECT_EQ(text(), "DEF G Group {\n  children [\n"
                    "    DEF C Shape { geometry Box { } }\n"
                    "  ]\n}\nDEF H Group { children [\n  DEF A Shape { } # the first\n] }\n"
                    "DEF I Group { }\n");
  editor->move({&node("H"), "children", 0}, {&node("I"), "children", 0});
  editor->move({nullptr, "", 0}, {nullptr, "", 2});
  EXPECT_EQ(field<MFNode>(node("I"), "children").size(), 1u);
  EXPECT_EQ(field<MFNode>(node("H"), "children").size(), 0u);
  undoAll();
}

TEST_P(Edited, RootsAreInsertedAndRemoved) {
  load("DEF A Group { }\n\n# of B\nDEF B Group { }\n");
  editor->insert({nullptr, "", 0}, "DEF C Group { }");
  editor->insert({nullptr, "", 3}, "DEF D Group { }");
  EXPECT_EQ(text(),
            "DEF C Group { }\nDEF A Group { }\n\n# of B\nDEF B Group { }\nDEF D Group { }\n");
  editor->remove({nullptr, "", 1});
  editor->remove({nullptr, "", 1});
  EXPECT_EQ(text(), "DEF C Group { }\n\nDEF D Group { }\n");
  undoAll();
}

TEST_P(Edited, ANodeThatStandsElsewhereStays) {
  load("DEF G Group { children [ DEF S Shape { geometry Box { } } ] }\n"
       "Group { children [ USE S ] }\n");
  editor->remove({&node("G"), "children", 0});
  EXPECT_EQ(text(), "DEF G Group { children [ ] }\n"
                    "Group { children [ DEF S Shape { geometry Box { } } ] }\n");
  undoAll();
}

TEST_P(Edited, UsesGetNames) {
  load("Group { children [ Shape { geometry Box { } } ] }\nDEF H Group { }\n");
  Node& shape = *field<MFNode>(*world().scope.roots[0], "children")[0];
  editor->use({&node("H"), "children", 0}, shape);
  EXPECT_EQ(text(), "Group { children [ DEF Shape Shape { geometry Box { } } ] }\n"
                    "DEF H Group { children [\n  USE Shape\n] }\n");
  EXPECT_EQ(editor->placesOf(shape).size(), 2u);
  undoAll();
}

TEST_P(Edited, NamesChangeWithAllReferences) {
  load("DEF T TimeSensor { }\nDEF I ScalarInterpolator { }\nGroup { children [ USE T ] }\n"
       "ROUTE T.fraction_changed TO I.set_fraction\n");
  editor->rename(node("T"), "Clock");
  EXPECT_EQ(text(), "DEF Clock TimeSensor { }\nDEF I ScalarInterpolator { }\n"
                    "Group { children [ USE Clock ] }\n"
                    "ROUTE Clock.fraction_changed TO I.set_fraction\n");
  EXPECT_EQ(&node("Clock"), world().scope.roots[0].get());
  undoAll();
  EXPECT_EQ(refusal([&] { editor->rename(node("Clock"), "I"); }), "another node is named I");
  for (const char* name : {"1 2", "", "NULL", "1a", "-1", "a.b", "\x7f"})
    EXPECT_EQ(refusal([&] { editor->rename(node("Clock"), name); }),
              "'" + std::string(name) + "' is no name for a node");
}

TEST_P(Edited, RoutesAreAddedAndRemoved) {
  load("DEF T TimeSensor { }\nDEF I ScalarInterpolator { }\n"
       "ROUTE T.fraction_changed TO I.set_fraction # old\nDEF P PointLight { }");
  editor->addRoute(node("I"), "value_changed", node("P"), "set_intensity");
  EXPECT_EQ(text(), "DEF T TimeSensor { }\nDEF I ScalarInterpolator { }\n"
                    "ROUTE T.fraction_changed TO I.set_fraction # old\nDEF P PointLight { }\n"
                    "ROUTE I.value_changed TO P.set_intensity\n");
  editor->removeRoute(node("T"), "fraction_changed", node("I"), "set_fraction");
  EXPECT_EQ(text().find("fraction_changed"), std::string::npos);
  undoAll();
  while (editor->undo()) {}
  editor->remove({nullptr, "", 0}); // its route goes with it
  EXPECT_EQ(text(), "DEF I ScalarInterpolator { }\n# old\nDEF P PointLight { }");
  EXPECT_TRUE(editor->undo());
  EXPECT_EQ(editor->text(), original);
}

TEST_P(Edited, ANodeIsWrappedAndCopied) {
  load("DEF G Group {\n  children [\n    DEF S Shape {\n      geometry DEF B Box { }\n    }\n"
       "  ]\n}\n");
  editor->wrap({&node("G"), "children", 0});
  EXPECT_EQ(text(), "DEF G Group {\n  children [\n    Transform {\n      children [\n"
                    "        DEF S Shape {\n          geometry DEF B Box { }\n        }\n"
                    "      ]\n    }\n  ]\n}\n");
  undoAll();
  editor->undo();
  editor->set(node("B"), "size", Vec3f{1, 2, 3});
  const NodeRef copy = editor->duplicate({&node("G"), "children", 0});
  EXPECT_EQ(copy->defName, "S_2");
  EXPECT_EQ(text(), "DEF G Group {\n  children [\n    DEF S Shape {\n"
                    "      geometry DEF B Box { size 1 2 3 }\n    }\n    DEF S_2 Shape {\n"
                    "      geometry DEF B_2 Box { size 1 2 3 }\n    }\n  ]\n}\n");
}

TEST_P(Edited, StepsAreUndoneAsAWhole) {
  load("DEF L PointLight { intensity 0 }\n");
  editor->begin("Drag");
  for (int i = 1; i <= 100; ++i) editor->set(node("L"), "intensity", float(i) / 100);
  editor->set(node("L"), "on", false);
  editor->end();
  EXPECT_EQ(editor->undoName(), "Drag");
  undoAll();
  editor->begin("Other");
  editor->set(node("L"), "on", true);
  editor->cancel();
  EXPECT_EQ(text(), "DEF L PointLight { intensity 1 on FALSE }\n");
  EXPECT_TRUE(editor->undo());
  EXPECT_EQ(editor->redoName(), "Drag");
  editor->set(node("L"), "radius", 1.f);
  EXPECT_FALSE(editor->redo()) << "forgotten";
  EXPECT_TRUE(editor->undo());
  EXPECT_FALSE(editor->undo());
}

TEST_P(Edited, FieldsOfInstancesAndScripts) {
  load("PROTO Lamp [ field SFFloat bright 1 exposedField SFBool lit TRUE ] {\n"
       "  DEF INNER PointLight { intensity IS bright on IS lit } }\n"
       "DEF P Lamp { }\nDEF S Script { field SFFloat x 1 field SFNode n DEF K Group { } }\n");
  editor->set(node("P"), "bright", .5f);
  editor->set(node("S"), "x", 2.f);
  editor->remove({&node("S"), "n", 0});
  EXPECT_EQ(renderedNode(&node("P"))->type().name, "PointLight");
  EXPECT_EQ((field<SFFloat>(*renderedNode(&node("P")), "intensity")), .5f);
  EXPECT_NE(text().find("DEF P Lamp { bright 0.5 }\nDEF S Script { field SFFloat x 2"),
            std::string::npos)
      << text();
  Node* const inner = renderedNode(&node("P"));
  EXPECT_EQ(refusal([&] { editor->set(*inner, "radius", 1.f); }),
            "this PointLight of line 3 belongs to the body of a prototype: edit the fields of the "
            "instance");
}

TEST_P(Edited, WhatIsRefusedIsSaid) {
  load("DEF L PointLight { }\nDEF G Group { children Group { children USE L } }\n");
  Node &lamp = node("L"), &group = node("G");
  EXPECT_EQ(refusal([&] { editor->set(lamp, "intensity", 2.f); }),
            "PointLight.intensity: a number is outside of [0,1]");
  EXPECT_EQ(refusal([&] { editor->set(lamp, "radius", std::numeric_limits<float>::infinity()); }),
            "PointLight.radius: a number is not finite, which no file can say");
  EXPECT_EQ(refusal([&] { editor->set(lamp, "intensity", Vec3f{}); }),
            "PointLight.intensity is SFFloat");
  EXPECT_EQ(refusal([&] { editor->set(lamp, "colour", 1.f); }),
            "there is no field PointLight.colour");
  EXPECT_EQ(refusal([&] {
              editor->insert({&group, "children", 0}, "Box { }");
            }),
            "Box cannot be in field children of Group: expected child");
  EXPECT_EQ(refusal([&] {
              editor->insert({&group, "children", 5}, "Group { }");
            }),
            "there is no place 5 among 1 nodes");
  EXPECT_EQ(refusal([&] {
              editor->insert({&group, "children", 0}, "Group { } Group { }");
            }),
            "the text must be that of one node, without routes and prototypes");
  EXPECT_NE(refusal([&] { editor->insert({&group, "children", 0}, "Grupp { }"); }), "done");
  Node& within = *field<MFNode>(group, "children")[0];
  EXPECT_EQ(refusal([&] {
              editor->use({&within, "children", 0}, group);
            }),
            "this Group would become a part of itself");
  EXPECT_EQ(refusal([&] {
              editor->move({nullptr, "", 1}, {&within, "children", 0});
            }),
            "this Group would become a part of itself");
  EXPECT_EQ(refusal([&] {
              editor->wrap({&group, "children", 0}, "Shape");
            }),
            "'Shape' is no node with children");
}

TEST(Editor, PackedFilesStayPacked) {
  const Folder folder;
  const std::string text = "#VRML V2.0 utf8\nDEF L PointLight { }\n";
  const std::string path = folder.write("w.wrz", packed(text));
  const auto world = loadWorld(path);
  Editor editor(*world);
  EXPECT_EQ(editor.whyReadOnly(), "");
  editor.set(*world->scope.names.at("L"), "on", false);
  const std::string bytes = editor.bytes();
  EXPECT_EQ(bytes.substr(0, 2), "\x1f\x8b");
  const auto read = loadWorldFromMemory(bytes, "w.wrz");
  EXPECT_FALSE(field<SFBool>(*read->scope.names.at("L"), "on"));
  EXPECT_FALSE(editor.isChangedOnDisk());
  folder.write("w.wrz", bytes);
  EXPECT_TRUE(editor.isChangedOnDisk());
  editor.saved();
  EXPECT_FALSE(editor.isChangedOnDisk());
  EXPECT_FALSE(editor.isChanged());
}

TEST(Editor, FilesThatCannotBeEditedAreSaid) {
  const Folder folder;
  const auto why = [&](const std::string& name, const std::string& text) {
    const auto world = loadWorld(folder.write(name, text));
    Editor editor(*world);
    return editor.whyReadOnly();
  };
  EXPECT_NE(why("a.stl", "solid a\nendsolid\n").find("is STL"), std::string::npos);
  const auto world = loadWorldFromMemory("#VRML V2.0 utf8\n", "-");
  EXPECT_EQ(Editor(*world).whyReadOnly(), "the world does not come from a file");
}

TEST_P(Edited, WhatCouldNotBeReadStaysAsItIs) {
  for (const char* body :
       {"PROTO P [ Foo { x 1 } ] { Group { } }\nGroup { }\n", "PROTO P\n",
        "PROTO P [ ] Group { }\n", "Shape { geometry DEF X Group { } }\n",
        "Group { children Box { } }\n",
        "Group { children [ Foo { a 1 } NULL DEF A Group { children USE A } ] }\n",
        "DEF G Group { children\n}\n", "Group { children [ USE # c\n NONE ] }\n",
        "Shape { appearance Appearance { texture DEF T ImageTexture { } texture USE T } }\n",
        "Shape { geometry IndexedFaceSet { coord Coordinate { point [ 0 0 0 foo 1 1 1 ] } } }\n",
        "Group { children DEF C Shape { } children DEF D Shape { } }\n"}) {
    const std::string text = "#VRML V2.0 utf8\nDEF L PointLight { }\n" + std::string(body);
    const auto loaded = loadWorld(folder.write("f.wrl", text));
    Editor faulty(*loaded);
    EXPECT_EQ(faulty.text(), text);
    faulty.remove({nullptr, "", 0});
    EXPECT_TRUE(faulty.undo());
    EXPECT_EQ(faulty.text(), text);
  }
  const auto loaded = loadWorld(
      folder.write("f.wrl", "#VRML V2.0 utf8\nDEF G Group { children [ # c\n Foo { a 1 } ] }\n"
                            "DEF H Group { children [ Box { } ] }\n"));
  Editor faulty(*loaded);
  faulty.insert({loaded->scope.names.at("G").get(), "children", 0}, "Group { }");
  EXPECT_EQ(faulty.text(), "#VRML V2.0 utf8\nDEF G Group { children [ # c\n Foo { a 1 }\n"
                           "  Group { }\n] }\nDEF H Group { children [ Box { } ] }\n");
  faulty.insert({loaded->scope.names.at("H").get(), "children", 0}, "Group { }");
  EXPECT_NE(faulty.text().find("DEF H Group { children [ Group { }\n  Box { } ] }"),
            std::string::npos)
      << faulty.text();
}

TEST_P(Edited, CommentsBetweenKeywordsAndNames) {
  load("DEF # a\n A Group { }\nGroup { children [ USE # b\n A ] }\nGroup { children USE # c\n A "
       "}\n");
  EXPECT_EQ(text(), body());
  editor->rename(node("A"), "B");
  EXPECT_EQ(text(), "DEF # a\n B Group { }\nGroup { children [ USE B ] }\n"
                    "Group { children USE B }\n");
  undoAll();
  editor->remove({nullptr, "", 0});
  EXPECT_EQ(text().substr(0, 31), "Group { children [ DEF # a\n B G");
}

TEST_P(Edited, NodesThatStandSeveralTimes) {
  load("DEF G Group { children [ DEF A Group { } DEF B Group { } USE A ] }\n");
  editor->insert({&node("G"), "children", 3}, "PointLight { }");
  EXPECT_EQ(text(),
            "DEF G Group { children [ DEF A Group { } DEF B Group { } USE A PointLight { } ] }\n");
  editor->use({nullptr, "", 1}, node("G"));
  EXPECT_EQ(world().scope.roots.size(), 2u);
  editor->undo();
  EXPECT_EQ(world().scope.roots.size(), 1u);
  EXPECT_EQ(world().scope.roots[0].get(), &node("G"));
}

TEST_P(Edited, NestedStepsAreCancelledAlone) {
  load("DEF L PointLight { }\n");
  editor->begin("Outer");
  editor->set(node("L"), "intensity", .5f);
  editor->begin("Inner");
  editor->set(node("L"), "intensity", .25f);
  editor->cancel();
  EXPECT_EQ((field<SFFloat>(node("L"), "intensity")), .5f);
  editor->end();
  EXPECT_EQ(editor->undoName(), "Outer");
  undoAll();
}

TEST(Editor, RoutesAreUndoneAlsoOnceTheWorldRuns) {
  const Folder folder;
  auto loaded = loadWorld(folder.write("w.wrl", "#VRML V2.0 utf8\nDEF L PointLight { }\n"));
  Editor editor(*loaded);
  Node& lamp = *loaded->scope.names.at("L");
  editor.addRoute(lamp, "on_changed", lamp, "set_on");
  Browser browser(std::move(loaded));
  editor.run(browser);
  EXPECT_TRUE(editor.undo());
  EXPECT_TRUE(editor.redo());
}

TEST(Editor, AFileThatHasBeenWrittenToSinceIsNotEdited) {
  const Folder folder;
  const std::string path = folder.write(
      "w.wrl", "#VRML V2.0 utf8\nDEF S Script { field SFFloat a 1 field SFFloat b 2 }\n");
  const auto world = loadWorld(path);
  folder.write("w.wrl", "#VRML V2.0 utf8\nDEF S Script { field SFFloat a 1 }\n");
  Editor editor(*world);
  try {
    editor.set(*world->scope.names.at("S"), "b", 3.f);
    FAIL();
  } catch (const EditError& error) {
    EXPECT_EQ(error.what(),
              path + " has been written to since the world was loaded: load it again");
  }
  EXPECT_THROW(editor.insert({nullptr, "", 0}, "Group { }"), EditError);
  EXPECT_THROW(editor.insert({nullptr, "", 1}, "Group { }"), EditError);
}

TEST(Editor, AnotherWorldIsNotEdited) {
  const Folder folder;
  Browser browser(loadWorld(folder.write("w.wrl", "#VRML V2.0 utf8\nDEF L PointLight { }\n")));
  Editor editor(browser);
  editor.set(*browser.node("L"), "on", false);
  browser.replaceWorld({browser.createNode("Group")});
  EXPECT_THROW(editor.text(), EditError);
  EXPECT_THROW(editor.undo(), EditError);
}

TEST(Editor, FilesThatImportKeepTheirNodes) {
  const Folder folder;
  const auto world = loadWorld(folder.write(
      "w.x3dv", "#X3D V3.3 utf8\nPROFILE Immersive\nDEF I Inline { }\nIMPORT I.A AS B\n"
                "DEF L PointLight { }\n"));
  Editor editor(*world);
  editor.set(*world->scope.names.at("L"), "on", false);
  EXPECT_THROW(editor.remove({nullptr, "", 0}), EditError);
  EXPECT_THROW(editor.rename(*world->scope.names.at("L"), "B"), EditError);
}

TEST_P(Edited, ANodeThatHasBeenRemovedIsNotRenamed) {
  load("DEF A Group { }\nDEF B Group { }\n");
  const NodeRef removed(&node("A"));
  editor->remove({nullptr, "", 0});
  EXPECT_EQ(refusal([&] { editor->rename(*removed, "C"); }),
            "this Group has been removed from the file");
}

TEST_P(Edited, ANodeThatIsReplacedTakesItsRoutesAlong) {
  load("DEF S Shape { geometry DEF T Text { } }\nDEF C Script { eventOut MFString s }\n"
       "ROUTE C.s TO T.string\n");
  editor->insert({&node("S"), "geometry", 0}, "Box { }");
  EXPECT_EQ(text(), "DEF S Shape { geometry Box { } }\nDEF C Script { eventOut MFString s }\n");
  undoAll();
}

// Random edits, all undone, give the file back; all done again, the edited one.
TEST_P(Edited, RandomEditsCanBeUndone) {
  load("DEF C2 Group { }\n# one\nDEF A Transform {\n  translation 1 2 3 # here\n  children [\n"
       "    DEF B Shape { geometry DEF C Box { size 1 1 1 } }, # comma\n    USE B\n"
       "    Group { children DEF D Transform { } }\n  ]\n}\n"
       "DEF E Group { children [ USE C2 ] }\n"
       "DEF T TimeSensor { }\nROUTE T.time TO T.startTime\n"
       "PROTO P [ field SFVec3f s 1 1 1 exposedField MFNode kids [ ] ]\n"
       "{ Group { children IS kids } }\nDEF I P { kids [ Group { } ] }\n");
  for (unsigned seed = 1; seed <= 20; ++seed)
    editAtRandom(seed, "Group { }", "DEF N Transform { children [ Group { } ] }");
}

TEST_P(Edited, ATextWithAZeroByteIsRefused) {
  load("Shape { geometry DEF T Text { string \"a\" } }\nDEF A Anchor { description \"b\" }\n");
  const std::string zero("x\0y", 3);
  EXPECT_NE(refusal([&] {
              editor->set(node("T"), "string", MFString{"a", zero});
            }).find("zero byte"),
            std::string::npos);
  EXPECT_NE(refusal([&] { editor->set(node("A"), "description", zero); }).find("zero byte"),
            std::string::npos);
}

TEST(Editor, AFileIsReadOnAnotherThread) {
  const Folder folder;
  const std::string text = "#VRML V2.0 utf8\nDEF L PointLight { radius 3 }\n";
  const auto world = loadWorld(folder.write("w.wrl", text));
  Node& lamp = *world->scope.names.at("L");
  {
    Editor editor(*world);
    const std::function<void()> read = editor.preparation();
    ASSERT_TRUE(read);
    EXPECT_TRUE(editor.isPreparing());
    EXPECT_FALSE(editor.preparation()) << "it has been given out";
    std::thread thread(read);
    editor.set(lamp, "radius", 4.f); // waits
    EXPECT_FALSE(editor.isPreparing());
    EXPECT_EQ(editor.text(), "#VRML V2.0 utf8\nDEF L PointLight { radius 4 }\n");
    EXPECT_FALSE(editor.preparation());
    thread.join();
    editor.undo();
  }
  {
    Editor editor(*world);
    editor.preparation() = nullptr; // nobody reads it
    editor.set(lamp, "radius", 5.f);
    EXPECT_NE(editor.text().find("radius 5"), std::string::npos);
    editor.undo();
  }
  std::function<void()> late;
  {
    Editor editor(*world);
    late = editor.preparation();
  }
  late();
}

TEST_P(Edited, WhetherANodeStandsInTheFile) {
  load("DEF A Group { children DEF B Shape { } }\nGroup { children USE B }\n");
  Node &a = node("A"), &b = node("B");
  EXPECT_FALSE(editor->stands(a)) << "the file has not been read";
  ASSERT_EQ(editor->whyReadOnly(), "");
  EXPECT_TRUE(editor->stands(a) && editor->stands(b));
  const NodeRef kept(&a);
  editor->remove({nullptr, "", 0});
  EXPECT_FALSE(editor->stands(a));
  EXPECT_TRUE(editor->stands(b));
  editor->undo();
  EXPECT_TRUE(editor->stands(a));
}

} // namespace
