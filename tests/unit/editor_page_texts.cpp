// editor_page_texts.cpp: Tests what the editor tells a page: JSON that is bounded and exact,
// whatever a hostile file holds, and steps of edits that a page asks for.
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "as_json/perform_step.h"
#include "editor_support.h"
#include "server/edit_texts.h"
#include "server/limits.h"

namespace {

using namespace editor_test;
using namespace vv::server;
using Json = nlohmann::json;

struct Shown {
  explicit Shown(const std::string& text) : world("#VRML V2.0 utf8\n" + text) { update(); }

  void update() { model.update(world.editor, front(), false, seconds += 1); }
  Json rows(int first = 0, int count = 100) {
    return Json::parse(edit::rowsText(model, numbers, first, count));
  }
  Json sheetOf(const char* name) {
    world.editor.choose(world.node(name), false);
    update();
    text = edit::sheetText(model.sheet(), numbers);
    return Json::parse(text);
  }
  static Json field(const Json& sheet, const std::string& name) {
    for (const Json& one : sheet["fields"])
      if (one["field"] == name) return one;
    return nullptr;
  }

  EditedWorld world;
  vv::EditModel model;
  vv::json::NodeNumbers numbers{size_t(maxNodeNumbers)};
  double seconds = 0;
  std::string text;
};

TEST(EditorPageTexts, RowsAreAWindowOfTheOutline) {
  std::string many;
  for (int i = 0; i < 1000; ++i) many += fmt::format("DEF T{} Transform {{ }}\n", i);
  Shown shown(many + "DEF G Group { children DEF L PointLight { } }");
  const Json window = shown.rows(500, 3);
  EXPECT_EQ(window["total"], 1001);
  EXPECT_EQ(window["first"], 500);
  ASSERT_EQ(window["rows"].size(), 3u);
  EXPECT_EQ(window["rows"][0]["label"], "T500  Transform");
  EXPECT_EQ(shown.numbers.size(), 3u);
  EXPECT_EQ(shown.rows(5000, 10)["rows"].size(), 0u);
  EXPECT_EQ(shown.rows(1000, 10)["rows"][0]["open"], false);
}

TEST(EditorPageTexts, FieldsHaveTheirTypesAndRanges) {
  Shown shown("DEF L PointLight { intensity .5 } DEF S Shape { geometry DEF B Box { } }\n"
              "Shape { appearance Appearance { material DEF M Material { } } }");
  const Json light = shown.sheetOf("L");
  EXPECT_EQ(light["name"], "L");
  const Json intensity = Shown::field(light, "intensity");
  EXPECT_EQ(intensity["type"], "SFFloat");
  EXPECT_EQ(intensity["value"], 0.5);
  EXPECT_EQ(intensity["default"], false);
  EXPECT_EQ(intensity["least"], 0);
  EXPECT_EQ(Shown::field(light, "on")["value"], true);
  EXPECT_EQ(Shown::field(light, "color")["value"], Json::array({1, 1, 1}));
  EXPECT_FALSE(Shown::field(shown.sheetOf("M"), "diffuseColor").contains("linear"));
  const Json links = Shown::field(shown.sheetOf("S"), "geometry")["links"];
  ASSERT_EQ(links.size(), 1u);
  EXPECT_EQ(links[0]["label"], "B  Box");
  EXPECT_EQ(shown.numbers.find(links[0]["node"].get<uint64_t>()), shown.world.node("B"));
}

TEST(EditorPageTexts, HostileFilesStayBounded) {
  const std::string longName(10'000, 'n'), longText(40'000, 't');
  Shown shown(
      fmt::format("DEF {} Group {{ }} DEF T Shape {{ geometry DEF X Text {{ string \"{}\" }} }}"
                  "DEF A<b>x</b>&amp; Group {{ }}",
                  longName, longText));
  const Json rows = shown.rows();
  EXPECT_LT(rows["rows"][0]["label"].get<std::string>().size(), 100u);
  EXPECT_EQ(rows["rows"][2]["label"], "A<b>x</b>&amp;  Group"); // as it is: the page sets text
  const Json text = Shown::field(shown.sheetOf("X"), "string");
  EXPECT_EQ(text["long"], true);
  EXPECT_FALSE(text.contains("value"));
  shown.world.editor.choose(shown.world.node(longName.c_str()), false);
  shown.update();
  const Json sheet = Json::parse(edit::sheetText(shown.model.sheet(), shown.numbers));
  EXPECT_FALSE(sheet.contains("name"));
  EXPECT_LT(sheet["title"].get<std::string>().size(), 100u);
}

TEST(EditorPageTexts, ManyFieldsAreCutOff) {
  std::string fields;
  for (int i = 0; i < 5000; ++i) fields += fmt::format("field SFString f{} \"{}\" ", i, i);
  Shown shown("DEF S Script { " + fields + " }");
  const Json sheet = shown.sheetOf("S");
  EXPECT_LE(shown.text.size(), size_t(maxSheetBytes) + 100);
  EXPECT_GT(sheet["hidden"], 1000);
  EXPECT_GT(sheet["fields"].size(), 100u);
}

// A page forgets its numbers when it has half of them: what it shows then takes less than the rest.
TEST(EditorPageTexts, TheNodesOfASheetHaveNumbersLeft) {
  std::string nodes, fields;
  for (int i = 0; i < 200; ++i) nodes += "Fog { } ";
  for (int i = 0; i < 100; ++i) fields += fmt::format("field MFNode f{} [ {} ] ", i, nodes);
  Shown shown("DEF S Script { " + fields + " }");
  EXPECT_GT(shown.sheetOf("S")["hidden"], 10);
  EXPECT_LT(shown.numbers.size() + size_t(maxRowsShown), size_t(maxNodeNumbers) / 2);
}

// Scales may be so large that no place of the picture can be computed.
TEST(EditorPageTexts, FramesHaveFiniteNumbers) {
  std::string text = "DEF S Shape { geometry Box { } }";
  for (int i = 0; i < 9; ++i)
    text = "Transform { scale 1e38 1e38 1e38 translation 1e38 0 0 children " + text + " }";
  Shown shown(text);
  shown.world.editor.choose(shown.world.node("S"), false);
  shown.update();
  EXPECT_EQ(Json::parse(edit::framesText(shown.model))["lines"].size(), 0u);
}

TEST(EditorPageTexts, RangesOfParametersAreThoseOfTheirClass) {
  vv::PropertySheet sheet;
  Shown shown("DEF L PointLight { }");
  Json light = shown.sheetOf("L");
  EXPECT_FALSE(Shown::field(light, "location").contains("most"));
  sheet = shown.model.sheet();
  for (vv::PropertyRow& row : sheet.rows)
    if (row.field->name == "location") row.range.maximum = 7;
  light = Json::parse(edit::sheetText(sheet, shown.numbers));
  EXPECT_EQ(Shown::field(light, "location")["most"], 7);
}

TEST(EditorPageTexts, AStepOfAPageIsAllOrNothing) {
  Shown shown("DEF L PointLight { intensity .5 }");
  const vv::json::edits::FindNamed find =
      [lamp = shown.world.node("L")](const vv::json::NodeName&) { return lamp; };
  const auto perform = [&](const char* edits) {
    vv::json::Members members("edit", Json::parse(edits));
    const vv::json::edits::Step step = vv::json::edits::readStep(members, 10);
    shown.world.editor.step(step.name,
                            [&] { vv::json::edits::perform(step, shown.world.editor, find); });
  };
  perform(R"({"name":"Both","edits":[{"edit":"rename","node":1,"name":"K"},
               {"edit":"set","node":1,"field":"intensity","value":1}]})");
  EXPECT_EQ(shown.world.editor.editor().undoName(), "Both");
  EXPECT_NE(shown.world.editor.editor().text().find("DEF K PointLight { intensity 1 }"),
            std::string::npos);
  shown.world.editor.undo();
  EXPECT_THROW(perform(R"({"name":"Both","edits":[{"edit":"rename","node":1,"name":"K"},
                            {"edit":"set","node":1,"field":"intensity","value":-1}]})"),
               vv::json::CommandError);
  EXPECT_EQ(shown.world.editor.editor().undoName(), "");
  EXPECT_NE(shown.world.editor.editor().text().find("DEF L PointLight { intensity .5 }"),
            std::string::npos);
}

} // namespace
