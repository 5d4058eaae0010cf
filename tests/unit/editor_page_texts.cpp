// editor_page_texts.cpp: Tests what the editor tells a page: JSON that is bounded and exact,
// whatever a hostile file holds, and edits and tools that a page asks for.
#include <limits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "as_json/perform_step.h"
#include "base64.h"
#include "editor_support.h"
#include "server/edit_nodes.h"
#include "server/edit_texts.h"
#include "server/light_texts.h"
#include "server/limits.h"
#include "server/page_tool.h"
#include "xvrml/nodes.h"

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

  // Does an edit as the server does.
  void perform(const edit::NodeCommand& command) {
    vv::server::perform(command, world.editor, model, numbers, front(), findLook);
    update();
  }
  static const vv::Look& findLook(uint64_t) { throw xvrml::EditError("there is no such look"); }
  // Sets one element of a list, as the server does. Returns why it is refused; "": it is not.
  std::string setElement(const char* name, const char* field, edit::Element element, Json value) {
    const xvrml::NodeRef node = world.node(name);
    try {
      const xvrml::FieldInfo& info = valueField(*node, field);
      const edit::Drag drag{number(name), field, std::move(value), element};
      world.editor.editor().set(*node, field, draggedValue(drag, *node, info, node->get(info)));
      return "";
    } catch (const std::runtime_error& error) { return error.what(); }
  }
  uint64_t number(const char* name) { return numbers.of(world.node(name)); }

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

TEST(EditorPageTexts, NodesOfFieldsHaveTheirPlaces) {
  Shown shown("DEF G Group { children [ DEF A Group { } DEF B Group { } USE A ] }");
  const Json links = Shown::field(shown.sheetOf("G"), "children")["links"];
  ASSERT_EQ(links.size(), 3u);
  EXPECT_EQ(links[0]["places"], 2);
  EXPECT_EQ(links[1]["places"], 1);
  shown.model.setOpen(shown.world.node("G"), true);
  shown.update();
  const Json rows = shown.rows()["rows"];
  EXPECT_FALSE(rows[0].contains("parent"));
  EXPECT_EQ(rows[3]["parent"], rows[0]["node"]);
  EXPECT_EQ(rows[3]["field"], "children");
  EXPECT_EQ(rows[3]["index"], 2);
}

TEST(EditorPageTexts, ALookIsAMaterialOrAShader) {
  Shown shown("DEF S Shape { appearance DEF L Appearance { material Material { } } }\n"
              "Shape { appearance USE L }");
  const Json look = shown.sheetOf("S")["look"];
  EXPECT_EQ(look["name"], "Material");
  EXPECT_EQ(look["places"], 2);
  EXPECT_TRUE(look["surface"].is_number());
  const vv::Look material = shown.model.looks().front(), own{"wood", "", "of a file", "wood.wrl"};
  const Json list =
      Json::parse(edit::looksText({{7, &own, "images/1.png"}, {2, &material, ""}}))["list"];
  EXPECT_EQ(list[0]["number"], 7);
  EXPECT_EQ(list[0]["own"], true);
  EXPECT_EQ(list[0]["image"], "images/1.png");
  EXPECT_EQ(list[1]["name"], "Material");
  EXPECT_EQ(list[1]["shader"], false);
  EXPECT_FALSE(list[1].contains("image"));
  EXPECT_FALSE(shown.sheetOf("L").contains("look"));
}

TEST(EditorPageTexts, ChoicesAreWhatAFieldMayHold) {
  Shown shown("DEF S Shape { geometry DEF B Box { } } DEF LAMP PointLight { }");
  shown.sheetOf("S");
  const Json choices =
      Json::parse(edit::choicesText(7, *shown.model.sheet().find("geometry"), shown.numbers));
  EXPECT_EQ(choices["node"], 7);
  EXPECT_EQ(choices["field"], "geometry");
  const auto has = [](const Json& list, const char* member, const char* text) {
    return std::any_of(list.begin(), list.end(),
                       [&](const Json& one) { return one[member] == text; });
  };
  EXPECT_TRUE(has(choices["types"], "name", "Sphere"));
  EXPECT_FALSE(has(choices["types"], "name", "PointLight"));
  EXPECT_TRUE(has(choices["uses"], "label", "B  Box"));
  EXPECT_FALSE(has(choices["uses"], "label", "LAMP  PointLight"));
}

