// editor_sheet.cpp: Tests the sheet of a node: fields of nodes, looks, parameters of shaders, and
// what happens when several edit at a time.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "edit/actions.h"
#include "edit/choices.h"
#include "edit/edit_model.h"
#include "edit/shader_parameters.h"
#include "edit/transform_tool.h"
#include "unit/editor_support.h"
#include "window/panel_state.h"
#include "xvrml/nodes.h"

namespace {

using namespace editor_test;
using namespace vv;
using namespace xvrml;

constexpr const char* room =
    "#VRML V2.0 utf8\n"
    "DEF A Shape {\n"
    "  appearance DEF PAINT Appearance {\n"
    "    material DEF WOOD Material { diffuseColor 1 0 0 }\n"
    "    texture DEF GRAIN PixelTexture { }\n"
    "  }\n"
    "  geometry Box { }\n"
    "}\n"
    "DEF B Shape { appearance USE PAINT geometry Sphere { } }\n"
    "DEF C Shape {\n"
    "  appearance Appearance { material Material { diffuseColor 1 0 0 } }\n"
    "}\n"
    "DEF D Shape { geometry Cone { } }\n"
    "DEF G Group { children [\n"
    "  DEF ONE PointLight { }\n"
    "  DEF TWO PointLight { } # second\n"
    "] }\n"
    "DEF T Shape { geometry Text { fontStyle DEF F FontStyle { } } }\n";

constexpr const char* roomInXml =
    "<X3D profile='Immersive' version='4.0'>\n"
    "  <Scene>\n"
    "    <Shape DEF='A'>\n"
    "      <Appearance DEF='PAINT'><Material DEF='WOOD' diffuseColor='1 0 0'/></Appearance>\n"
    "      <Box/>\n"
    "    </Shape>\n"
    "    <Shape DEF='B'><Appearance USE='PAINT'/><Sphere/></Shape>\n"
    "    <Group DEF='G'>\n"
    "      <PointLight DEF='ONE'/>\n"
    "      <PointLight DEF='TWO'/>\n"
    "    </Group>\n"
    "  </Scene>\n"
    "</X3D>\n";

struct Sheet : testing::Test {
  explicit Sheet(const char* text = room, const char* suffix = "wrl")
      : original(text), world(text, suffix) {}

  void update() { model.update(world.editor, front(), false, 0); }
  std::string text() { return world.editor.editor().text(); }
  bool has(const std::string& part) { return text().find(part) != std::string::npos; }
  void select(std::initializer_list<const char*> names) {
    MFNode nodes;
    for (const char* name : names) nodes.push_back(world.node(name));
    world.editor.select(nodes);
    update();
  }
  PropertyRow& row(const std::string& name) {
    for (PropertyRow& one : model.sheet().rows)
      if (one.field->name == name) return one;
    throw std::out_of_range(name);
  }
  Look look(const std::string& name) {
    for (const Look& one : looksFor(world.editor))
      if (one.name == name) return one;
    throw std::out_of_range(name);
  }
  PlacedNode childOf(const char* parent, const char* field, size_t index) {
    const NodeRef node = world.node(parent);
    const Value value = node->get(*node->type().find(field));
    const auto* const list = std::get_if<MFNode>(&value);
    return {list ? list->at(index) : std::get<SFNode>(value), node, field, index};
  }
  void undoAll() {
    while (!world.editor.undo().empty()) {}
    EXPECT_EQ(text(), original);
  }

