// xvrml_edit_draft.cpp: Tests the text of edits that are not saved, and worlds that are read from
// it.
#include "edit/gzip.h"
#include "unit/xvrml_edit_support.h"

namespace xvrml {
namespace {

using namespace edit_test;

constexpr const char* lamps = "DEF A PointLight { intensity 0.80 # by day\n}\n"
                              "DEF G Group { children [ USE A ] }\n";

class Drafted : public Edited {};

TEST_P(Drafted, ADraftIsTheTextAtAnyTime) {
  load(lamps);
  EXPECT_THROW(editor->draft(), EditError) << "nothing has been edited";
  editor->set(node("A"), "intensity", .5f);
  EXPECT_EQ(editor->draft(), editor->text());
  editor->begin("Drag");
  editor->set(node("A"), "intensity", .25f);
  EXPECT_NE(editor->draft().find("intensity 0.25 # by day"), std::string::npos);
  editor->cancel();
  EXPECT_EQ(editor->draft(), editor->text());
  EXPECT_EQ(editor->textOnDisk(), original);
}

INSTANTIATE_TEST_SUITE_P(World, Drafted, testing::Bool());

TEST(EditDraft, ItOutlivesTheWorld) {
  const Folder folder;
  Browser browser(loadWorld(folder.write("w.wrl", "#VRML V2.0 utf8\nDEF L PointLight { }\n")));
  Editor editor(browser);
  editor.set(*browser.node("L"), "on", false);
  browser.replaceWorld({browser.createNode("Group")});
  EXPECT_NE(editor.draft().find("on FALSE"), std::string::npos);
}

// Edits a world, reads another from the draft, edits that, and saves it.
void goesOn(const std::string& name, const std::string& text, const std::string& insertion,
            bool isPacked) {
  const Folder folder;
  const std::string path = folder.write(name, isPacked ? packed(text) : text);
  std::string draft;
  {
    const auto world = loadWorld(path);
    Editor editor(*world);
    editor.set(*world->scope.names.at("L"), "on", false);
    editor.insert({nullptr, "", 1}, insertion);
    draft = editor.draft();
    EXPECT_EQ(draft, editor.text());
  }
  const auto world = loadWorldFromMemory(draft, path);
  Editor editor(*world);
  editor.adopt(draft);
  EXPECT_TRUE(editor.isChanged());
  EXPECT_FALSE(editor.isChangedOnDisk());
  EXPECT_EQ(editor.undoName(), "");
  EXPECT_EQ(editor.textOnDisk(), text);
  EXPECT_EQ(editor.text(), draft);
  editor.set(*world->scope.names.at("NEW"), "on", false); // what was inserted is the file's now
  editor.set(*world->scope.names.at("L"), "on", true);
  EXPECT_TRUE(editor.undo() && editor.undo());
  EXPECT_EQ(editor.text(), draft);
  EXPECT_TRUE(editor.isChanged());
  EXPECT_EQ(editor.bytes(), isPacked ? packed(draft) : draft);
  editor.saved();
  EXPECT_FALSE(editor.isChanged());
  EXPECT_THROW(editor.adopt(text), EditError) << "it has been edited";
}

TEST(EditDraft, EditingGoesOnInEveryEncoding) {
  const std::string classic = "#VRML V2.0 utf8\n# two\nDEF L PointLight { }\n";
  goesOn("w.wrl", classic, "DEF NEW SpotLight { }", false);
  goesOn("w.wrz", classic, "DEF NEW SpotLight { }", true);
  goesOn("w.x3dv", "#X3D V3.3 utf8\nPROFILE Immersive\nDEF L PointLight { }\n",
         "DEF NEW SpotLight { }", false);
  goesOn("w.x3d",
         "<X3D profile='Immersive' version='3.3'>\n  <Scene>\n    <PointLight DEF='L'/>\n"
         "  </Scene>\n</X3D>\n",
         "<SpotLight DEF='NEW'/>", false);
}

TEST(EditDraft, AWorldThatIsNoFileAdoptsNothing) {
  const auto world = loadWorldFromMemory("#VRML V2.0 utf8\n", "nowhere.wrl");
  Editor editor(*world);
  EXPECT_THROW(editor.adopt("#VRML V2.0 utf8\nGroup { }\n"), EditError);
  EXPECT_THROW(editor.textOnDisk(), EditError);
  EXPECT_FALSE(editor.isChanged());
}

} // namespace
} // namespace xvrml
