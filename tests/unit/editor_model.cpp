// editor_model.cpp: Tests what the panels of the editor show, and what their commands do.
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "edit/actions.h"
#include "edit/edit_model.h"
#include "unit/editor_support.h"

namespace {

using namespace editor_test;
using namespace vv;
using namespace xvrml;

constexpr const char* hall = "#VRML V2.0 utf8\n"
                             "# The hall\n"
                             "Viewpoint { position 0 0 10 fieldOfView 0.785398 }\n"
                             "DEF LAMP PointLight { intensity 0.80 # by day\n"
                             "}\n"
                             "DEF TABLE Transform { translation 2 0 0 children [\n"
                             "  DEF LEG Shape { appearance Appearance {\n"
                             "    material DEF WOOD Material { } } geometry Box { } }\n"
                             "  DEF TWICE Group { children USE LEG }\n"
                             "] }\n";

std::vector<std::string> labels(const EditModel& model) {
  std::vector<std::string> all;
  for (const OutlineRow& row : model.rows())
    all.push_back(std::string(size_t(row.depth), '.') + (row.isUse ? "USE " : "") + row.label());
  return all;
}

PropertyRow& row(EditModel& model, const std::string& name) {
  for (PropertyRow& one : model.sheet().rows)
    if (one.field->name == name) return one;
  throw std::out_of_range(name);
}

struct Model : testing::Test {
  EditedWorld world{hall};
  EditModel model;
  EditView view = front();
  bool update(double seconds = 0, bool moves = false) {
    return model.update(world.editor, view, moves, seconds);
  }
};

TEST_F(Model, TheOutlineShowsWhatIsOpen) {
  update();
  EXPECT_EQ(labels(model),
            (std::vector<std::string>{"Viewpoint", "LAMP  PointLight", "TABLE  Transform"}));
  model.setOpen(world.node("TABLE"), true);
  model.setOpen(world.node("TWICE"), true);
  update();
  EXPECT_EQ(labels(model),
            (std::vector<std::string>{"Viewpoint", "LAMP  PointLight", "TABLE  Transform",
                                      ".LEG  Shape", ".TWICE  Group", "..USE LEG  Shape"}));
  EXPECT_FALSE(update()) << "nothing else is shown";
  model.setOpen(world.node("TABLE"), false);
  update();
  EXPECT_EQ(model.rows().size(), 3u);
}

TEST_F(Model, ASelectionIsRevealedAndFramed) {
  model.select(world.node("WOOD"), false);
  update();
  EXPECT_EQ(labels(model).at(4), "..appearance: Appearance");
  EXPECT_EQ(labels(model).at(5), "...material: WOOD  Material");
  EXPECT_EQ(model.takeScroll(), 5);
  EXPECT_EQ(model.takeScroll(), -1);
  EXPECT_EQ(model.sheet().title, "WOOD  Material");
  EXPECT_TRUE(model.isSelected(*world.node("WOOD")));
  // The box of its Shape: from x = 1 to 3 at z = 1, so 9 before the viewer.
  ASSERT_EQ(model.frames().size(), 12u);
  double least = 1, most = -1;
  for (const EditModel::Line& line : model.frames()) {
    least = std::min({least, line.x0, line.x1});
    most = std::max({most, line.x0, line.x1});
  }
  EXPECT_NEAR(least, 1 / (11 * std::tan(0.785398 / 2)), 1e-4);
  EXPECT_NEAR(most, 3 / (9 * std::tan(0.785398 / 2)), 1e-4);
}

TEST_F(Model, TheViewerGoesToTheSelection) {
  model.select(world.node("LEG"), false);
  update();
  for (const double aspect : {0.5, 1.0, 2.0}) {
    view.aspect = aspect;
    view.camera = model.cameraAround(world.editor, view);
    update();
    double most = 0;
    for (const EditModel::Line& line : model.frames())
      for (const double place : {line.x0, line.y0, line.x1, line.y1})
        most = std::max(most, std::abs(place));
    EXPECT_LT(most, 1) << aspect;
    EXPECT_GT(most, 0.4) << aspect;
  }
  model.select(nullptr, false);
  update();
  const CameraSettings same = model.cameraAround(world.editor, view);
  EXPECT_TRUE(std::equal(same.matrix, same.matrix + 16, view.camera.matrix));
}

TEST_F(Model, ALampHasNoFrameOfItsNeighbours) {
  model.select(world.node("LAMP"), false);
  update();
  EXPECT_TRUE(model.frames().empty());
}

TEST_F(Model, SearchesFindNamesTypesAndFields) {
  update();
  for (const auto& [text, found] :
       {std::pair("wood", 1u), {"SHAPE", 1u}, {"intensity", 2u}, {"transl", 1u}, {"nothing", 0u}}) {
    model.search(text);
    update();
    EXPECT_EQ(model.rows().size(), found) << text;
  }
  model.search("");
  update();
  EXPECT_EQ(model.rows().size(), 3u);
}

TEST_F(Model, ADragIsOneStep) {
  model.select(world.node("LAMP"), false);
  update();
  const FieldInfo& intensity = *row(model, "intensity").field;
  EXPECT_FALSE(row(model, "intensity").isDefault);
  EXPECT_TRUE(row(model, "color").isDefault);
  for (const float value : {0.7f, 0.6f, 0.5f}) {
    model.drag(world.node("LAMP"), intensity, value);
    update();
  }
  model.setActive(false);
  update();
  EXPECT_EQ(std::get<float>(row(model, "intensity").value), 0.5f);
  EXPECT_EQ(model.undoName(), "Set PointLight.intensity");
  EXPECT_TRUE(model.hasUnsaved());
  EXPECT_NE(world.editor.editor().text().find("intensity 0.5 # by day"), std::string::npos);
  model.request([](WorldEditor& editor) { editor.undo(); });
  update();
  EXPECT_EQ(world.editor.editor().text(), hall);
  EXPECT_EQ(model.undoName(), "");
  EXPECT_EQ(model.redoName(), "Set PointLight.intensity");
}

// A drag in a large world must not read the outline and the places of all nodes again.
TEST_F(Model, AValueChangesNoRows) {
  model.select(world.node("LAMP"), false);
  update();
  const OutlineRow* const first = model.rows().data();
  const uint64_t nodes = world.editor.editor().nodeChanges();
  world.editor.editor().set(*world.node("LAMP"), "intensity", 0.25f);
  EXPECT_TRUE(update());
  EXPECT_EQ(model.rows().data(), first);
  EXPECT_EQ(std::get<float>(row(model, "intensity").value), 0.25f);
  EXPECT_TRUE(model.hasUnsaved());
  world.editor.undo();
  EXPECT_TRUE(update());
  EXPECT_EQ(model.rows().data(), first);
  EXPECT_EQ(std::get<float>(row(model, "intensity").value), 0.8f);
  EXPECT_EQ(world.editor.editor().nodeChanges(), nodes);
  world.editor.editor().rename(*world.node("LAMP"), "SUN");
  EXPECT_TRUE(update());
  EXPECT_EQ(model.rows().at(1).label(), "SUN  PointLight");
  EXPECT_EQ(model.sheet().title, "SUN  PointLight");
  EXPECT_GT(world.editor.editor().nodeChanges(), nodes);
  world.editor.undo();
  update();
  EXPECT_EQ(model.rows().at(1).label(), "LAMP  PointLight");
}

// So does a selection, where there are many rows: those of what it opens are added to the others.
TEST(EditModel, ASelectionReadsNoOtherRows) {
  std::string others; // which are not shown below
  for (int i = 0; i < 10'001; ++i) others += "Group { }\n";
  EditedWorld world("#VRML V2.0 utf8\n"
                    "DEF A Group { children DEF B Group { children [ DEF C Group { } DEF D Group { "
                    "children Group { } } ] } }\n"
                    "DEF E Group { children [ DEF F Group { } USE C ] } DEF G Group { }\n" +
                    others);
  EditModel model;
  double seconds = 0;
  const auto rows = [&](EditModel& shown) {
    shown.update(world.editor, front(), false, seconds += 1);
    std::string text;
    for (const OutlineRow& row : shown.rows()) {
      if (row.depth == 0 && row.node->defName.empty()) break;
      text += std::string(size_t(row.depth), '.') + (row.isUse ? "USE " : "") + row.node->defName +
              (row.isOpen    ? "-"
               : row.canOpen ? "+"
                             : "") +
              " ";
    }
    return text;
  };
  // Shows the same nodes by reading all rows.
  const auto expectAsRead = [&](std::initializer_list<const char*> opened) {
    EditModel read;
    rows(read);
    for (const char* name : opened) read.setOpen(world.node(name), true);
    EXPECT_EQ(rows(model), rows(read));
  };
  EXPECT_EQ(rows(model), "A+ E+ G ");
  const OutlineRow* const first = model.rows().data();
  world.editor.choose(world.node("G"), false);
  EXPECT_EQ(rows(model), "A+ E+ G ");
  EXPECT_EQ(model.rows().data(), first);
  EXPECT_EQ(model.takeScroll(), 2);
  world.editor.choose(world.node("D"), false);
  EXPECT_EQ(rows(model), "A- .B- ..C ..D+ E+ G ");
  EXPECT_EQ(model.takeScroll(), 3);
  expectAsRead({"A", "B"});
  world.editor.choose(world.node("F"), false); // C has two places then
  EXPECT_EQ(rows(model), "A- .B- ..C ..D+ E- .F .USE C G ");
  expectAsRead({"A", "B", "E"});
  // A node that is open already brings its rows.
  model.setOpen(world.node("A"), false);
  EXPECT_EQ(rows(model), "A+ E- .F .C G ");
  world.editor.choose(world.node("D"), false);
  EXPECT_EQ(rows(model), "A- .B- ..C ..D+ E- .F .USE C G ");
  world.editor.choose(world.node("G"), false);
  world.editor.editor().remove({nullptr, "", 1});
  EXPECT_EQ(rows(model), "A- .B- ..C ..D+ G ");
}

TEST_F(Model, WrongValuesAreSaidAndChangeNothing) {
  model.select(world.node("LAMP"), false);
  update();
  const FieldInfo& field = *row(model, "intensity").field;
  for (const float value : {-1.f, 2.f, std::numeric_limits<float>::quiet_NaN()}) {
    model.drag(world.node("LAMP"), field, value);
    model.setActive(false);
    update();
    EXPECT_NE(model.takeMessage().find("PointLight.intensity"), std::string::npos);
    EXPECT_EQ(model.takeMessage(), "");
  }
  EXPECT_EQ(world.editor.editor().text(), hall);
  EXPECT_EQ(model.undoName(), "");
}

TEST_F(Model, WhatRoutesAndScriptsChangeIsShownLater) {
  model.select(world.node("LAMP"), false);
  update(1);
  world.browser.set(*world.node("LAMP"), "intensity", 0.25f);
  update(1.1, true);
  EXPECT_EQ(std::get<float>(row(model, "intensity").value), 0.8f);
  update(1.3, true);
  EXPECT_EQ(std::get<float>(row(model, "intensity").value), 0.25f);
}

TEST_F(Model, EditsOfOthersAreShown) {
  update();
  world.editor.editor().remove({nullptr, "", 1});
  EXPECT_TRUE(update());
  EXPECT_EQ(model.rows().size(), 2u);
  EXPECT_EQ(model.undoName(), "Remove PointLight");
  world.editor.undo();
  EXPECT_TRUE(update());
  EXPECT_EQ(model.rows().size(), 3u);
}

TEST_F(Model, AClickSelectsWhatIsThere) {
  const double x = 2 / (9 * std::tan(0.785398 / 2));
  selectAt(world.editor, view, x, 0, false, false);
  EXPECT_EQ(world.editor.selected(), world.node("LEG").get());
  selectAt(world.editor, view, x, 0, true, false);
  EXPECT_EQ(world.editor.selected(), world.node("TABLE").get());
  selectAt(world.editor, view, x, 0, false, true);
  EXPECT_EQ(world.editor.selection().size(), 2u);
  selectAt(world.editor, view, x, 0, false, true);
  EXPECT_EQ(world.editor.selection().size(), 1u) << "a second time takes it out";
  selectAt(world.editor, view, -0.9, 0.9, false, false);
  EXPECT_EQ(world.editor.selected(), nullptr);
}

TEST_F(Model, ActionsAreOneStepEach) {
  Editor& editor = world.editor.editor();
  world.editor.select({world.node("LAMP"), world.node("TWICE")});
  duplicateSelected(world.editor);
  ASSERT_EQ(world.editor.selection().size(), 2u);
  EXPECT_EQ(world.editor.selection()[0]->defName, "LAMP_2");
  EXPECT_EQ(editor.undoName(), "Duplicate 2 nodes");
  removeSelected(world.editor);
  EXPECT_TRUE(world.editor.selection().empty());
  world.editor.undo();
  world.editor.undo();
  EXPECT_EQ(editor.text(), hall);
  world.editor.select({world.node("LAMP")});
  wrapSelected(world.editor);
  EXPECT_EQ(world.editor.selected()->type().name, "Transform");
  for (const NewNode& one : newNodes()) {
    add(world.editor, one);
    EXPECT_NE(editor.text().find(one.name), std::string::npos);
  }
  while (!world.editor.undo().empty()) {}
  EXPECT_EQ(editor.text(), hall);
}

TEST_F(Model, AGroupIsRemovedWithWhatIsInIt) {
  for (const bool childFirst : {false, true}) {
    MFNode both = {world.node("TABLE"), world.node("TWICE")};
    if (childFirst) std::swap(both[0], both[1]);
    world.editor.select(both);
    removeSelected(world.editor);
    EXPECT_EQ(world.editor.editor().text().find("TWICE"), std::string::npos);
    world.editor.undo();
  }
}

TEST_F(Model, ANodeInSeveralPlacesIsNotRemovedBySurprise) {
  world.editor.select({world.node("LAMP"), world.node("LEG")});
  EXPECT_THROW(removeSelected(world.editor), EditError);
  EXPECT_EQ(world.editor.editor().text(), hall) << "the lamp is still there";
}

TEST_F(Model, AViewpointLooksAsTheViewerDoes) {
  for (const double angle : {0.0, 0.3, 2.0, 3.1}) {
    view.camera.matrix[0] = view.camera.matrix[10] = std::cos(angle);
    view.camera.matrix[8] = std::sin(angle);
    view.camera.matrix[2] = -std::sin(angle);
    world.editor.select({});
    addViewpoint(world.editor, view);
    world.browser.set(*world.editor.selected(), "set_bind", true);
    const CameraSettings camera = world.browser.camera(1);
    for (size_t i = 0; i < 16; ++i)
      EXPECT_NEAR(camera.matrix[i], view.camera.matrix[i], 1e-5) << angle << " " << i;
    EXPECT_NEAR(camera.fovy, view.camera.fovy, 1e-5);
  }
}

TEST(EditorModel, ReadOnlyFilesSayWhy) {
  EditedWorld world("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "obj");
  EditModel model;
  model.update(world.editor, front(), false, 0);
  EXPECT_NE(model.readOnly(), "");
}

TEST(EditorModel, HostileNamesAndLongListsAreShown) {
  std::string points;
  for (int i = 0; i < 1000; ++i) points += std::to_string(i) + " 0 0 ";
  const std::string name(10'000, 'n');
  EditedWorld world("#VRML V2.0 utf8\nDEF " + name + " Group { }\nDEF A##b\x1b[31m Group { }\n" +
                    "DEF P Coordinate { point [ " + points + "] }\nDEF G Group { children [\n" +
                    "Shape { geometry PointSet { coord USE P } } ] }");
  EditModel model;
  model.select(world.node("P"), false);
  model.update(world.editor, front(), false, 0);
  EXPECT_LT(model.rows().at(0).label().size(), 100u);
  for (const OutlineRow& one : model.rows()) EXPECT_EQ(one.label().find('\x1b'), std::string::npos);
  if (!model.sheet().node) return; // a Coordinate among the roots may be left out
  EXPECT_TRUE(row(model, "point").isLong);
  EXPECT_EQ(row(model, "point").size, 1000u);
}

// Returns the least and the greatest x of a frame.
std::pair<double, double> extent(const EditModel& model) {
  std::pair<double, double> x(9, -9);
  for (const EditModel::Line& line : model.frames())
    x = {std::min({x.first, line.x0, line.x1}), std::max({x.second, line.x0, line.x1})};
  return x;
}

TEST_F(Model, TheViewerGoesToTheSelectionBetweenPanels) {
  model.select(world.node("LEG"), false);
  update();
  const FreePart free{-0.5, 0.2};
  for (const double height : {0.0, 4.0}) { // in perspective, and parallel
    if (height > 0) view.camera.fovy = 0;
    view.camera.height = height;
    view.aspect = 1.5;
    view.camera = model.cameraAround(world.editor, view, free);
    update();
    const auto [left, right] = extent(model);
    EXPECT_NEAR((left + right) / 2, free.middle(), .02);
    if (height > 0) continue;
    EXPECT_GT(left, free.left);
    EXPECT_LT(right, free.right);
  }
}

// The strings of a text, of which the user types one while another program sets the others.
struct TextModel : testing::Test {
  EditedWorld world{"#VRML V2.0 utf8\nDEF T Text { string [ \"a\", \"b\" ] }\n"
                    "Shape { geometry USE T }\n"};
  EditModel model;
  void SetUp() override {
    world.editor.select({world.node("T")});
    update();
    model.setActive(true); // the user begins to type
  }
  void update() { model.update(world.editor, front(), false, 0); }
  MFString shown() { return std::get<MFString>(row(model, "string").value); }
  MFString now() {
    const Node& node = *world.node("T");
    return std::get<MFString>(node.get(*node.type().find("string")));
  }
  void type(MFString value) { model.drag(world.node("T"), *row(model, "string").field, value); }
};

TEST_F(TextModel, WhatOthersSetMeanwhileStays) {
  world.browser.set(*world.node("T"), "string", MFString{"a", "theirs"});
  EXPECT_EQ(shown(), (MFString{"a", "b"}));
  type({"mine", "b"});
  model.setActive(false);
  update();
  EXPECT_EQ(now(), (MFString{"mine", "theirs"}));
  EXPECT_EQ(shown(), now());
  EXPECT_EQ(model.takeMessage(), "");
}

TEST_F(TextModel, AValueThatIsSetBackIsTheUsersToo) {
  type({"mine", "b"});
  update();
  type({"a", "b"}); // still the same step
  update();
  EXPECT_EQ(now(), (MFString{"a", "b"}));
}

TEST_F(TextModel, AnotherLengthIsNotOverwritten) {
  world.browser.set(*world.node("T"), "string", MFString{"x", "y", "z"});
  type({"mine", "b"});
  model.setActive(false);
  update();
  EXPECT_EQ(now(), (MFString{"x", "y", "z"}));
  EXPECT_EQ(model.takeMessage(), "Text.string has changed meanwhile: its value stays");
  EXPECT_EQ(model.undoName(), "");
}

TEST_F(TextModel, TheUserAddsElementsOneAfterTheOther) {
  type({"a", "b", "c"});
  type({"a", "b", "c", "d"});
  update();
  type({"a", "b", "c", "d", "e"}); // the panel has not been read again
  update();
  EXPECT_EQ(now().size(), 5u);
  EXPECT_EQ(model.takeMessage(), "");
}

} // namespace
