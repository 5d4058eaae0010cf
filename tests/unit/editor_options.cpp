// editor_options.cpp: Tests how the sheet shows and sets the parameters that the options of a
// shader set.
#include <fmt/format.h>

#include "edit/edit_model.h"
#include "libpicture/shader_text.h"
#include "unit/editor_support.h"

namespace {

using namespace editor_test;
using namespace vv;
using namespace xvrml;

struct EditorOptions : testing::Test {
  EditedWorld world{
      "#VRML V2.0 utf8\nShape { appearance ORTAppearance { shader DEF S ORTShader {\n"
      "name \"Glass\" options [ \"1f index 1.20, color tint 1 0.50 0\" \"1i shadow 1\"\n"
      "\"string scattering x\" ] } } }\n"};
  EditModel model;
  const PropertyRow& row(const char* name) {
    world.editor.select({world.node("S")});
    model.update(world.editor, front(), false, 0);
    return *model.sheet().find(name);
  }
  void set(const char* name, const Value& value) {
    model.drag(world.node("S"), *row(name).field, value);
    model.setActive(false);
    row(name);
    EXPECT_EQ(model.takeMessage(), "");
  }
  bool has(const std::string& part) {
    return world.editor.editor().text().find(part) != std::string::npos;
  }
};

TEST_F(EditorOptions, AreShown) {
  EXPECT_EQ(row("index").value, Value(1.2f));
  EXPECT_EQ(row("tint").value, Value(Color{1, .5f, 0}));
  EXPECT_EQ(row("shadow").value, Value(SFInt32(1)));
  EXPECT_FALSE(row("index").isDefault);
  for (const PropertyRow& one : model.sheet().rows) {
    const std::string& name = one.field->name;
    EXPECT_EQ(one.isInOptions,
              name == "index" || name == "tint" || name == "shadow" || name == "scattering");
    EXPECT_EQ(one.isLong, name == "scattering") << "a text is no colour";
  }
}

// Only the numbers that differ are written, where they stand.
TEST_F(EditorOptions, AreSetInTheirPlaces) {
  set("tint", Color{.25f, .5f, 0});
  EXPECT_TRUE(has("\"1f index 1.20, color tint 0.25 0.50 0\" \"1i shadow 1\""));
  set("index", 1.7f);
  set("shadow", SFInt32(0));
  EXPECT_TRUE(has("\"1f index 1.7, color tint 0.25 0.50 0\" \"1i shadow 0\""));
  EXPECT_EQ(row("index").value, Value(1.7f));
  EXPECT_EQ(world.editor.undo(), "Set ORTShader.shadow");
  EXPECT_EQ(world.editor.undo(), "Set ORTShader.index");
  world.editor.undo();
  EXPECT_TRUE(has("\"1f index 1.20, color tint 1 0.50 0\" \"1i shadow 1\""));
  EXPECT_EQ(row("index").value, Value(1.2f));
}

// The picture follows the number while it is dragged, which is one step.
TEST_F(EditorOptions, FollowADrag) {
  model.setActive(true);
  for (const float value : {1.3f, 1.4f, 1.5f}) {
    model.drag(world.node("S"), *row("index").field, value);
    model.update(world.editor, front(), false, 0);
    EXPECT_TRUE(has(fmt::format("1f index {}, color", value)));
  }
  model.setActive(false);
  EXPECT_EQ(row("index").value, Value(1.5f));
  EXPECT_TRUE(row("index").isDefault);
  world.editor.undo();
  EXPECT_TRUE(has("1f index 1.20, color"));
  EXPECT_EQ(world.editor.editor().undoName(), "");
}

// The reader of options takes numbers in quotes, too.
TEST(EditorQuotedOptions, AreSetToZero) {
  EditedWorld world{
      "#VRML V2.0 utf8\nShape { appearance ORTAppearance { shader DEF S ORTShader {\n"
      "name \"Glass\" options [ \"1f index '1.50'\" \"color tint '.50' .25 1\" ] } } }\n"};
  world.editor.select({world.node("S")});
  EditModel model;
  model.update(world.editor, front(), false, 0);
  model.drag(world.node("S"), *model.sheet().find("tint")->field, Value(Color{.5f, 0, 1}));
  model.setActive(false);
  model.update(world.editor, front(), false, 0);
  EXPECT_NE(world.editor.editor().text().find("color tint '.50' 0 1"), std::string::npos)
      << world.editor.editor().text();
}

// A text stays in the options, and the field that is declared takes its place.
TEST_F(EditorOptions, OthersAreDeclared) {
  set("scattering", Color{1, 1, 1});
  EXPECT_TRUE(has("exposedField SFColor scattering 1 1 1"));
  EXPECT_TRUE(has("string scattering x"));
}

// --- The option of vv ---

std::string optionOf(const std::string& shape) {
  EditedWorld world("#VRML V2.0 utf8\n" + shape + "\n");
  return shaderOption(*world.browser.world().scope.roots.at(0));
}
std::string shapeOf(const std::string& shader, const std::string& name = "DEF Lens") {
  return name + " Shape { appearance ORTAppearance { shader ORTShader { " + shader + " } } }";
}

TEST(EditorShaderOption, IsReadAsTheSameShader) {
  const std::string option =
      optionOf(shapeOf("name \"Glass\" options \"1f index 1.80, 1i shadow 1\" "
                       "exposedField SFColor tint 1 .50 0"));
  EXPECT_EQ(option, "--shader Lens=Glass:index=1.8:shadow=1:tint=1,0.5,0");
  const std::string text = option.substr(option.find('=') + 1);
  const NodeRef read = picture::readShader(text, "--shader", RT_SURFACE, "");
  EXPECT_EQ(picture::shaderText(*nodeCast<nodes::ORTShader>(read)), text);
}

TEST(EditorShaderOption, IsNoneWhereItCannotSayAll) {
  EXPECT_EQ(optionOf(shapeOf("name \"Glass\"", "")), "") << "the Shape has no name";
  EXPECT_EQ(optionOf(shapeOf("name \"Diffuse\" options \"texture texture a.png\"")), "");
  EXPECT_EQ(optionOf(shapeOf("name \"Diffuse;rm\"")), "") << "a shell would read it";
  EXPECT_EQ(optionOf("DEF A Shape { appearance Appearance { material Material { } } }"), "");
  EXPECT_EQ(optionOf(shapeOf("name \"Glass\"")), "--shader Lens=Glass");
}

} // namespace