TEST(EditorPageTexts, ProblemsAreABoundedList) {
  std::string many;
  for (int i = 0; i < 400; ++i)
    many += fmt::format("Shape {{ geometry Box {{ size -{} 1 1 }} }}\n", i + 1);
  Shown shown(many);
  Json problems = Json::parse(edit::problemsText(shown.model.problems(), shown.numbers));
  EXPECT_EQ(problems["count"], 400);
  EXPECT_EQ(problems["open"], false);
  EXPECT_EQ(problems["rows"].size(), 0u);
  shown.model.problems().setOpen(true);
  shown.update();
  problems = Json::parse(edit::problemsText(shown.model.problems(), shown.numbers));
  ASSERT_EQ(problems["rows"].size(), size_t(maxProblemsShown));
  EXPECT_GE(problems["dropped"], 200);
  EXPECT_NE(problems["rows"][0]["text"].get<std::string>().find("line 2"), std::string::npos);
}

TEST(EditorPageTexts, AnElementOfAListIsSetAddedAndRemoved) {
  Shown shown("Shape { geometry PointSet { coord DEF C Coordinate { point [ 0 0 0, 1 0 0 ] } } }\n"
              "DEF L PointLight { }");
  const auto points = [&] {
    return xvrml::nodeCast<xvrml::nodes::Coordinate>(shown.world.node("C"))->point;
  };
  EXPECT_EQ(shown.setElement("C", "point", {1, 2}, {2, 3, 4}), "");
  EXPECT_EQ(points(), (xvrml::MFVec3f{{0, 0, 0}, {2, 3, 4}}));
  EXPECT_EQ(shown.setElement("C", "point", {2, 2}, {5, 6, 7}), "");
  EXPECT_EQ(points(), (xvrml::MFVec3f{{0, 0, 0}, {2, 3, 4}, {5, 6, 7}}));
  EXPECT_EQ(shown.setElement("C", "point", {0, 3}, nullptr), "");
  EXPECT_EQ(points(), (xvrml::MFVec3f{{2, 3, 4}, {5, 6, 7}}));
  // The page was sent another list.
  EXPECT_NE(shown.setElement("C", "point", {0, 3}, {9, 9, 9}).find("2 elements now"),
            std::string::npos);
  for (const auto& [element, value] :
       std::vector<std::pair<edit::Element, Json>>{{{3, 2}, {1, 1, 1}},
                                                   {{2, 2}, nullptr},
                                                   {{0, 2}, {1, 1}},
                                                   {{0, 2}, {{1, 1, 1}, {2, 2, 2}}}})
    EXPECT_NE(shown.setElement("C", "point", element, value), "") << value;
  EXPECT_NE(shown.setElement("L", "intensity", {0, 1}, 1), "");
  EXPECT_EQ(points(), (xvrml::MFVec3f{{2, 3, 4}, {5, 6, 7}}));
}

TEST(EditorPageTexts, NodesAreAddedUsedMovedAndRemoved) {
  Shown shown("DEF G Group { children [ DEF A Group { } DEF B Group { } ] }");
  const uint64_t group = shown.number("G"), a = shown.number("A");
  shown.perform(edit::AddNode{group, "children", "PointLight"});
  shown.perform(edit::UseNode{group, "children", a});
  const auto children = [&] {
    std::string text;
    for (const xvrml::NodeRef& node :
         xvrml::nodeCast<xvrml::nodes::Group>(shown.world.node("G"))->children)
      text += node->defName.empty() ? "-" : node->defName;
    return text;
  };
  EXPECT_EQ(children(), "AB-A");
  shown.perform(edit::MoveAt{{a, group, "children", 0}, 1});
  EXPECT_EQ(children(), "BA-A");
  shown.perform(edit::RemoveAt{{a, group, "children", 3}});
  EXPECT_EQ(children(), "BA-");
  for (int i = 0; i < 4; ++i) shown.world.editor.undo();
  EXPECT_EQ(children(), "AB");
}

