// xvrml_edit_places.cpp: Tests where nodes of a file may stand: not in themselves, and also in
// fields that could not be read as a whole; and lists of many nodes in one line.
#include "edit/history.h"
#include "unit/xvrml_edit_support.h"
#include "xvrml/set_field.h"

namespace {

using namespace edit_test;

class EditedPlaces : public Edited {};
INSTANTIATE_TEST_SUITE_P(World, EditedPlaces, testing::Bool(),
                         [](const auto& info) { return info.param ? "Running" : "Resting"; });

constexpr const char* loop = "this Group would become a part of itself";

TEST_P(EditedPlaces, NoNodeHoldsItself) {
  load("DEF G Group { children Group { children DEF K Collision { } } }\n");
  Node &group = node("G"), &collision = node("K");
  const NodeSlot slots[] = {
      {&group, "children", 0}, {&collision, "children", 0}, {&collision, "proxy", 0}};
  for (const NodeSlot& slot : slots) {
    EXPECT_EQ(refusal([&] { editor->use(slot, group); }), loop);
    EXPECT_EQ(refusal([&] { editor->move({nullptr, "", 0}, slot); }), loop);
  }
  EXPECT_NE(refusal([&] {
              editor->insert({&group, "children", 0}, "Group { children USE G }");
            }),
            "done");
  undoAll();
}

TEST_P(EditedPlaces, NoNodeHoldsItselfThroughAnInstance) {
  load("PROTO P [ field SFNode one NULL exposedField MFNode kids [ ] ] { Group { children [ Group "
       "{ children IS kids } Collision { proxy IS one } ] } }\n"
       "DEF I P { kids DEF G Group { } one DEF H Group { } }\n");
  for (const char* name : {"G", "H"})
    EXPECT_EQ(refusal([&] {
                editor->use({&node(name), "children", 0}, node("I"));
              }),
              "this P would become a part of itself");
  EXPECT_EQ(refusal([&] {
              editor->use({&node("I"), "kids", 0}, node("I"));
            }),
            "this P would become a part of itself");
  EXPECT_EQ(refusal([&] {
              editor->move({nullptr, "", 0}, {&node("H"), "children", 0});
            }),
            "this P would become a part of itself");
  undoAll();
}

TEST_P(EditedPlaces, NothingIsPutIntoANodeThatHasGone) {
  load("DEF A Group { }\nDEF B Transform { }\nDEF L PointLight { }\n");
  const xvrml::NodeRef gone(&node("A"));
  editor->remove({nullptr, "", 0});
  const NodeSlot inside{gone.get(), "children", 0};
  const auto isRefused = [&](const std::function<void()>& edit) {
    EXPECT_EQ(refusal(edit), "this Group has been removed from the file");
  };
  isRefused([&] { editor->move({nullptr, "", 0}, inside); });
  isRefused([&] { editor->use(inside, node("B")); });
  isRefused([&] { editor->use({&node("B"), "children", 0}, *gone); });
  isRefused([&] { editor->insert(inside, "Group { }"); });
  isRefused([&] { editor->set(*gone, "bboxCenter", xvrml::Vec3f{1, 2, 3}); });
  isRefused([&] { editor->addRoute(*gone, "children", node("B"), "children"); });
  isRefused([&] { editor->addRoute(node("B"), "children", *gone, "children"); });
  EXPECT_NE(editor->text().find("DEF B Transform { }"), std::string::npos);
  EXPECT_TRUE(editor->undo());
  editor->move({nullptr, "", 1}, inside); // it is back
  EXPECT_NE(editor->text().find("DEF A Group { children [\n  DEF B Transform"), std::string::npos)
      << editor->text();
  undoAll();
}

TEST_P(EditedPlaces, NodesOfInlinesHoldNoneOfTheFile) {
  folder.write("in.wrl", "#VRML V2.0 utf8\nDEF X Group { }\n");
  load("DEF G Group { children DEF I Inline { url \"in.wrl\" } }\n");
  const Scope* const content = inlineScope(node("I"));
  ASSERT_TRUE(content);
  EXPECT_NE(refusal([&] {
              editor->use({content->roots[0].get(), "children", 0}, node("G"));
            }).find("not in the world's own file"),
            std::string::npos);
}

// Scripts may have taken apart in the running world what the file still holds together.
TEST_P(EditedPlaces, TheFileHasNoLoopsThatTheWorldHasNot) {
  load("DEF A Group { children DEF B Group { } }\nDEF C Group { children USE B }\n");
  if (browser)
    browser->set(node("A"), "children", MFNode{});
  else
    setField(world(), node("A"), "children", MFNode{});
  EXPECT_EQ(refusal([&] { editor->use({&node("B"), "children", 0}, node("A")); }), loop);
  EXPECT_EQ(refusal([&] { editor->move({nullptr, "", 0}, {&node("B"), "children", 0}); }), loop);
}

TEST_P(EditedPlaces, AStepThatCannotBeUndoneStaysDone) {
  load("DEF A Group { children DEF B Group { } }\nDEF C Group { children USE B }\n");
  editor->begin("Step");
  editor->remove({&node("A"), "children", 0});
  editor->set(node("A"), "bboxSize", Vec3f{1, 1, 1});
  editor->end();
  const std::string now = editor->text();
  if (!browser) return;
  ASSERT_TRUE(browser->set(node("B"), "children", MFNode{NodeRef(&node("A"))}));
  EXPECT_THROW(editor->undo(), EditError);
  EXPECT_EQ(editor->text(), now);
  EXPECT_EQ(editor->undoName(), "Step");
  ASSERT_TRUE(browser->set(node("B"), "children", MFNode{}));
  undoAll();
}

// It stays as a step, which can be undone when the world allows it again.
TEST_P(EditedPlaces, WhatCannotBeCancelledStaysDone) {
  load("DEF A Group { children DEF B Group { } }\nDEF C Group { children USE B }\n");
  editor->begin("Step");
  editor->remove({&node("A"), "children", 0});
  if (!browser) return;
  ASSERT_TRUE(browser->set(node("B"), "children", MFNode{NodeRef(&node("A"))}));
  EXPECT_THROW(editor->cancel(), EditError);
  EXPECT_FALSE(editor->isInStep());
  EXPECT_EQ(editor->undoName(), "Step");
  EXPECT_NE(editor->text(), original);
  ASSERT_TRUE(browser->set(node("B"), "children", MFNode{}));
  undoAll();
}

// An exception must not leave the end of a scope while another one is on its way.
TEST(EditHistory, AStepWhoseUndoFailsDoesNotEndTheProgram) {
  History history;
  int value = 0;
  const auto failing = [&] {
    OpenStep outer(history, "Outer");
    OpenStep inner(history, "Inner");
    history.perform({[&] { ++value; }, [] { throw EditError("not now"); }});
    throw EditError("the reason");
  };
  try {
    failing();
    ADD_FAILURE() << "it throws";
  } catch (const EditError& error) { EXPECT_STREQ(error.what(), "the reason"); }
  EXPECT_FALSE(history.isOpen());
  EXPECT_EQ(history.undoName(), "Outer");
  EXPECT_EQ(value, 1);
}

// Nodes in fields that could not be read as a whole are edited in their places.
TEST(EditorPlaces, NodesInFieldsThatCouldNotBeRead) {
  const Folder folder;
  for (const auto& [name, head, body, edited] :
       {std::tuple<std::string, std::string, std::string, std::string>{
            "f.wrl", "#VRML V2.0 utf8\n",
            "Group { children DEF X PointLight { } children Shape { } }\nGroup { children USE X "
            "}\n",
            "Group { children DEF Y PointLight { on FALSE } children Shape { } }\n"
            "Group { children USE Y }\n"},
        {"f.wrl", "#VRML V2.0 utf8\n",
         "Shape { geometry DEF X PointLight { } # c\n}\nGroup { children [ USE X ] }\n",
         "Shape { geometry DEF Y PointLight { on FALSE } # c\n}\nGroup { children [ USE Y ] }\n"},
        {"f.wrl", "#VRML V2.0 utf8\n",
         "DEF M Material { }\nShape { appearance Appearance { material USE M } }\n"
         "Group { children [ Box { } DEF X PointLight { } ] }\n",
         "DEF M Material { }\nShape { appearance Appearance { material USE M } }\n"
         "Group { children [ Box { } DEF Y PointLight { on FALSE } ] }\n"},
        {"f.x3d", "<X3D version='3.3'><Scene>\n",
         "<Shape><PointLight DEF='X' containerField='geometry'/></Shape>\n"
         "<Group><PointLight USE='X'/></Group>\n</Scene></X3D>\n",
         "<Shape><PointLight DEF='Y' containerField='geometry' on='false'/></Shape>\n"
         "<Group><PointLight USE='Y'/></Group>\n</Scene></X3D>\n"}}) {
    const auto loaded = loadWorld(folder.write(name, head + body));
    Editor editor(*loaded);
    EXPECT_EQ(editor.text(), head + body);
    const auto found = loaded->scope.names.find("X");
    if (found == loaded->scope.names.end()) continue; // the reader keeps no name there
    Node& lamp = *found->second;
    editor.set(lamp, "on", false);
    editor.rename(lamp, "Y");
    EXPECT_EQ(editor.text(), head + edited);
    while (editor.undo()) {}
    EXPECT_EQ(editor.text(), head + body);
  }
}

// Comments directly above a node and behind it go where it goes.
TEST_P(EditedPlaces, CommentsBelongToTheirNodes) {
  load("# by us\nDEF G Group {\n  children [\n    # above\n    DEF A Shape { } # behind A\n"
       "    # of B\n    # and more\n    DEF B Shape { }, # comma\n\n    # alone\n\n"
       "    DEF C Shape { }\n  ]\n}\nDEF H Group {\n  children [\n  ]\n}\n"
       "DEF I Group { children [ Group { } ] }\n");
  editor->remove({&node("G"), "children", 0});
  editor->move({&node("G"), "children", 0}, {&node("H"), "children", 0});
  EXPECT_EQ(text(), "# by us\nDEF G Group {\n  children [\n\n    # alone\n\n    DEF C Shape { }\n"
                    "  ]\n}\nDEF H Group {\n  children [\n    # of B\n    # and more\n"
                    "    DEF B Shape { } # comma\n  ]\n}\n"
                    "DEF I Group { children [ Group { } ] }\n");
  undoAll();
  editor->move({&node("H"), "children", 0}, {&node("I"), "children", 1}); // within a line
  EXPECT_NE(text().find("    # of B\n    # and more\n"), std::string::npos) << text();
  EXPECT_NE(text().find("[ Group { } DEF B Shape { } ]"), std::string::npos) << text();
  undoAll();
  while (editor->undo()) {}
  editor->move({&node("G"), "children", 1}, {&node("G"), "children", 0});
  EXPECT_EQ(text(), "# by us\nDEF G Group {\n  children [\n    # of B\n    # and more\n"
                    "    DEF B Shape { } # comma\n    # above\n    DEF A Shape { } # behind A\n"
                    "\n    # alone\n\n    DEF C Shape { }\n  ]\n}\nDEF H Group {\n  children [\n"
                    "  ]\n}\nDEF I Group { children [ Group { } ] }\n");
  undoAll();
  editor->remove({nullptr, "", 0}); // what stands below the header belongs to the file
  EXPECT_EQ(text().substr(0, 14), "# by us\nDEF H ");
  undoAll();
}

TEST(EditorPlaces, CommentsOfXmlBelongToTheirNodes) {
  const Folder folder;
  const std::string text = "<X3D version='3.3'>\n<Scene>\n  <Group DEF='G'>\n    <!-- of A -->\n"
                           "    <Shape DEF='A'/> <!-- behind -->\n    <Shape DEF='B'/>\n"
                           "  </Group>\n  <Group DEF='H'/>\n</Scene>\n</X3D>\n";
  const auto world = loadWorld(folder.write("w.x3d", text));
  Editor editor(*world);
  Node &from = *world->scope.names.at("G"), &to = *world->scope.names.at("H");
  editor.move({&from, "children", 0}, {&to, "children", 0});
  EXPECT_EQ(editor.text(), "<X3D version='3.3'>\n<Scene>\n  <Group DEF='G'>\n"
                           "    <Shape DEF='B'/>\n  </Group>\n  <Group DEF='H'>\n"
                           "    <!-- of A -->\n    <Shape DEF='A'/> <!-- behind -->\n"
                           "  </Group>\n</Scene>\n</X3D>\n");
  editor.remove({&to, "children", 0});
  EXPECT_EQ(editor.text().find("<!--"), std::string::npos);
  while (editor.undo()) {}
  EXPECT_EQ(editor.text(), text);
}

TEST_P(EditedPlaces, ANameOfSeveralNodesFallsToTheLastOne) {
  load("DEF A Group { }\nDEF A Shape { }\nDEF A PointLight { }\n");
  editor->remove({nullptr, "", 2});
  EXPECT_EQ(text(), "DEF A Group { }\nDEF A Shape { }\n");
  EXPECT_EQ(node("A").type().name, "Shape");
  editor->remove({nullptr, "", 0});
  EXPECT_EQ(text(), "DEF A Shape { }\n");
  undoAll();
  while (editor->undo()) {}
  EXPECT_EQ(node("A").type().name, "PointLight");
}

// A Script may hold itself: the counts of places do not show when it is gone.
TEST_P(EditedPlaces, AScriptThatHoldsItselfGoesWithItsRoutes) {
  load("DEF S Script { eventIn SFBool b eventOut SFBool c field SFNode self USE S }\n"
       "DEF L PointLight { }\nROUTE S.c TO L.on\n");
  editor->remove({nullptr, "", 0});
  EXPECT_EQ(text(), "DEF L PointLight { }\n");
  undoAll();
}

// A file must be readable again: what would nest too deep in it is refused at the edit.
TEST(EditorPlaces, NodesThatNestTooDeepAreRefused) {
  const Folder folder;
  const std::string text = "#VRML V2.0 utf8\nDEF G Group { children Shape { } }\nDEF H Group { }\n"
                           "DEF I Group { children USE H }\n";
  LoadOptions options;
  options.limits.nesting = 10;
  const auto world = loadWorld(folder.write("w.wrl", text), options);
  Editor editor(*world);
  const auto node = [&](const char* name) { return world->scope.names.at(name); };
  const auto refusal = [](const std::function<void()>& edit) -> std::string {
    try {
      edit();
    } catch (const EditError& error) { return error.what(); }
    return "done";
  };
  constexpr const char* refused =
      " cannot stand there: nodes would be nested deeper than limit nesting=10";
  const NodeSlot slot{node("G").get(), "children", 0};
  for (int i = 2; i < 10; ++i) editor.wrap(slot);
  std::string deepest = editor.text();
  EXPECT_EQ(refusal([&] { editor.wrap(slot); }), std::string("Transform") + refused);
  EXPECT_EQ(editor.text(), deepest);
  EXPECT_EQ(refusal([&] {
              editor.move({nullptr, "", 0}, {node("H").get(), "children", 0});
            }),
            std::string("Group") + refused);
  EXPECT_TRUE(editor.undo());
  // H also stands in I, whose text would get all of it if H went.
  EXPECT_EQ(refusal([&] {
              editor.move({nullptr, "", 0}, {node("H").get(), "children", 0});
            }),
            std::string("Group") + refused);
  EXPECT_TRUE(editor.undo());
  editor.move({nullptr, "", 0}, {node("H").get(), "children", 0});
  editor.remove({nullptr, "", 0});
  EXPECT_NE(editor.text().find("DEF I Group { children DEF H Group"), std::string::npos);
  EXPECT_EQ(refusal([&] { editor.wrap(slot); }), std::string("Transform") + refused);
  while (editor.undo()) {}
  EXPECT_EQ(editor.text(), text);
}

// The text of a node that is refused is not kept, and the next one of its kind is found.
TEST_P(EditedPlaces, WhatIsRefusedLeavesNothing) {
  load("DEF G Group { }\n");
  for (int i = 0; i < 3; ++i)
    EXPECT_NE(refusal([&] {
                editor->insert({&node("G"), "children", 0}, "DEF M Material { }");
              }),
              "done");
  const NodeRef made = editor->insert({&node("G"), "children", 0}, "DEF M Shape { }");
  EXPECT_EQ(made->defName, "M");
  EXPECT_TRUE(editor->stands(*made));
  EXPECT_EQ(editor->countPlaces(*made), 1u);
  editor->use({nullptr, "", 1}, *made);
  EXPECT_EQ(editor->countPlaces(*made), 2u);
  undoAll();
}

TEST(EditorPlaces, LongLines) {
  const Folder folder;
  std::string text = "#VRML V2.0 utf8\nDEF G Group { children [ ";
  for (int i = 0; i < 20'000; ++i)
    text += "Group { children [ DEF S" + std::to_string(i) + " Shape { } ] } ";
  text += "] }\n";
  const auto world = loadWorld(folder.write("w.wrl", text));
  Editor editor(*world);
  Node& group = *world->scope.names.at("G");
  ASSERT_EQ(editor.whyReadOnly(), "");
  editor.begin("Many");
  for (int i = 0; i < 1'000; ++i) {
    Node& inner = *field<MFNode>(group, "children")[size_t(i) * 20];
    editor.set(inner, "bboxSize", Vec3f{1, 1, 1});
  }
  editor.remove({&group, "children", 0});
  editor.end();
  EXPECT_EQ(editor.text().size(),
            text.size() + 999 * std::string("bboxSize 1 1 1 ").size() -
                std::string("Group { children [ DEF S0 Shape { } ] } ").size());
}

// All that is not edited is copied as one piece. These edits reach into pieces that have not been
// edited themselves: a node is defined at another place now.
TEST_P(EditedPlaces, AReferenceInAnotherGroupBecomesTheNode) {
  const std::string head = "DEF G Group { children [ Group { children DEF A Shape { } } ] }\n",
                    tail = "Group { children [ Group { children [ USE A Transform { } ] } ] }\n"
                           "Group { children USE A }\n";
  load(head + tail);
  editor->move({nullptr, "", 0}, {nullptr, "", 1});
  EXPECT_EQ(text(), "Group { children [ Group { children [ DEF A Shape { } Transform { } ] } ] }\n"
                    "DEF G Group { children [ Group { children USE A } ] }\n"
                    "Group { children USE A }\n");
  undoAll();
  while (editor->undo()) {}
  editor->remove({nullptr, "", 0});
  EXPECT_EQ(text(), "Group { children [ Group { children [ DEF A Shape { } Transform { } ] } ] }\n"
                    "Group { children USE A }\n");
  undoAll();
}

TEST_P(EditedPlaces, ANodeWithinAPieceIsUsedBeforeIt) {
  load("DEF F Group { children [ ] }\n"
       "Group { children [ Group { children [ DEF A Shape { geometry DEF B Box { } } ] } ] }\n"
       "Group { children [ USE A Shape { geometry USE B } ] }\n");
  editor->use({&node("F"), "children", 0}, node("A"));
  EXPECT_EQ(text(), "DEF F Group { children [\n  DEF A Shape { geometry DEF B Box { } }\n] }\n"
                    "Group { children [ Group { children [ USE A ] } ] }\n"
                    "Group { children [ USE A Shape { geometry USE B } ] }\n");
  undoAll();
}

TEST_P(EditedPlaces, NamesAndRoutesWithinPieces) {
  const std::string before = "DEF T TimeSensor { }\nDEF G Group { children [ DEF A Group { } ",
                    behind = "Group { children [ USE A DEF B Group { } ] } ] }\n"
                             "Group { children DEF C TimeSensor { }\n"
                             "ROUTE T.time TO C.startTime\nROUTE C.time TO C.stopTime }\n";
  load(before + behind);
  editor->rename(node("A"), "Z");
  EXPECT_NE(text().find("children [ DEF Z Group { } Group { children [ USE Z DEF B"),
            std::string::npos);
  editor->rename(node("T"), "U");
  EXPECT_NE(text().find("ROUTE U.time TO C.startTime\nROUTE C.time TO C.stopTime }"),
            std::string::npos);
  editor->remove({nullptr, "", 0});
  EXPECT_EQ(text().find("ROUTE U"), std::string::npos);
  EXPECT_NE(text().find("ROUTE C.time TO C.stopTime"), std::string::npos);
  undoAll();
}

TEST_P(EditedPlaces, APieceWithAnInstanceStaysBehindItsPrototype) {
  load("DEF F Group { children [ ] }\nGroup {\n"
       "PROTO P [ ] { Group { } }\n  children Group { children [ DEF I P { } ] } }\n");
  editor->use({&node("F"), "children", 0}, node("I"));
  const std::string now = text();
  EXPECT_LT(now.find("PROTO P"), now.find("DEF I P"));
  undoAll();
}

} // namespace
