// xvrml_edit_running.cpp: Tests edits of worlds that run: nodes that refuse a value, Scripts that
// replace the world meanwhile, and the memory of undo.
#include "unit/xvrml_edit_support.h"

namespace {

using namespace edit_test;

struct EditedRunning : testing::Test {
  void load(const std::string& body) {
    original = "#VRML V2.0 utf8\n" + body;
    browser = std::make_unique<Browser>(loadWorld(folder.write("w.wrl", original)));
    editor = std::make_unique<Editor>(*browser);
  }
  NodeRef node(const std::string& name) { return browser->node(name); }
  // Lets another world take the place of this one as soon as a field changes.
  void replaceWhen(const std::string& name, const std::string& out) {
    browser->listen(*node(name), out, [this](Node&, const FieldInfo&, const Value&) {
      browser->replaceWorld({browser->createNode("Group")});
    });
  }
  void expectNothingOfTheOldWorld() {
    EXPECT_EQ(browser->world().scope.roots.size(), 1u);
    EXPECT_TRUE(browser->world().scope.names.empty());
    EXPECT_TRUE(browser->world().scope.routes.empty());
  }

  const Folder folder;
  std::string original;
  std::unique_ptr<Browser> browser;
  std::unique_ptr<Editor> editor;
};

// ISO/IEC 14772-1 6.50: a TimeSensor that is active ignores a new cycleInterval.
TEST_F(EditedRunning, AValueThatTheWorldRefusesIsSaid) {
  load("DEF T TimeSensor { loop TRUE cycleInterval 5 }\n");
  browser->tick(1);
  browser->tick(2);
  try {
    editor->set(*node("T"), "cycleInterval", 7.0);
    ADD_FAILURE() << "it is refused";
  } catch (const EditError& error) {
    EXPECT_NE(std::string(error.what()).find("keeps its TimeSensor.cycleInterval"),
              std::string::npos)
        << error.what();
  }
  EXPECT_EQ(editor->text(), original);
  EXPECT_FALSE(editor->isChanged());
  EXPECT_EQ(std::get<double>(browser->get(*node("T"), "cycleInterval")), 5);
  editor->set(*node("T"), "cycleInterval", 5.0); // it has this value
  editor->set(*node("T"), "loop", false);
  browser->tick(10);
  editor->set(*node("T"), "cycleInterval", 7.0);
  EXPECT_NE(editor->text().find("cycleInterval 7"), std::string::npos);
}

// The step that was under way is taken back as a whole, but for what the new world has.
TEST_F(EditedRunning, AWorldThatIsReplacedWithinAnEditGetsNoNodesOfIt) {
  load("DEF G Group { children DEF L PointLight { } }\nDEF H Group { }\n");
  replaceWhen("G", "children_changed");
  EXPECT_THROW(editor->move({node("G").get(), "children", 0}, {nullptr, "", 0}), EditError);
  expectNothingOfTheOldWorld();
  EXPECT_EQ(editor->draft(), original);
}

TEST_F(EditedRunning, AStepThatIsCancelledAfterItsWorldHasGone) {
  load("DEF A Group { }\nDEF L PointLight { }\n");
  const NodeRef light = node("L");
  replaceWhen("L", "intensity_changed");
  editor->begin("Step");
  editor->remove({nullptr, "", 0});
  editor->rename(*light, "LAMP");
  editor->set(*light, "intensity", .5f);
  EXPECT_NE(editor->draft(), original);
  editor->cancel();
  expectNothingOfTheOldWorld();
  EXPECT_EQ(editor->draft(), original);
  EXPECT_THROW(editor->set(*light, "intensity", .25f), EditError);
}

TEST_F(EditedRunning, UndoHasABoundOfMemory) {
  load("DEF L PointLight { }\n");
  const auto steps = [&] {
    size_t count = 0;
    while (editor->undo()) ++count;
    return count;
  };
  const auto edit = [&](int count) {
    for (int i = 0; i < count; ++i)
      editor->set(*node("L"), i % 2 ? "intensity" : "ambientIntensity", float(i + 1) / 1000);
  };
  edit(100);
  EXPECT_EQ(steps(), 100u);
  editor->setUndoBytes(10'000);
  edit(100);
  edit(100);
  EXPECT_EQ(editor->editsOf(*node("L"), "intensity"), 100u) << "also those that are forgotten";
  editor->begin("Drag"); // a drag stays one step
  for (int i = 0; i < 1000; ++i) editor->set(*node("L"), "radius", float(i + 1));
  editor->end();
  const size_t left = steps();
  EXPECT_GT(left, 5u);
  EXPECT_LT(left, 25u);
  EXPECT_TRUE(editor->isChanged()) << "the file cannot be reached any more";
  size_t messages = 0;
  for (const Diagnostic& one : browser->world().diagnostics.list())
    messages += one.message.find("its oldest steps are forgotten") != std::string::npos;
  EXPECT_EQ(messages, 1u);
}

// A step that is larger than all can still be undone.
TEST_F(EditedRunning, TheLastStepCanBeUndone) {
  load("Shape { geometry PointSet { coord DEF C Coordinate { } } }\n");
  editor->setUndoBytes(1000);
  editor->set(*node("C"), "point", MFVec3f(10'000));
  EXPECT_TRUE(editor->undo());
  EXPECT_EQ(editor->text(), original);
}

} // namespace
