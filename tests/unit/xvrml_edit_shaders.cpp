// xvrml_edit_shaders.cpp: Tests that a shader gets fields of its own by edits, and that a node is
// made separate from its other places.
#include "unit/xvrml_edit_support.h"

namespace {

using namespace edit_test;

class EditedShaders : public Edited {
 protected:
  static constexpr const char* shader = "Shape { appearance ORTAppearance {\n"
                                        "  shader DEF S ORTShader {\n"
                                        "    name \"Glass\" # clear\n"
                                        "  }\n"
                                        "} }\n";
};
INSTANTIATE_TEST_SUITE_P(World, EditedShaders, testing::Bool(),
                         [](const auto& info) { return info.param ? "Running" : "Resting"; });

TEST_P(EditedShaders, AFieldIsDeclared) {
  load(shader);
  const NodeRef made = editor->declare(node("S"), "index", 1.3f);
  EXPECT_EQ(&node("S"), made.get());
  EXPECT_EQ((field<SFFloat>(*made, "index")), 1.3f);
  EXPECT_EQ(text(), "Shape { appearance ORTAppearance {\n"
                    "  shader DEF S ORTShader {\n"
                    "    name \"Glass\" # clear\n"
                    "    exposedField SFFloat index 1.3\n"
                    "  }\n"
                    "} }\n");
  EXPECT_EQ(editor->undoName(), "Set ORTShader.index");
  editor->set(*made, "index", 1.7f);
  EXPECT_NE(text().find("exposedField SFFloat index 1.7"), std::string::npos);
  const NodeRef again = editor->declare(*made, "absorption", Color{0, .5f, 1});
  EXPECT_EQ((field<SFFloat>(*again, "index")), 1.7f);
  EXPECT_NE(text().find("exposedField SFColor absorption 0 0.5 1"), std::string::npos);
  undoAll();
}

TEST_P(EditedShaders, InOneLineAndInXml) {
  load("Shape { appearance ORTAppearance { shader DEF S ORTShader { name \"Glass\" } } }\n");
  editor->declare(node("S"), "index", 1.3f);
  EXPECT_EQ(text(), "Shape { appearance ORTAppearance { shader DEF S ORTShader { name \"Glass\" "
                    "exposedField SFFloat index 1.3 } } }\n");
  undoAll();
  load("<Scene><Shape><ORTAppearance><ORTShader DEF='S' name='Glass'/></ORTAppearance></Shape>"
       "</Scene></X3D>\n",
       "<X3D profile='Immersive' version='3.3'>\n", "w.x3d");
  editor->declare(node("S"), "profile", MFString{"a 'b'.ies"});
  EXPECT_NE(text().find("<ORTShader DEF='S' name='Glass'><field name='profile' type='MFString' "
                        "accessType='inputOutput' value='\"a &apos;b&apos;.ies\"'/></ORTShader>"),
            std::string::npos)
      << text();
  undoAll();
}

TEST_P(EditedShaders, ADeclaredFieldKeepsItsRoute) {
  load("Shape { appearance ORTAppearance { shader DEF S ORTShader { name \"Glass\" "
       "exposedField SFFloat index 1.5 } } }\n"
       "Shape { appearance ORTAppearance { shader USE S } }\n"
       "DEF I ScalarInterpolator { key [ 0, 1 ] keyValue [ 1, 2 ] }\n"
       "ROUTE I.value_changed TO S.set_index\n");
  const NodeRef before(&node("S"));
  const NodeRef made = editor->declare(*before, "tint", Color{1, 0, 0});
  EXPECT_NE(before.get(), made.get());
  EXPECT_EQ(editor->placesOf(*made).size(), 2u);
  EXPECT_TRUE(editor->placesOf(*before).empty());
  EXPECT_EQ(text(), "Shape { appearance ORTAppearance { shader DEF S ORTShader { name \"Glass\" "
                    "exposedField SFFloat index 1.5 exposedField SFColor tint 1 0 0 } } }\n"
                    "Shape { appearance ORTAppearance { shader USE S } }\n"
                    "DEF I ScalarInterpolator { key [ 0, 1 ] keyValue [ 1, 2 ] }\n"
                    "ROUTE I.value_changed TO S.set_index\n");
  if (browser) {
    browser->set(node("I"), "set_fraction", 0.25f);
    EXPECT_EQ((field<SFFloat>(*made, "index")), 1.25f);
  }
  undoAll();
}

TEST_P(EditedShaders, OthersDeclareNothing) {
  load(std::string(shader) + "DEF G Group { }\n");
  EXPECT_THROW(editor->declare(node("G"), "index", 1.f), EditError);
  EXPECT_THROW(editor->declare(node("S"), "name", std::string("x")), EditError);
  EXPECT_FALSE(editor->isChanged());
}

TEST_P(EditedShaders, ANodeIsMadeSeparate) {
  load("Shape { appearance DEF A Appearance { material DEF M Material { } } }\n"
       "Shape { appearance USE A }\n"
       "Group { children [ DEF B Shape { } USE B ] }\n");
  const MFNode roots = world().scope.roots;
  const NodeRef copy = editor->separate({roots[1].get(), "appearance", 0});
  EXPECT_EQ(copy->defName, "A_2");
  EXPECT_EQ(editor->separate({roots[2].get(), "children", 0})->defName, "B_2");
  EXPECT_EQ(text(), "Shape { appearance DEF A Appearance { material DEF M Material { } } }\n"
                    "Shape { appearance DEF A_2 Appearance { material DEF M_2 Material { } } }\n"
                    "Group { children [ DEF B_2 Shape { } DEF B Shape { } ] }\n");
  EXPECT_THROW(editor->separate({roots[0].get(), "appearance", 0}), EditError);
  undoAll();
}

TEST_P(EditedShaders, EditsOfAFieldAreCounted) {
  load("DEF L PointLight { }\n");
  EXPECT_EQ(editor->editsOf(node("L"), "intensity"), 0u);
  editor->set(node("L"), "intensity", .5f);
  editor->set(node("L"), "intensity", .25f);
  editor->set(node("L"), "on", false);
  EXPECT_EQ(editor->editsOf(node("L"), "intensity"), 2u);
  editor->undo();
  editor->undo();
  EXPECT_EQ(editor->editsOf(node("L"), "intensity"), 1u);
}

} // namespace
