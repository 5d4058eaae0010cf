// editor_hostile.cpp: Tests that the editor stays quick, and says what it shows, in worlds that are
// made to be too much: large pictures and texts, prototypes in prototypes, and nodes that a Script
// takes away.
#include <ctime>

#include <fmt/format.h>

#include "edit/actions.h"
#include "edit/edit_model.h"
#include "unit/editor_support.h"

namespace {

using namespace editor_test;
using namespace vv;
using namespace xvrml;

// Returns the processor time in seconds that a function takes.
template <class Function> double cpuSeconds(const Function& function) {
  const std::clock_t begin = std::clock();
  function();
  return double(std::clock() - begin) / CLOCKS_PER_SEC;
}

struct Shown : testing::Test {
  EditModel model;
  void show(EditedWorld& world, const char* name) {
    world.editor.select({world.node(name)});
    model.update(world.editor, front(), false, 0);
  }
  const PropertyRow& row(const char* name) { return *model.sheet().find(name); }
};

// A picture of 100 MB is not copied into the sheet, also not while the world moves.
TEST_F(Shown, ALargePictureIsNotCopied) {
  EditedWorld world(
      "#VRML V2.0 utf8\nShape { appearance Appearance { texture DEF P PixelTexture {\n"
      "image 1 1 3 0xff8000 # orange\n} } }\n");
  show(world, "P");
  EXPECT_FALSE(row("image").isLong);
  Image large{5000, 5000, 4, std::vector<uint8_t>(100'000'000, 7)};
  ASSERT_TRUE(world.browser.set(*world.node("P"), "image", std::move(large)));
  show(world, "P");
  const double seconds = cpuSeconds([&] {
    for (int i = 1; i <= 100; ++i) model.update(world.editor, front(), true, i);
  });
  EXPECT_LT(seconds, 0.5) << "100 copies take at least 2 s";
  EXPECT_TRUE(row("image").isLong);
  EXPECT_FALSE(row("image").isDefault);
  // Another field of the node is edited beside it; what a Script has set is not saved.
  model.drag(world.node("P"), *row("repeatS").field, false);
  model.setActive(false);
  model.update(world.editor, front(), false, 200);
  EXPECT_NE(world.editor.editor().text().find("image 1 1 3 0xff8000 # orange"), std::string::npos);
}

TEST_F(Shown, LongTextsAreNotShown) {
  EditedWorld world("#VRML V2.0 utf8\nDEF W WorldInfo { title \"" + std::string(10'000'000, 'x') +
                    "\" info [ \"a\" ] }\n");
  show(world, "W");
  EXPECT_TRUE(row("title").isLong);
  EXPECT_FALSE(row("info").isLong);
  world.editor.editor().set(*world.node("W"), "info",
                            MFString{std::string(20'000, 'a'), std::string(20'000, 'b')});
  show(world, "W");
  EXPECT_TRUE(row("info").isLong) << "two texts of 20 kB";
  EXPECT_EQ(row("info").size, 2u);
}

// Each prototype holds two instances of the one before, so that the last one has 2^30 boxes; and
// one holds an instance of itself.
TEST_F(Shown, PrototypesWithoutEndAreEdited) {
  std::string text = "#VRML V2.0 utf8\n"
                     "PROTO P0 [ exposedField SFVec3f size 1 1 1 ] {\n"
                     "  Shape { geometry Box { size IS size } } }\n";
  for (int i = 1; i <= 30; ++i)
    text += fmt::format("PROTO P{0} [ exposedField SFVec3f size 1 1 1 ] {{ Group {{ children [\n"
                        "  P{1} {{ size IS size }} P{1} {{ }} ] }} }}\n",
                        i, i - 1);
  text += "PROTO SELF [ field SFFloat x 0 ] { Group { children SELF { x IS x } } }\n"
          "DEF I P30 { size 1 2 3 # here\n}\nDEF S SELF { x 4 }\n";
  EditedWorld world(text);
  show(world, "I");
  EXPECT_NE(model.sheet().note.find("PROTO P30"), std::string::npos);
  model.drag(world.node("I"), *row("size").field, Vec3f{1, 5, 3});
  model.setActive(false);
  model.update(world.editor, front(), false, 0);
  show(world, "I");
  EXPECT_EQ(row("size").value, Value(Vec3f{1, 5, 3}));
  EXPECT_NE(world.editor.editor().text().find("DEF I P30 { size 1 5 3 # here"), std::string::npos);
  world.editor.undo();
  EXPECT_EQ(world.editor.editor().text(), text);
}

TEST_F(Shown, AnInlineSaysWhoseItsContentIs) {
  EditedWorld world("#VRML V2.0 utf8\nDEF I Inline { url \"nothing.wrl\" }\n");
  show(world, "I");
  EXPECT_NE(model.sheet().note.find("another file"), std::string::npos);
}

// The Script is played by the browser here: it sets the children of the group.
TEST_F(Shown, WhatAScriptTakesAwayStaysSelected) {
  const std::string text = "#VRML V2.0 utf8\nDEF G Group { children [\n"
                           "  DEF L PointLight { intensity 0.80 # by day\n  }\n] }\n";
  EditedWorld world(text);
  show(world, "L");
  const NodeRef light = world.node("L");
  ASSERT_TRUE(world.browser.set(*world.node("G"), "children", MFNode()));
  show(world, "L");
  EXPECT_EQ(model.sheet().node, light);
  EXPECT_TRUE(model.frames().empty());
  model.drag(light, *row("intensity").field, .5f);
  model.setActive(false);
  model.update(world.editor, front(), false, 0);
  EXPECT_EQ(model.takeMessage(), "");
  EXPECT_NE(world.editor.editor().text().find("intensity 0.5 # by day"), std::string::npos);
  try {
    removeSelected(world.editor);
    ADD_FAILURE() << "it has no place";
  } catch (const EditError& error) {
    EXPECT_NE(std::string(error.what()).find("a Script has taken"), std::string::npos);
  }
  while (!world.editor.undo().empty()) {}
  EXPECT_EQ(world.editor.editor().text(), text);
}

} // namespace