  const std::string original;
  EditedWorld world;
  EditModel model;
};
struct SheetInXml : Sheet {
  SheetInXml() : Sheet(roomInXml, "x3d") {}
};

// --- Fields of nodes ---

TEST_F(Sheet, AFieldOffersWhatItMayHold) {
  select({"A"});
  const auto offers = [&](const char* field, const char* type) {
    const auto& types = row(field).addable;
    return std::any_of(types.begin(), types.end(),
                       [&](const NodeType* one) { return one->name == type; });
  };
  EXPECT_TRUE(offers("geometry", "IndexedFaceSet"));
  EXPECT_FALSE(offers("geometry", "Appearance"));
  EXPECT_TRUE(offers("appearance", "ORTAppearance"));
  const auto& usable = row("appearance").usable;
  EXPECT_EQ(std::count(usable.begin(), usable.end(), world.node("PAINT")), 1);
  EXPECT_EQ(std::count(usable.begin(), usable.end(), world.node("WOOD")), 0);
  EXPECT_EQ(row("appearance").places, std::vector<size_t>{2});
  EXPECT_EQ(row("geometry").places, std::vector<size_t>{1});
}

TEST_F(Sheet, ShowingANodeMakesNoRareFields) {
  const auto isUnset = [&] {
    const NodeRef node = world.node("PAINT");
    return node->isUnset(*node->type().find("alphaMode"));
  };
  ASSERT_TRUE(isUnset());
  select({"PAINT"});
  EXPECT_EQ(std::get<SFString>(row("alphaMode").value), "AUTO");
  update();
  EXPECT_TRUE(row("alphaMode").isDefault);
  world.editor.editor().set(*world.node("WOOD"), "shininess", .5f);
  text(); // it is read back, and compared
  EXPECT_TRUE(isUnset());
  world.editor.editor().set(*world.node("PAINT"), "alphaMode", std::string("OPAQUE"));
  update();
  EXPECT_EQ(std::get<SFString>(row("alphaMode").value), "OPAQUE");
  undoAll();
}

TEST_F(Sheet, NodesAreAddedUsedAndRemoved) {
  addNode(world.editor, world.node("D"), "appearance", *findNodeType("Appearance"));
  EXPECT_TRUE(has("DEF D Shape { geometry Cone { } appearance Appearance { } }\n"));
  useNode(world.editor, world.node("T"), "appearance", world.node("PAINT"));
  EXPECT_EQ(world.editor.editor().placesOf(*world.node("PAINT")).size(), 3u);
  removeAt(world.editor, childOf("B", "appearance", 0));
  EXPECT_TRUE(has("DEF B Shape { geometry Sphere { } }\n"));
  addNode(world.editor, world.node("A"), "geometry", *findNodeType("Cone"));
  EXPECT_FALSE(has("Box")) << "an SFNode holds one node";
  addNode(world.editor, world.node("G"), "children", *findNodeType("SpotLight"));
  EXPECT_TRUE(has("# second\n  SpotLight { }\n"));
  undoAll();
}

TEST_F(SheetInXml, NodesAreAddedUsedAndRemoved) {
  addNode(world.editor, world.node("G"), "children", *findNodeType("SpotLight"));
  EXPECT_TRUE(has("      <PointLight DEF='TWO'/>\n      <SpotLight/>\n"));
  removeAt(world.editor, childOf("B", "appearance", 0));
  EXPECT_TRUE(has("<Shape DEF='B'><Sphere/></Shape>"));
  addNode(world.editor, world.node("PAINT"), "backMaterial", *findNodeType("Material"));
  EXPECT_TRUE(has("containerField='backMaterial'"));
  moveBy(world.editor, childOf("G", "children", 0), 1);
  EXPECT_LT(text().find("TWO"), text().find("ONE"));
  undoAll();
}

TEST_F(Sheet, NodesMoveWithinTheirList) {
  moveBy(world.editor, childOf("G", "children", 0), -1);
  EXPECT_EQ(text(), original) << "it is the first one";
  moveBy(world.editor, childOf("G", "children", 0), 1);
  EXPECT_LT(text().find("DEF TWO"), text().find("DEF ONE"));
  moveBy(world.editor, childOf("G", "children", 1), 1);
  EXPECT_LT(text().find("DEF TWO"), text().find("DEF ONE")) << "it is the last one";
  undoAll();
}

TEST_F(Sheet, ANodeThatHasGoneMeanwhileIsNotTouched) {
  const PlacedNode place = childOf("G", "children", 1);
  world.editor.editor().remove({world.node("G").get(), "children", 0});
  EXPECT_THROW(removeAt(world.editor, place), EditError);
  EXPECT_TRUE(has("DEF TWO"));
}

TEST_F(Sheet, AUseIsMadeSeparate) {
  select({"PAINT"});
  EXPECT_NE(model.sheet().note.find("2 places"), std::string::npos);
  separateAt(world.editor, childOf("B", "appearance", 0));
  update();
  EXPECT_EQ(model.sheet().node->defName, "PAINT_2") << "the copy is selected";
  EXPECT_TRUE(has("DEF B Shape { appearance DEF PAINT_2 Appearance {"));
  undoAll();
}

// --- Looks ---

TEST_F(Sheet, AShapeGetsAMaterial) {
  select({"D"});
  EXPECT_TRUE(model.sheet().hasLook);
  EXPECT_EQ(model.sheet().look.name, "");
  setLook(world.editor, look("PhysicalMaterial"), true);
  EXPECT_TRUE(has("appearance Appearance { material PhysicalMaterial { } }"));
  update();
  EXPECT_EQ(model.sheet().look.name, "PhysicalMaterial");
  EXPECT_EQ(world.editor.editor().undoName(), "Set look PhysicalMaterial");
  undoAll();
}

TEST_F(Sheet, ColoursAndTexturesStay) {
  select({"A"});
  EXPECT_EQ(model.sheet().look.places, 2u);
  setLook(world.editor, look("PhysicalMaterial"), false);
  EXPECT_TRUE(has("PhysicalMaterial { baseColor 1 0 0 }")) << text();
  EXPECT_TRUE(has("texture DEF GRAIN PixelTexture"));
  EXPECT_TRUE(has("DEF B Shape { appearance USE PAINT"));
  undoAll();
}

TEST_F(Sheet, OnlyHereIsACopy) {
  select({"B"});
  setLook(world.editor, look("UnlitMaterial"), true);
  EXPECT_TRUE(has("material DEF WOOD Material { diffuseColor 1 0 0 }"));
  EXPECT_TRUE(has("UnlitMaterial { emissiveColor 1 0 0 }")) << text();
  undoAll();
  select({"A", "B"}); // all places are selected: no copy is needed
  setLook(world.editor, look("UnlitMaterial"), true);
  EXPECT_TRUE(has("DEF B Shape { appearance USE PAINT"));
  EXPECT_FALSE(has("DEF WOOD"));
  undoAll();
}

TEST_F(Sheet, AShaderTakesTheAppearanceOver) {
  select({"A"});
  setLook(world.editor, look("Glass"), false);
  EXPECT_TRUE(has("appearance DEF PAINT ORTAppearance {")) << text();
  EXPECT_TRUE(has("DEF B Shape { appearance USE PAINT"));
  EXPECT_TRUE(has("texture DEF GRAIN PixelTexture"));
  EXPECT_TRUE(has("material DEF WOOD Material"));
  update();
  EXPECT_EQ(model.sheet().look.name, "Glass");
  ASSERT_NE(nodeCast<nodes::ORTShader>(model.sheet().look.surface), nullptr);
  setLook(world.editor, look("Metal"), false);
  EXPECT_TRUE(has("name \"Metal\"") && !has("Glass")) << text();
  setLook(world.editor, look("Material"), false);
  EXPECT_FALSE(has("ORTShader"));
  EXPECT_TRUE(has("material DEF WOOD Material"));
  undoAll();
}

TEST_F(Sheet, AShaderOnlyHere) {
  select({"B", "D"});
  setLook(world.editor, look("Glass"), true);
  EXPECT_TRUE(has("appearance DEF PAINT Appearance {")) << text();
  EXPECT_EQ(world.node("PAINT")->type().name, "Appearance");
  EXPECT_EQ(lookOf(*world.node("B")).name, "Glass");
  EXPECT_EQ(lookOf(*world.node("D")).name, "Glass");
  undoAll();
}

TEST_F(SheetInXml, AShapeGetsAShader) {
  select({"A"});
  setLook(world.editor, look("Glass"), false);
  EXPECT_TRUE(has("<ORTAppearance DEF='PAINT'>")) << text();
  EXPECT_TRUE(has("<ORTShader name='Glass' file='glass'/>")) << text();
  EXPECT_TRUE(has("<Shape DEF='B'><ORTAppearance USE='PAINT'/><Sphere/></Shape>")) << text();
  undoAll();
}

TEST_F(Sheet, AllWithTheSameLook) {
  select({"B"});
  selectSameLook(world.editor);
  EXPECT_EQ(world.editor.selection(), (MFNode{world.node("A"), world.node("B"), world.node("C")}));
  select({"WOOD"});
  selectSameLook(world.editor);
  EXPECT_EQ(world.editor.selection().size(), 3u);
  select({"D"});
  EXPECT_THROW(selectSameLook(world.editor), EditError);
}

// --- Parameters of shaders ---

TEST_F(Sheet, ParametersAreRowsUntilTheyAreDeclared) {
  select({"D"});
  setLook(world.editor, look("Glass"), true);
  const auto shader = lookOf(*world.node("D")).surface;
  world.editor.select({shader});
  update();
  EXPECT_FALSE(row("index").isDeclared);
  EXPECT_TRUE(row("index").isDefault);
  EXPECT_EQ(std::get<SFFloat>(row("index").value), 1.5f);
  EXPECT_NE(row("index").help.find("range [0.1,10]"), std::string::npos) << row("index").help;
  for (const float value : {1.4f, 1.3f}) {
    model.drag(model.sheet().node, *row("index").field, value);
    model.setActive(true);
    update();
    EXPECT_FALSE(has("index")) << "the field is declared at the end of a drag";
  }
  model.setActive(false);
  update();
  EXPECT_TRUE(has("exposedField SFFloat index 1.3")) << text();
  EXPECT_TRUE(row("index").isDeclared);
  EXPECT_FALSE(row("index").isDefault);
  EXPECT_EQ(std::get<SFFloat>(row("index").value), 1.3f);
  EXPECT_NE(row("index").help.find("index of refraction"), std::string::npos);
  model.drag(model.sheet().node, *row("index").field, 1.5f);
  model.setActive(false);
  update();
  EXPECT_TRUE(row("index").isDefault) << "the class says which value this is";
  undoAll();
}

TEST(EditorSheet, AnotherClassHasOtherParameters) {
  EditedWorld world("#VRML V2.0 utf8\nShape { appearance ORTAppearance { shader DEF S ORTShader {\n"
                    "name \"Glass\" options \"1f index 1.2\" } } }\n");
  EditModel model;
  world.editor.select({world.node("S")});
  model.update(world.editor, front(), false, 0);
  ASSERT_NE(model.sheet().find("index"), nullptr);
  world.editor.editor().set(*world.node("S"), "options", MFString());
  model.update(world.editor, front(), false, 0);
  EXPECT_FALSE(model.sheet().find("index")->isInOptions);
  world.editor.editor().set(*world.node("S"), "name", std::string("Diffuse"));
  model.update(world.editor, front(), false, 0);
  EXPECT_EQ(model.sheet().find("index"), nullptr);
  EXPECT_NE(model.sheet().find("reflectance"), nullptr);
}

// --- Choices ---

TEST_F(Sheet, FieldsOfWordsOfferThem) {
  select({"F"});
  EXPECT_EQ(row("style").choices,
            (std::vector<std::string>{"PLAIN", "BOLD", "ITALIC", "BOLDITALIC"}));
  EXPECT_EQ(row("justify").choices.size(), 4u);
  EXPECT_EQ(row("family").choices, (std::vector<std::string>{"SERIF", "SANS", "TYPEWRITER"}));
  EXPECT_TRUE(row("language").choices.empty());
  size_t found = 0;
  for (const NodeType* type : nodeTypes())
    for (const FieldInfo& field : type->fields) found += choicesOf(field).empty() ? 0 : 1;
  EXPECT_GE(found, 10u);
}

// --- Several who edit ---

TEST_F(Sheet, EditedFieldsAreKnown) {
  select({"ONE"});
  EXPECT_EQ(row("intensity").edits, 0u);
  model.drag(world.node("ONE"), *row("intensity").field, 0.5f);
  model.setActive(false);
  update();
  EXPECT_EQ(row("intensity").edits, 1u);
  EXPECT_EQ(row("on").edits, 0u);
  world.editor.undo();
  update();
  EXPECT_EQ(row("intensity").edits, 0u);
}

TEST_F(Sheet, WhatAnotherProgramHasSetStays) {
  select({"F"});
  MFString typed = std::get<MFString>(row("justify").value);
  model.setActive(true); // the user types
  update();
  world.editor.editor().set(*world.node("F"), "justify", MFString{"MIDDLE", "END"});
  update();
  typed.at(0) = "FIRST";
  model.drag(world.node("F"), *row("justify").field, typed);
  model.setActive(false);
  update();
  EXPECT_NE(model.takeMessage().find("FontStyle.justify"), std::string::npos);
  EXPECT_TRUE(has("justify [ \"MIDDLE\", \"END\" ]")) << text();
  EXPECT_EQ(std::get<MFString>(row("justify").value), (MFString{"MIDDLE", "END"}));
  model.drag(world.node("F"), *row("justify").field, MFString{"END"});
  model.setActive(false);
  update();
  EXPECT_TRUE(has("justify \"END\"") || has("justify [ \"END\" ]")) << text();
}

TEST_F(Sheet, TwoEditsBeforeTheWorldIsFreeAreNoConflict) {
  select({"ONE"});
  for (const bool value : {false, true}) {
    model.drag(world.node("ONE"), *row("on").field, value);
    model.setActive(false);
  }
  model.drag(world.node("ONE"), *row("intensity").field, 0.5f);
  model.drag(world.node("ONE"), *row("radius").field, 5.f);
  model.setActive(false);
  update();
  EXPECT_EQ(model.takeMessage(), "");
  EXPECT_EQ(world.editor.editor().editsOf(*world.node("ONE"), "on"), 2u);
  EXPECT_EQ(world.editor.undo(), "Set PointLight.radius") << "each field is a step";
}

TEST_F(Sheet, PanelsDoNotEditWithinAMove) {
  select({"G"});
  world.editor.select({world.node("ONE")});
  TransformTool tool(world.editor, TransformTool::Kind::move, front(), 0, 0);
  tool.type("1");
  tool.point(world.editor, 0.5, 0.5);
  const FieldInfo& intensity = *world.node("TWO")->type().find("intensity");
  model.drag(world.node("TWO"), intensity, 0.5f);
  model.setActive(false);
  model.edit(removeSelected);
  update();
  EXPECT_NE(model.takeMessage().find("end the other edit"), std::string::npos);
  tool.cancel(world.editor);
  EXPECT_EQ(text(), original);
  model.drag(world.node("TWO"), intensity, 0.5f);
  model.setActive(false);
  update();
  EXPECT_TRUE(has("intensity 0.5"));
}

TEST_F(Sheet, UndoSelectsWhatWasSelectedBefore) {
  select({"A"});
  TransformTool tool(world.editor, TransformTool::Kind::move, front(), 0, 0);
  tool.type("1");
  tool.point(world.editor, 0, 0);
  tool.accept(world.editor);
  EXPECT_EQ(world.editor.selected()->type().name, "Transform");
  world.editor.undo();
  EXPECT_EQ(world.editor.selected(), world.node("A").get());
  world.editor.select({});
  add(world.editor, newNodes().front());
  world.editor.undo();
  EXPECT_EQ(world.editor.selected(), nullptr);
}

// --- Hiding ---

TEST_F(Sheet, HidingIsNoEdit) {
  const auto visible = [&](const char* name) {
    return std::get<bool>(world.browser.get(*world.node(name), "visible"));
  };
  select({"A"});
  model.hideSelected();
  update();
  EXPECT_EQ(model.hiddenCount(), 1u);
  EXPECT_FALSE(visible("A"));
  EXPECT_NE(model.sheet().note.find("hidden"), std::string::npos);
  EXPECT_FALSE(model.hasUnsaved());
  EXPECT_EQ(model.undoName(), "");
  EXPECT_EQ(text(), original);
  select({"WOOD"}); // the Shape of a material is the first one that has it
  model.isolateSelected();
  update();
  EXPECT_TRUE(visible("A"));
  EXPECT_FALSE(visible("B") || visible("C") || visible("D") || visible("G"));
  select({"ONE"});
  model.hideSelected();
  update();
  EXPECT_NE(model.takeMessage().find("cannot be hidden"), std::string::npos);
  model.showAll();
  update();
  for (const char* name : {"A", "B", "C", "D", "G", "T"}) EXPECT_TRUE(visible(name)) << name;
  EXPECT_EQ(model.hiddenCount(), 0u);
}

TEST_F(Sheet, ANodeThatAnEditHidesStaysHidden) {
  select({"A"});
  model.hideSelected();
  model.edit([&](WorldEditor& editor) { editor.editor().set(*world.node("A"), "visible", false); });
  model.showAll();
  update();
  EXPECT_FALSE(std::get<bool>(world.browser.get(*world.node("A"), "visible")));
  EXPECT_EQ(model.hiddenCount(), 0u);
}

// --- The widths of the panels ---

TEST(PanelState, WidthsAreKept) {
  const std::string folder = testing::TempDir() + "panel_state", file = folder + "/vv/panels";
  std::filesystem::remove_all(folder);
  EXPECT_EQ(readPanelWidths(file), PanelWidths{});
  writePanelWidths(file, {210, 333});
  EXPECT_EQ(readPanelWidths(file), (PanelWidths{210, 333}));
  for (const char* hostile : {"outline nan\nsheet inf\n", "outline -5\nsheet 1e30\n", "\x1b[31m",
                              "outline\nsheet x\n", ""}) {
    std::ofstream(file) << hostile << std::string(100'000, 'x');
    EXPECT_EQ(readPanelWidths(file), PanelWidths{}) << hostile;
  }
  std::ofstream(file) << "other 5\nsheet 240\n";
  EXPECT_EQ(readPanelWidths(file), (PanelWidths{0, 240}));
  EXPECT_EQ(readPanelWidths(folder), PanelWidths{}) << "a folder";
  writePanelWidths(folder, {210, 333}); // says nothing
  std::filesystem::remove_all(folder);
}

} // namespace
