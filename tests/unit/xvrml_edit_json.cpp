// xvrml_edit_json.cpp: Tests edits of a world's file in JSON: what becomes of its text, undo, and
// what is refused.
#include "edit/gzip.h"
#include "edit/json_commas.h"
#include "unit/xvrml_edit_support.h"

namespace {

using namespace edit_test;

class EditedJson : public Edited {
 protected:
  // body: the elements of the list of the Scene's nodes.
  void loadScene(const std::string& body) {
    load("    \"@profile\": \"Immersive\",\n    \"@version\": \"3.3\",\n    \"Scene\": {\n"
         "      \"-children\": [\n" +
             body + "      ]\n    }\n  }\n}\n",
         "{ \"X3D\": {\n", "w.x3dj");
  }
  // Returns the elements of the list of the Scene's nodes.
  std::string scene() {
    const std::string all = editor->text();
    const std::string head = "\"-children\": [\n";
    const size_t begin = all.find(head) + head.size();
    return all.substr(begin, all.rfind("      ]\n    }\n  }\n}\n") - begin);
  }
};
INSTANTIATE_TEST_SUITE_P(World, EditedJson, testing::Bool(),
                         [](const auto& info) { return info.param ? "Running" : "Resting"; });

TEST_P(EditedJson, AValueChangesInItsPlace) {
  loadScene("        {\"#comment\": \"a lamp\"},\n        {\"PointLight\": {\"@DEF\": \"L\", "
            "\"@intensity\":0.50, \"@location\": [0,1 ,0], \"#comment\": \"half\"}}\n");
  editor->set(node("L"), "intensity", 0.75f);
  editor->set(node("L"), "location", Vec3f{0, 1, 2});
  editor->set(node("L"), "on", false);
  EXPECT_EQ(scene(), "        {\"#comment\": \"a lamp\"},\n        {\"PointLight\": {\"@DEF\": "
                     "\"L\", \"@intensity\":0.75, \"@location\": [0,1 ,2], \"#comment\": "
                     "\"half\", \"@on\": false}}\n");
  EXPECT_EQ((field<SFFloat>(node("L"), "intensity")), 0.75f);
  undoAll();
}

TEST_P(EditedJson, TextIsEscaped) {
  loadScene("        {\"Shape\": {\"-geometry\": {\"Text\": {\"@DEF\": \"T\", "
            "\"@string\": [\"a\", \"\\u0062\"]}}}},\n"
            "        {\"WorldInfo\": {\"@DEF\": \"W\", \"@title\": \"a \\\"b\\\"\"}}\n");
  editor->set(node("T"), "string", MFString{"a", "b", "say \"c\"\\\n\x01"});
  editor->set(node("W"), "title", std::string("'a'\t"));
  EXPECT_EQ(scene(), "        {\"Shape\": {\"-geometry\": {\"Text\": {\"@DEF\": \"T\", "
                     "\"@string\": [\"a\", \"\\u0062\", \"say \\\"c\\\"\\\\\\n\\u0001\"]}}}},\n"
                     "        {\"WorldInfo\": {\"@DEF\": \"W\", \"@title\": \"'a'\\u0009\"}}\n");
  undoAll();
}

TEST_P(EditedJson, ElementsOfListsChangeInTheirPlaces) {
  loadScene("        {\"Shape\": {\"-geometry\": {\"IndexedFaceSet\": {\n"
            "            \"@coordIndex\": [0,1,2,-1],\n            \"-coord\": {\"Coordinate\": "
            "{\"@DEF\": \"C\", \"@point\": [\n              0,0,0.0,\n              1,0,0,\n"
            "              1,1,0\n            ]}}\n        }}}},\n"
            "        {\"Transform\": {\"@DEF\": \"X\", \"@translation\": \"1 2.0 3\"}},\n"
            "        {\"Shape\": {\"-appearance\": {\"Appearance\": {\"-texture\": "
            "{\"PixelTexture\": {\"@DEF\": \"P\", \"@image\": [1,1,1,255]}}}}}}\n");
  editor->set(node("C"), "point", MFVec3f{{0, 0, 0}, {1, .5f, 0}, {2, 2, 2}, {1, 1, 0}});
  editor->set(node("X"), "translation", Vec3f{1, 2, 4});
  editor->set(node("P"), "image", Image{2, 1, 1, {255, 7}});
  const std::string now = scene();
  EXPECT_NE(
      now.find("0,0,0.0,\n              1,0.5,0,\n              2,2,2,\n              1,1,0\n"),
      std::string::npos)
      << now;
  EXPECT_NE(now.find("\"@translation\": \"1 2.0 4\""), std::string::npos) << now;
  EXPECT_NE(now.find("\"@image\": [2, 1, 1, 255, 7]"), std::string::npos) << now;
  undoAll();
  editor->set(node("C"), "point", MFVec3f{});
  EXPECT_NE(scene().find("\"@point\": []"), std::string::npos) << scene();
  undoAll();
}

TEST_P(EditedJson, AbsentFieldsAreAdded) {
  loadScene("        {\"PointLight\": {\"@DEF\": \"L\"}},\n        { \"PointLight\":\n          {\n"
            "            \"@DEF\": \"M\",\n            \"@intensity\": 0\n          }\n"
            "        },\n        {\"Group\": {}},\n        {\"Group\": {\"-children\": []}}\n");
  editor->set(node("L"), "location", Vec3f{1, 2, .5f});
  editor->set(node("M"), "radius", 5.f);
  const auto group = [&](size_t i) -> Node& { return *world().scope.roots[i]; };
  editor->insert({&group(2), "children", 0}, "{\"Shape\": {\"-geometry\": {\"Box\": {}}}}");
  editor->insert({&group(3), "children", 0}, "{\"Shape\": {}}");
  editor->insert({&group(3), "children", 1}, "{\"Group\": {}}");
  EXPECT_EQ(scene(), "        {\"PointLight\": {\"@DEF\": \"L\", \"@location\": [1, 2, 0.5]}},\n"
                     "        { \"PointLight\":\n          {\n            \"@DEF\": \"M\",\n"
                     "            \"@intensity\": 0,\n            \"@radius\": 5\n          }\n"
                     "        },\n        {\"Group\": {\"-children\": [\n          {\"Shape\": "
                     "{\"-geometry\": {\"Box\": {}}}}\n        ]}},\n        {\"Group\": "
                     "{\"-children\": [\n          {\"Shape\": {}},\n          {\"Group\": {}}\n"
                     "        ]}}\n");
  undoAll();
}

TEST_P(EditedJson, NodesAreInsertedRemovedAndMoved) {
  loadScene("        {\"Group\": {\n          \"@DEF\": \"G\",\n          \"-children\": [\n"
            "            {\"Shape\": {\"@DEF\": \"A\"}},\n            {\"#comment\": \"of B\"},\n"
            "            {\"Shape\": {\"@DEF\": \"B\"}}\n          ]\n        }},\n"
            "        {\"Group\": {\"@DEF\": \"H\", \"-children\": [{\"Group\": {}}]}}\n");
  editor->insert({&node("G"), "children", 1}, "{\"Shape\": {\"@DEF\": \"C\"}}");
  EXPECT_NE(scene().find("            {\"Shape\": {\"@DEF\": \"A\"}},\n            {\"Shape\": "
                         "{\"@DEF\": \"C\"}},\n            {\"#comment\": \"of B\"},\n"),
            std::string::npos)
      << scene();
  editor->remove({&node("G"), "children", 2});
  EXPECT_NE(scene().find("{\"#comment\": \"of B\"},\n            {\"Shape\": {\"@DEF\": \"C\"}}\n"
                         "          ]"),
            std::string::npos)
      << scene();
  editor->move({&node("G"), "children", 0}, {&node("H"), "children", 1});
  EXPECT_NE(scene().find("{\"@DEF\": \"H\", \"-children\": [{\"Group\": {}}, {\"Shape\": "
                         "{\"@DEF\": \"A\"}}]}}\n"),
            std::string::npos)
      << scene();
  editor->remove({nullptr, "", 0});
  editor->remove({nullptr, "", 0});
  EXPECT_EQ(scene(), "");
  editor->insert({nullptr, "", 0}, "{\"Group\": {}}");
  undoAll();
}

TEST_P(EditedJson, UsesNamesAndRoutes) {
  loadScene("        {\"TimeSensor\": {\"@DEF\": \"T\"}},\n"
            "        {\"ScalarInterpolator\": {\"@DEF\": \"I\"}},\n"
            "        {\"Group\": {\"@DEF\": \"H\", \"-children\": [{\"TimeSensor\": {\"@USE\": "
            "\"T\"}}]}},\n        {\"ROUTE\": {\"@fromNode\": \"T\", \"@fromField\": "
            "\"fraction_changed\", \"@toNode\": \"I\", \"@toField\": \"set_fraction\"}},\n"
            "        {\"PointLight\": {\"@on\": true}}\n");
  editor->rename(node("T"), "Clock");
  Node& light = *world().scope.roots[3];
  editor->use({&node("H"), "children", 1}, light);
  editor->addRoute(node("I"), "value_changed", light, "set_intensity");
  EXPECT_EQ(scene(), "        {\"TimeSensor\": {\"@DEF\": \"Clock\"}},\n"
                     "        {\"ScalarInterpolator\": {\"@DEF\": \"I\"}},\n"
                     "        {\"Group\": {\"@DEF\": \"H\", \"-children\": [{\"TimeSensor\": "
                     "{\"@USE\": \"Clock\"}}, {\"PointLight\": {\"@DEF\": \"PointLight\", "
                     "\"@on\": true}}]}},\n        {\"ROUTE\": {\"@fromNode\": \"Clock\", "
                     "\"@fromField\": \"fraction_changed\", \"@toNode\": \"I\", \"@toField\": "
                     "\"set_fraction\"}},\n        {\"PointLight\": {\"@USE\": \"PointLight\"}},\n"
                     "        {\"ROUTE\": {\"@fromNode\": \"I\", \"@fromField\": "
                     "\"value_changed\", \"@toNode\": \"PointLight\", \"@toField\": "
                     "\"set_intensity\"}}\n");
  editor->remove({nullptr, "", 0}); // the USE becomes the node
  EXPECT_NE(scene().find("[{\"TimeSensor\": {\"@DEF\": \"Clock\"}}, "), std::string::npos);
  undoAll();
}

TEST_P(EditedJson, ANodeIsWrappedAndCopied) {
  loadScene("        {\"Shape\": {\n          \"@DEF\": \"S\",\n          \"-geometry\": {\n"
            "            \"Box\": {\"@DEF\": \"B\"}\n          }\n        }}\n");
  editor->wrap({nullptr, "", 0});
  EXPECT_EQ(scene(), "        {\"Transform\": {\n            \"-children\": [\n"
                     "              {\"Shape\": {\n                \"@DEF\": \"S\",\n"
                     "                \"-geometry\": {\n                  \"Box\": {\"@DEF\": "
                     "\"B\"}\n                }\n              }}\n            ]\n          }\n"
                     "        }\n");
  undoAll();
  editor->undo();
  editor->set(node("B"), "size", Vec3f{1, 2, 3});
  const NodeRef copy = editor->duplicate({nullptr, "", 0});
  EXPECT_EQ(copy->defName, "S_2");
  EXPECT_NE(scene().find("        }},\n        {\"Shape\": {\n          \"@DEF\": \"S_2\",\n"
                         "          \"-geometry\": {\n            \"Box\": {\"@DEF\": \"B_2\", "
                         "\"@size\": [1, 2, 3]}\n"),
            std::string::npos)
      << scene();
  undoAll();
}

TEST_P(EditedJson, FieldsOfInstancesAndScripts) {
  loadScene(
      "        {\"ProtoDeclare\": {\"@name\": \"Lamp\", \"ProtoInterface\": {\"field\": [\n"
      "          {\"@accessType\": \"initializeOnly\", \"@type\": \"SFFloat\", \"@name\": "
      "\"bright\", \"@value\": 1},\n          {\"@accessType\": \"inputOutput\", \"@type\": "
      "\"MFNode\", \"@name\": \"kids\"}\n        ]}, \"ProtoBody\": {\"-children\": [{\"Group\": "
      "{\"IS\": {\"connect\": [{\"@nodeField\": \"children\", \"@protoField\": \"kids\"}]}}}]}}},\n"
      "        {\"ProtoInstance\": {\"@name\": \"Lamp\", \"@DEF\": \"P\"}},\n"
      "        {\"ProtoInstance\": {\"@name\": \"Lamp\", \"@DEF\": \"Q\", \"fieldValue\": [\n"
      "          {\"@name\": \"bright\", \"@value\": 0.50},\n          {\"@name\": \"kids\", "
      "\"-children\": [{\"Group\": {}}]}\n        ]}},\n"
      "        {\"ProtoInstance\": {\"@name\": \"Lamp\", \"@DEF\": \"R\", \"fieldValue\": "
      "{\"@name\": \"bright\", \"@value\": 2}}},\n"
      "        {\"Script\": {\"@DEF\": \"S\", \"field\": [\n          {\"@accessType\": "
      "\"initializeOnly\", \"@type\": \"SFFloat\", \"@name\": \"x\", \"@value\": 1.0},\n"
      "          {\"@accessType\": \"initializeOnly\", \"@type\": \"SFVec2f\", \"@name\": "
      "\"y\"},\n          {\"@accessType\": \"initializeOnly\", \"@type\": \"SFNode\", \"@name\": "
      "\"n\", \"-children\": [{\"Group\": {\"@DEF\": \"K\"}}]}\n        ], \"#sourceCode\": "
      "[\"ecmascript:\", \"function f() {}\"]}}\n");
  editor->set(node("P"), "bright", .25f);
  editor->insert({&node("P"), "kids", 0}, "{\"Shape\": {}}");
  editor->set(node("Q"), "bright", .75f);
  editor->insert({&node("Q"), "kids", 1}, "{\"Shape\": {\"@DEF\": \"N\"}}");
  editor->insert({&node("R"), "kids", 0}, "{\"Shape\": {}}");
  editor->set(node("S"), "x", 2.f);
  editor->set(node("S"), "y", Vec2f{3, 4});
  editor->remove({&node("S"), "n", 0});
  const std::string now = scene();
  for (const char* part :
       {"\"@DEF\": \"P\", \"fieldValue\": [\n          {\"@name\": \"bright\", \"@value\": 0.25},\n"
        "          {\"@name\": \"kids\", \"-children\": [\n            {\"Shape\": {}}\n"
        "          ]}\n        ]}}",
        "\"@value\": 0.75},\n          {\"@name\": \"kids\", \"-children\": [{\"Group\": {}}, "
        "{\"Shape\": {\"@DEF\": \"N\"}}]}",
        "\"fieldValue\": [{\"@name\": \"bright\", \"@value\": 2}, {\"@name\": \"kids\", "
        "\"-children\": [\n",
        "\"x\", \"@value\": 2},", "\"y\", \"@value\": [3, 4]},", "\"n\", \"-children\": []}",
        "\"#sourceCode\": [\"ecmascript:\", \"function f() {}\"]"})
    EXPECT_NE(now.find(part), std::string::npos) << part << "\nin\n" << now;
  undoAll();
  EXPECT_NE(refusal([&] { editor->set(node("S"), "url", MFString{"a.js"}); }), "done");
}

TEST_P(EditedJson, WhatIsRefusedIsSaid) {
  loadScene("        {\"Group\": {\"@DEF\": \"G\"}}\n");
  const auto insert = [&](const std::string& text) {
    return refusal([&] { editor->insert({&node("G"), "children", 0}, text); });
  };
  EXPECT_NE(insert("{\"Group\": {}, \"Shape\": {}}"), "done");
  EXPECT_NE(insert("{\"Grupp\": {}}"), "done");
  EXPECT_NE(insert("Group { }"), "done");
  EXPECT_NE(insert("{\"Group\": {}"), "done");
  EXPECT_NE(insert("[{\"Group\": {}}]"), "done");
  EXPECT_EQ(insert("{\"Box\": {}}"), "Box cannot be in field children of Group: expected child");
  EXPECT_EQ(insert("{\"Group\": {}}"), "done");
}

TEST(JsonEditor, EmptyScenesAreFilled) {
  const Folder folder;
  for (const auto& [text, filled] :
       {std::pair<std::string, std::string>{
            R"({"X3D": {"@version": "3.3", "Scene": {}}})",
            "{\"X3D\": {\"@version\": \"3.3\", \"Scene\": {\"-children\": [\n  {\"Group\": "
            "{\"@DEF\": \"A\"}}\n]}}}"},
        {"{\"X3D\": {\n  \"Scene\": {\n    \"-children\": [\n    ]\n  },\n  \"@version\": "
         "\"3.3\"\n}}\n",
         "{\"X3D\": {\n  \"Scene\": {\n    \"-children\": [\n      {\"Group\": {\"@DEF\": "
         "\"A\"}}\n    ]\n  },\n  \"@version\": \"3.3\"\n}}\n"}}) {
    const auto world = loadWorld(folder.write("w.x3dj", text));
    Editor editor(*world);
    editor.insert({nullptr, "", 0}, "{\"Group\": {\"@DEF\": \"A\"}}");
    EXPECT_EQ(editor.text(), filled);
    EXPECT_TRUE(editor.undo());
    EXPECT_EQ(editor.text(), text);
  }
}

TEST(JsonEditor, MarkedAndPackedFiles) {
  const Folder folder;
  const std::string text =
      R"({"X3D": {"@version": "3.3", "Scene": {"-children": [{"PointLight": {"@DEF": "L"}}]}}})";
  const auto world = loadWorld(folder.write("w.x3djz", packed("\xef\xbb\xbf" + text)));
  Editor editor(*world);
  EXPECT_EQ(editor.whyReadOnly(), "");
  editor.set(*world->scope.names.at("L"), "on", false);
  const std::string bytes = editor.bytes();
  EXPECT_EQ(bytes.substr(0, 2), "\x1f\x8b");
  const auto read = loadWorldFromMemory(bytes, "w.x3djz");
  EXPECT_FALSE(field<SFBool>(*read->scope.names.at("L"), "on"));
}

TEST(JsonEditor, FilesThatCannotBeEditedAreSaid) {
  const Folder folder;
  const auto why = [&](const std::string& text) {
    const auto world = loadWorld(folder.write("a.x3dj", text));
    const std::string reason = Editor(*world).whyReadOnly();
    return reason.substr(std::min(reason.find(' '), reason.size()));
  };
  EXPECT_EQ(why(R"({"X3D": {"Scene": {"-children": [}}})"),
            " is not well-formed JSON: mend it first");
  EXPECT_EQ(why(R"({"X3D": {}})"), " has no Scene");
  EXPECT_EQ(why(R"({"X3D": {"Scene": {"Group": {}}}})"),
            " has nodes, routes or prototypes that have no object of their own in a list");
  EXPECT_EQ(why(R"({"X3D": {"Scene": {"-children": [{"Group": {}, "Shape": {}}]}}})"),
            " has nodes, routes or prototypes that have no object of their own in a list");
  EXPECT_EQ(why(R"({"X3D": {"Scene": {"-children": {"Group": {}}}}})"),
            " has a Scene whose \"-children\" are no list");
  EXPECT_EQ(why(R"({"X3D": {"Scene": {}}})"), "");
}

TEST_P(EditedJson, WhatCouldNotBeReadStaysAsItIs) {
  for (const char* body :
       {R"({"Foo": {}}, {"Group": {"-children": [{"Foo": {"-children": []}}]}})",
        R"({"Box": {"@DEF": "B"}}, {"Shape": {"-geometry": {"Box": {"@USE": "B"}}}})",
        R"({"Group": {"-children": [{"Box": {}}, {"Shape": {}}]}})",
        R"({"Shape": {"-geometry": [{"Box": {}}, {"Sphere": {}}]}})",
        R"({"Shape": {"-geometry": {"Box": {"@size": [1, "x", 2], "@foo": 1}}}})",
        R"({"Group": {"-nothing": [{"Group": {}}]}})",
        R"({"Group": {"@DEF": "a b", "x": 1, "y": [1, {"z": null}]}})",
        R"({"Group": {"-children": [{"Group": {"@USE": "none"}}]}})",
        R"({"Switch": {"@whichChoice": null, "-children": [null, 5, [], {"Group": {}}]}})",
        R"({"Shape": {"-geometry": {"Box": {"@size": "1 2 3"}}}})",
        R"({"ROUTE": {}}, {"ProtoDeclare": {}}, {"ProtoInstance": {"@name": "none"}})"}) {
    const std::string text = "{\"X3D\": {\"@version\": \"3.3\", \"Scene\": {\"-children\": [\n"
                             "{\"PointLight\": {\"@DEF\": \"L\"}},\n" +
                             std::string(body) + "\n]}}}\n";
    const auto loaded = loadWorld(folder.write("f.x3dj", text));
    Editor faulty(*loaded);
    ASSERT_EQ(faulty.whyReadOnly(), "") << body;
    EXPECT_EQ(faulty.text(), text);
    faulty.remove({nullptr, "", 0});
    EXPECT_EQ(faulty.text(), "{\"X3D\": {\"@version\": \"3.3\", \"Scene\": {\"-children\": [\n" +
                                 std::string(body) + "\n]}}}\n");
    EXPECT_TRUE(faulty.undo());
    EXPECT_EQ(faulty.text(), text);
  }
}

// Random edits, all undone, give the file back; all done again, the edited one.
TEST_P(EditedJson, RandomEditsCanBeUndone) {
  loadScene("        {\"Group\": {\"@DEF\": \"C2\"}},\n        {\"#comment\": \"one\"},\n"
            "        {\"Transform\": {\n          \"@DEF\": \"A\",\n          \"@translation\": "
            "[1,2,3],\n          \"-children\": [\n            {\"Shape\": {\"@DEF\": \"B\", "
            "\"-geometry\": {\"Box\": {\"@DEF\": \"C\", \"@size\": [1, 1, 1]}}}},\n"
            "            {\"Shape\": {\"@USE\": \"B\"}}, {\"#comment\": \"two\"},\n"
            "            {\"Group\": {\"-children\": [{\"Transform\": {\"@DEF\": \"D\"}}]}},\n"
            "            {\"ROUTE\": {\"@fromNode\": \"A\", \"@fromField\": \"translation\", "
            "\"@toNode\": \"A\", \"@toField\": \"scale\"}}\n          ]\n        }},\n"
            "        {\"Group\": {\"@DEF\": \"E\", \"-children\": [{\"Group\": {\"@USE\": "
            "\"C2\"}}]}},\n        {\"TimeSensor\": {\"@DEF\": \"T\"}},\n"
            "        {\"ProtoDeclare\": {\"@name\": \"P\", \"ProtoInterface\": {\"field\": [{"
            "\"@accessType\": \"inputOutput\", \"@type\": \"MFNode\", \"@name\": \"kids\"}]}, "
            "\"ProtoBody\": {\"-children\": [{\"Group\": {\"IS\": {\"connect\": [{\"@nodeField\": "
            "\"children\", \"@protoField\": \"kids\"}]}}}]}}},\n"
            "        {\"ProtoInstance\": {\"@name\": \"P\", \"@DEF\": \"I\", \"fieldValue\": [{"
            "\"@name\": \"kids\", \"-children\": [{\"Group\": {}}]}]}},\n"
            "        {\"ProtoInstance\": {\"@name\": \"P\"}}\n");
  for (unsigned seed = 1; seed <= 20; ++seed)
    editAtRandom(seed, "{\"Group\": {}}",
                 "{\"Transform\": {\n  \"@DEF\": \"N\",\n  \"-children\": [{\"Group\": {}}]\n}}");
}

TEST(JsonCommas, AreMended) {
  for (const auto& [text, mended] :
       {std::pair<std::string, std::string>{"[1 2, 3,, 4 ,]", "[1, 2, 3, 4 ]"},
        {"{\"a\": [ , {\"b\":1 \"c\" : \"x,}\\\"\" }\n \"e\"] \"d\": {},\n}",
         "{\"a\": [  {\"b\":1, \"c\" : \"x,}\\\"\" },\n \"e\"], \"d\": {}\n}"},
        {"[]", "[]"},
        {"{\"a\":{},\"b\":[true,null]}\n", "{\"a\":{},\"b\":[true,null]}\n"},
        {"[\"\\", "[\"\\"},
        {"]},", "]}"}})
    EXPECT_EQ(withCommas(text), mended);
}

TEST(JsonEditor, HostileFiles) {
  const Folder folder;
  std::string many =
      R"({"X3D": {"@version": "3.3", "Scene": {"-children": [{"Group": {"@DEF": "G")";
  for (int i = 0; i < 100'000; ++i) many += ", \"@a" + std::to_string(i) + "\": 1";
  many += "}}]}}}";
  const auto wide = loadWorld(folder.write("wide.x3dj", many));
  Editor editor(*wide);
  editor.insert({wide->scope.names.at("G").get(), "children", 0}, "{\"Shape\": {}}");
  editor.rename(*wide->scope.names.at("G"), "H");
  EXPECT_NE(editor.text().find("{\"Group\": {\"@DEF\": \"H\", \"@a0\": 1"), std::string::npos);

  std::string deep = R"({"X3D": {"@version": "3.3", "Scene": {"-children": [)";
  for (int i = 0; i < 500; ++i) deep += R"({"Group": {"-children": [)";
  for (int i = 0; i < 500; ++i) deep += "]}}";
  deep += R"(, {"PointLight": {"@DEF": "L"}}]}}})";
  const auto nested = loadWorld(folder.write("deep.x3dj", deep));
  Editor within(*nested);
  ASSERT_EQ(within.whyReadOnly(), "");
  within.set(*nested->scope.names.at("L"), "on", false);
  EXPECT_NE(within.text().find(R"({"PointLight": {"@DEF": "L", "@on": false}})"),
            std::string::npos);
}

} // namespace