TEST(EditorPageTexts, HostilePlacesAreRefused) {
  Shown shown("DEF G Group { children [ DEF A Group { } ] } DEF L PointLight { }");
  const uint64_t group = shown.number("G"), a = shown.number("A"), lamp = shown.number("L");
  const std::string before = shown.world.editor.editor().text();
  const auto refuses = [&](const edit::NodeCommand& command) {
    EXPECT_THROW(shown.perform(command), std::runtime_error);
  };
  refuses(edit::RemoveAt{{a, group, "children", 1}});
  refuses(edit::RemoveAt{{a, group, "nothing", 0}});
  refuses(edit::RemoveAt{{a, group, "bboxSize", 0}});
  refuses(edit::RemoveAt{{a, group, "addChildren", 0}});
  refuses(edit::RemoveAt{{a, lamp, "", 0}});
  refuses(edit::RemoveAt{{a, {}, "children", 0}});
  refuses(edit::RemoveAt{{a, 999, "children", 0}});
  refuses(edit::MoveAt{{lamp, {}, "", 7}, 1});
  refuses(edit::SeparateAt{{a, group, "children", 0}});
  refuses(edit::AddNode{group, "children", "Script { }"});
  refuses(edit::AddNode{group, "nothing", "Group"});
  refuses(edit::AddNode{group, "bboxSize", "Group"});
  refuses(edit::UseNode{a, "children", group}); // a node within itself
  refuses(edit::SetLook{1000, true});
  EXPECT_EQ(shown.world.editor.editor().text(), before);
  EXPECT_FALSE(shown.world.editor.isChanged());
}

TEST(EditorPageTexts, AToolMovesAndIsTakenBack) {
  Shown shown("DEF T Transform { children Shape { geometry Box { } } }");
  PageTool tool;
  const auto place = [&] { tool.place(shown.world.editor, front(), true); };
  const auto moved = [&] {
    return xvrml::nodeCast<xvrml::nodes::Transform>(shown.world.node("T"))->translation.x;
  };
  shown.world.editor.select({shown.world.node("T")});
  place();
  const Json handles = Json::parse(edit::handlesText(tool.gizmo()));
  EXPECT_EQ(handles["kind"], "move");
  EXPECT_EQ(handles["list"].size(), 2u) << "z points at the viewer";
  tool.take(edit::BeginTool{edit::BeginTool::Kind::move, 0, {0.1, 0}}, shown.world.editor, front());
  tool.take(edit::PointTool{{0.4, 0}, false}, shown.world.editor, front());
  EXPECT_GT(moved(), 0.5f);
  EXPECT_NE(tool.text().find("along x"), std::string::npos);
  tool.take(edit::TypeTool{"2"}, shown.world.editor, front());
  EXPECT_EQ(moved(), 2);
  tool.take(edit::EndTool{false}, shown.world.editor, front());
  EXPECT_EQ(moved(), 0);
  EXPECT_EQ(tool.text(), "");
  // The rest of the commands of a tool that has been ended changes nothing.
  tool.take(edit::PointTool{{0.9, 0}, false}, shown.world.editor, front());
  tool.take(edit::EndTool{true}, shown.world.editor, front());
  EXPECT_EQ(shown.world.editor.editor().undoName(), "");
  tool.take(edit::BeginTool{edit::BeginTool::Kind::scale, -1, {0.1, 0}}, shown.world.editor,
            front());
  tool.take(edit::TypeTool{"3"}, shown.world.editor, front());
  tool.accept(shown.world.editor);
  EXPECT_EQ(shown.world.editor.editor().undoName(), "Scale Transform");
  tool.place(shown.world.editor, front(), false);
  EXPECT_TRUE(tool.gizmo().handles().empty());
}

TEST(EditorPageTexts, ProbesHaveUnitsAndMarks) {
  vv::Probes probes;
  probes.add({0, 0, 0});
  const double point[] = {0, 0, 5}, normal[] = {0, 0, 1}, seen[] = {0, 0, -1};
  probes.addSensor(picture::sensorAt(point, normal, seen));
  std::vector<picture::Measurement> readings(1);
  readings[0].sensor = probes.waitingSensors().front();
  readings[0].value = {120};
  readings[0].halfWidth = {std::numeric_limits<float>::infinity()};
  readings[0].trusted = {1};
  readings[0].samples = {64};
  probes.take(readings);
  probes.add({-0.5, -0.5, 0.5, 0.5}, front());
  const Json list = Json::parse(edit::probesText(probes))["list"];
  EXPECT_EQ(list[0]["state"], "waiting");
  EXPECT_EQ(list[1]["illuminance"], 120);
  EXPECT_TRUE(list[1]["half_width"].is_null());
  EXPECT_FALSE(list[1].contains("luminance"));
  const Json marks = Json::parse(edit::marksText(probes, front()))["list"];
  ASSERT_EQ(marks.size(), 3u);
  EXPECT_EQ(marks[0]["x"], 0);
  EXPECT_EQ(marks[2]["left"], -0.5);
  EXPECT_EQ(Json::parse(edit::marksText(probes, front(2)))["list"].size(), 2u) << "another view";
  // Another sensor may have the number of one that has been removed meanwhile.
  probes.clear();
  const double other[] = {1, 0, 5};
  probes.add({0, 0, 0});
  probes.addSensor(picture::sensorAt(other, normal, seen));
  probes.take(readings);
  EXPECT_EQ(Json::parse(edit::probesText(probes))["list"][1]["state"], "waiting");
}

TEST(EditorPageTexts, TexturesHaveSmallPictures) {
  Shown shown("Shape { appearance DEF A Appearance { texture DEF T PixelTexture {\n"
              "image 2 1 3 0xff0000 0x00ff00 } } }\n");
  shown.sheetOf("A");
  const auto list = [&] {
    return Json::parse(edit::thumbnailsText(shown.model.thumbnails(), shown.numbers))["list"];
  };
  ASSERT_EQ(list().size(), 1u);
  EXPECT_EQ(list()[0]["node"], shown.number("T"));
  EXPECT_EQ(list()[0]["scale"], 32);
  std::string png;
  ASSERT_TRUE(appendBytesOfBase64(list()[0]["image"].get<std::string>(), png));
  EXPECT_TRUE(png.starts_with("\x89PNG"));
  shown.sheetOf("T");
  EXPECT_EQ(list()[0]["node"], shown.number("T")) << "its own sheet shows it, too";
}

TEST(EditorPageTexts, APointerHasWhatIsSeenAndItsLight) {
  EXPECT_EQ(edit::pointerText(nullptr, true), R"({"type":"pointer"})");
  vv::PointerReading pointer{0.5, -0.25, {}, {}};
  EXPECT_EQ(edit::pointerText(&pointer, true), R"({"type":"pointer"})") << "not looked for yet";
  pointer.seen = "Shape";
  const Json waiting = Json::parse(edit::pointerText(&pointer, false));
  EXPECT_EQ(waiting["seen"], "Shape");
  EXPECT_EQ(waiting["x"], 0.5);
  EXPECT_EQ(waiting["y"], -0.25);
  EXPECT_EQ(waiting["readable"], false);
  EXPECT_FALSE(waiting.contains("luminance"));
  picture::PixelReading light;
  light.luminance = light.radiance[1] = 7;
  light.luminanceHalfWidth = std::numeric_limits<float>::infinity();
  light.samples = 3;
  pointer.light = light;
  const Json read = Json::parse(edit::pointerText(&pointer, true));
  EXPECT_EQ(read["luminance"], 7);
  EXPECT_TRUE(read["half_width"].is_null());
  EXPECT_EQ(read["radiance"], Json({0, 7, 0}));
  EXPECT_EQ(read["radiance_half_width"], Json({0, 0, 0}));
  EXPECT_EQ(read["samples"], 3);
  EXPECT_EQ(read["trusted"], false);
}

TEST(EditorPageTexts, AComparisonIsOfTheLeadersPicture) {
  vv::Comparison comparison;
  const Json none = Json::parse(edit::comparisonText(comparison, true, {}));
  EXPECT_EQ(none["kept"], false);
  EXPECT_EQ(none["shown"], "present");
  const Json cover = Json::parse(edit::coverText(2, 3, "jpeg"));
  EXPECT_EQ(cover["image"], "anBlZw==");
  EXPECT_EQ(cover["height"], 3);
  const std::string paths[] = {"saved/1/a.html"}, names[] = {"a.html"};
  EXPECT_EQ(Json::parse(edit::reportText(paths, names))["files"][0]["path"], paths[0]);
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
