// xvrml_edit_xml.cpp: Tests edits of a world's file in XML: what becomes of its text, undo, and
// what is refused.
#include "edit/gzip.h"
#include "unit/xvrml_edit_support.h"

namespace {

using namespace edit_test;

class EditedXml : public Edited {
 protected:
  // body: what stands in the Scene.
  void loadScene(const std::string& body) {
    load("<!DOCTYPE X3D [ <!ENTITY day \"by day\"> ]>\n"
         "<X3D profile='Immersive' version='3.3'>\n  <Scene>\n" +
             body + "  </Scene>\n</X3D>\n",
         "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n", "w.x3d");
  }
  // Returns what stands in the Scene.
  std::string scene() {
    const std::string all = editor->text();
    const size_t begin = all.find("<Scene>\n") + 8;
    return all.substr(begin, all.find("  </Scene>") - begin);
  }
};
INSTANTIATE_TEST_SUITE_P(World, EditedXml, testing::Bool(),
                         [](const auto& info) { return info.param ? "Running" : "Resting"; });

TEST_P(EditedXml, AValueChangesInItsPlace) {
  loadScene("    <!-- a lamp -->\n    <PointLight DEF=\"L\"  intensity='0.50' location=\"0 1 0\" "
            "on='TRUE' /> <!-- half -->\n");
  editor->set(node("L"), "intensity", 0.75f);
  editor->set(node("L"), "location", Vec3f{0, 1, 2});
  editor->set(node("L"), "on", false);
  EXPECT_EQ(scene(), "    <!-- a lamp -->\n    <PointLight DEF=\"L\"  intensity='0.75' "
                     "location=\"0 1 2\" on='FALSE' /> <!-- half -->\n");
  EXPECT_EQ((field<SFFloat>(node("L"), "intensity")), 0.75f);
  undoAll();
}

TEST_P(EditedXml, TextIsEscaped) {
  loadScene("    <Shape><Text DEF='T' string='\"a\" \"b\"'/></Shape>\n"
            "    <Shape><Text DEF='U' string=\"&quot;a&quot;\"/></Shape>\n"
            "    <Shape><Text DEF='V' string='\"&day;\"'/></Shape>\n"
            "    <WorldInfo DEF='W' title=\"a &amp; b\"/>\n");
  EXPECT_EQ((field<MFString>(node("V"), "string")), MFString{"by day"});
  editor->set(node("T"), "string", MFString{"a", "it's <b> & \"c\""});
  editor->set(node("U"), "string", MFString{"a", "b"});
  editor->set(node("W"), "title", std::string("'a' & \"b\"\n"));
  EXPECT_EQ(scene(), "    <Shape><Text DEF='T' string='\"a\" \"it&apos;s &lt;b&gt; &amp; "
                     "\\\"c\\\"\"'/></Shape>\n"
                     "    <Shape><Text DEF='U' string=\"&quot;a&quot; &quot;b&quot;\"/></Shape>\n"
                     "    <Shape><Text DEF='V' string='\"&day;\"'/></Shape>\n"
                     "    <WorldInfo DEF='W' title=\"'a' &amp; &quot;b&quot;&#10;\"/>\n");
  undoAll();
  editor->set(node("V"), "string", MFString{"by night"});
  EXPECT_NE(scene().find("string='\"by night\"'"), std::string::npos);
}

TEST_P(EditedXml, ElementsOfListsChangeInTheirPlaces) {
  loadScene("    <Shape><IndexedFaceSet coordIndex='0 1 2 -1'><Coordinate DEF='A' point='0 0 0\n"
            "      1.0 0 0'/></IndexedFaceSet></Shape>\n"
            "    <Shape><PointSet><Coordinate DEF='B' point='0 0 0, 1 1 1'/></PointSet></Shape>\n");
  editor->set(node("A"), "point", MFVec3f{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}});
  editor->set(node("B"), "point", MFVec3f{{0, 0, 0}, {3, 3, 3}, {1, 1, 1}});
  EXPECT_EQ(
      scene(),
      "    <Shape><IndexedFaceSet coordIndex='0 1 2 -1'><Coordinate DEF='A' point='0 0 0\n"
      "      1.0 0 0\n      2 0 0'/></IndexedFaceSet></Shape>\n    <Shape><PointSet><Coordinate "
      "DEF='B' point='0 0 0, 3 3 3, 1 1 1'/></PointSet></Shape>\n");
  undoAll();
}

TEST_P(EditedXml, AbsentFieldsAreAdded) {
  loadScene("    <PointLight DEF='L' intensity='0'/>\n    <PointLight DEF=\"M\" ></PointLight>\n"
            "    <PointLight DEF='N'\n        intensity='0'/>\n");
  for (const char* name : {"L", "M", "N"}) editor->set(node(name), "radius", 5.f);
  EXPECT_EQ(scene(), "    <PointLight DEF='L' intensity='0' radius='5'/>\n"
                     "    <PointLight DEF=\"M\" radius=\"5\" ></PointLight>\n"
                     "    <PointLight DEF='N'\n        intensity='0'\n        radius='5'/>\n");
  undoAll();
}

TEST_P(EditedXml, NodesAreInsertedRemovedAndMoved) {
  loadScene("    <Group DEF='G'>\n      <Shape DEF='A'/> <!-- the first -->\n"
            "      <Shape DEF='B'></Shape>\n    </Group>\n    <Group DEF='H' />\n"
            "    <Group DEF='I'></Group>\n");
  editor->insert({&node("G"), "children", 1}, "<Shape DEF='C'><Box/></Shape>");
  EXPECT_EQ(scene(), "    <Group DEF='G'>\n      <Shape DEF='A'/> <!-- the first -->\n"
                     "      <Shape DEF='C'><Box/></Shape>\n      <Shape DEF='B'></Shape>\n"
                     "    </Group>\n    <Group DEF='H' />\n    <Group DEF='I'></Group>\n");
  undoAll();
  editor->remove({&node("G"), "children", 2});
  editor->move({&node("G"), "children", 1}, {&node("H"), "children", 0});
  editor->move({&node("G"), "children", 0}, {&node("I"), "children", 0});
  EXPECT_EQ(scene(),
            "    <Group DEF='G'>\n    </Group>\n"
            "    <Group DEF='H'>\n      <Shape DEF='C'><Box/></Shape>\n    </Group>\n"
            "    <Group DEF='I'>\n      <Shape DEF='A'/> <!-- the first -->\n    </Group>\n");
  undoAll();
}

TEST_P(EditedXml, RootsAndRoutes) {
  loadScene("    <TimeSensor DEF='T'/>\n    <ROUTE fromNode='T' fromField='time' toNode='T' "
            "toField='startTime'/>\n");
  editor->insert({nullptr, "", 0}, "<Group DEF=\"A\"/>");
  editor->insert({nullptr, "", 2}, "<PointLight DEF='L'/>");
  editor->addRoute(node("T"), "isActive", node("L"), "on");
  EXPECT_EQ(scene(),
            "    <Group DEF=\"A\"/>\n    <TimeSensor DEF='T'/>\n    <PointLight DEF='L'/>\n"
            "    <ROUTE fromNode='T' fromField='time' toNode='T' toField='startTime'/>\n"
            "    <ROUTE fromNode='T' fromField='isActive' toNode='L' toField='on'/>\n");
  editor->rename(node("T"), "Clock");
  EXPECT_NE(scene().find("<ROUTE fromNode='Clock' fromField='time' toNode='Clock'"),
            std::string::npos);
  undoAll();
  while (editor->undo()) {}
  editor->remove({nullptr, "", 0}); // its route goes with it
  EXPECT_EQ(scene(), "");
  EXPECT_TRUE(editor->undo());
  EXPECT_EQ(editor->text(), original);
}

TEST_P(EditedXml, RoutesWithinNodes) {
  loadScene("    <Group DEF='G'>\n      <TimeSensor DEF='T'/>\n      <ROUTE fromNode='T' "
            "fromField='time' toNode='T' toField='startTime'/>\n    </Group>\n"
            "    <Group DEF='H'/>\n");
  editor->move({&node("G"), "children", 0}, {&node("H"), "children", 0});
  EXPECT_EQ(scene(), "    <Group DEF='G'>\n    </Group>\n    <Group DEF='H'>\n"
                     "      <TimeSensor DEF='T'/>\n    </Group>\n    <ROUTE fromNode='T' "
                     "fromField='time' toNode='T' toField='startTime'/>\n");
  undoAll();
}

TEST_P(EditedXml, NamesAndReferences) {
  loadScene(
      "    <Group>\n      <Shape><Box/></Shape>\n      <Shape DEF=' A ' id='x'/>\n    "
      "</Group>\n    <Group DEF='H'>\n      <Shape class='c' USE='A'></Shape>\n    </Group>\n");
  Node& shape = *field<MFNode>(*world().scope.roots[0], "children")[0];
  editor->use({&node("H"), "children", 0}, shape);
  editor->rename(node("A"), "B");
  EXPECT_EQ(scene(), "    <Group>\n      <Shape DEF='Shape'><Box/></Shape>\n"
                     "      <Shape DEF='B' id='x'/>\n    </Group>\n    <Group DEF='H'>\n"
                     "      <Shape USE='Shape'/>\n      <Shape class='c' USE='B'></Shape>\n"
                     "    </Group>\n");
  undoAll();
  editor->remove({world().scope.roots[0].get(), "children", 1});
  EXPECT_NE(scene().find("<Group DEF='H'>\n      <Shape USE='Shape'/>\n      <Shape DEF='B' "
                         "id='x'/>\n"),
            std::string::npos)
      << scene();
}

TEST_P(EditedXml, ANodeIsWrappedAndCopied) {
  loadScene("    <Group DEF='G'>\n      <Shape DEF='S'>\n        <Box DEF='B'/>\n        "
            "<Appearance>\n          <Material diffuseColor='1 0 0'\n             "
            "shininess='.5'/>\n        </Appearance>\n      </Shape>\n    </Group>\n");
  editor->wrap({&node("G"), "children", 0});
  EXPECT_EQ(scene(),
            "    <Group DEF='G'>\n      <Transform>\n        <Shape DEF='S'>\n          <Box "
            "DEF='B'/>\n          <Appearance>\n            <Material diffuseColor='1 0 0'\n"
            "               shininess='.5'/>\n          </Appearance>\n        </Shape>\n"
            "      </Transform>\n    </Group>\n");
  undoAll();
  editor->undo();
  editor->set(node("B"), "size", Vec3f{1, 2, 3});
  const NodeRef copy = editor->duplicate({&node("G"), "children", 0});
  EXPECT_EQ(copy->defName, "S_2");
  EXPECT_NE(scene().find("      </Shape>\n      <Shape DEF='S_2'>\n        <Box DEF='B_2' "
                         "size='1 2 3'/>\n        <Appearance>\n"),
            std::string::npos)
      << scene();
  undoAll();
}

TEST_P(EditedXml, FieldsSayWhereTheirNodesStand) {
  loadScene("    <Collision DEF='C'><Shape containerField='proxy' DEF='P'/><Group DEF='K'/>"
            "</Collision>\n    <Shape DEF='S'><Appearance DEF='A'/></Shape>\n");
  editor->remove({&node("C"), "proxy", 0});
  editor->insert({&node("C"), "proxy", 0}, "<Shape DEF='Q'/>");
  EXPECT_NE(scene().find("<Collision DEF='C'><Shape DEF='Q' containerField='proxy'/>"
                         "<Group DEF='K'/></Collision>"),
            std::string::npos)
      << scene();
  editor->insert({&node("S"), "geometry", 0}, "<Box/>");
  EXPECT_NE(scene().find("<Shape DEF='S'><Appearance DEF='A'/> <Box/></Shape>"), std::string::npos)
      << scene();
  editor->use({&node("C"), "proxy", 0}, node("S"));
  EXPECT_NE(scene().find("<Shape DEF='S' containerField='proxy'>"), std::string::npos) << scene();
  undoAll();
}

TEST_P(EditedXml, ChildrenOfSeveralFieldsMayBeMixed) {
  loadScene("    <Collision DEF='C'>\n      <Group DEF='A'/>\n      <Shape containerField='proxy' "
            "DEF='P'/>\n      <Group DEF='B'/>\n    </Collision>\n");
  editor->move({&node("C"), "children", 1}, {&node("C"), "children", 0});
  EXPECT_EQ(field<MFNode>(node("C"), "children").size(), 2u);
  editor->insert({&node("C"), "children", 2}, "<Group DEF='D'/>");
  editor->remove({&node("C"), "proxy", 0});
  EXPECT_EQ(scene().find("proxy"), std::string::npos);
  undoAll();
}

TEST_P(EditedXml, FieldsOfInstancesAndScripts) {
  loadScene("    <ProtoDeclare name='Lamp'><ProtoInterface>\n"
            "      <field accessType='initializeOnly' type='SFFloat' name='bright' value='1'/>\n"
            "      <field accessType='inputOutput' type='MFNode' name='kids'/>\n"
            "    </ProtoInterface><ProtoBody><Group><IS><connect nodeField='children' "
            "protoField='kids'/></IS></Group></ProtoBody></ProtoDeclare>\n"
            "    <ProtoInstance name='Lamp' DEF='P'/>\n"
            "    <ProtoInstance name='Lamp' DEF='Q'>\n      <fieldValue name='bright' "
            "value='.50'/>\n      <fieldValue name='kids'>\n        <Group/>\n      </fieldValue>\n"
            "    </ProtoInstance>\n    <Script DEF='S'>\n      <field accessType='initializeOnly' "
            "type='SFFloat' name='x' value='1.0'/>\n      <field accessType='initializeOnly' "
            "type='SFVec2f' name='y'></field>\n      <field accessType='initializeOnly' "
            "type='SFNode' name='n'><Group DEF='K'/></field>\n      <![CDATA[ecmascript:\n"
            "  function f() { if (1 < 2 && 3) return \"<Group/>\"; }\n      ]]>\n    </Script>\n");
  editor->set(node("P"), "bright", .25f);
  editor->insert({&node("P"), "kids", 0}, "<Transform><Shape/></Transform>");
  editor->set(node("Q"), "bright", .75f);
  editor->insert({&node("Q"), "kids", 1}, "<Shape DEF='N'/>");
  editor->set(node("S"), "x", 2.f);
  editor->set(node("S"), "y", Vec2f{3, 4});
  editor->remove({&node("S"), "n", 0});
  const std::string now = scene();
  EXPECT_NE(now.find("    <ProtoInstance name='Lamp' DEF='P'>\n      <fieldValue name='bright' "
                     "value='0.25'/>\n      <fieldValue name='kids'>\n        "
                     "<Transform><Shape/></Transform>\n      </fieldValue>\n    </ProtoInstance>"),
            std::string::npos)
      << now;
  EXPECT_NE(now.find("value='0.75'/>\n      <fieldValue name='kids'>\n        <Group/>\n        "
                     "<Shape DEF='N'/>\n      </fieldValue>"),
            std::string::npos)
      << now;
  EXPECT_NE(now.find("name='x' value='2'/>\n      <field accessType='initializeOnly' "
                     "type='SFVec2f' name='y' value='3 4'></field>\n      <field "
                     "accessType='initializeOnly' type='SFNode' name='n'></field>\n      "
                     "<![CDATA[ecmascript:\n  function f()"),
            std::string::npos)
      << now;
  undoAll();
  EXPECT_EQ(refusal([&] { editor->set(node("S"), "url", MFString{"a.js"}); }),
            "the program of this Script of line 16 stands between its tags: edit it there");
  editor->wrap({nullptr, "", 2});
  EXPECT_NE(scene().find("        <![CDATA[ecmascript:\n  function f()"), std::string::npos);
  undoAll();
}

TEST_P(EditedXml, WhatIsRefusedIsSaid) {
  loadScene("    <Group DEF='G'/>\n");
  const auto insert = [&](const std::string& text) {
    return refusal([&] { editor->insert({&node("G"), "children", 0}, text); });
  };
  EXPECT_NE(insert("<Group/><Group/>"), "done");
  EXPECT_NE(insert("<Grupp/>"), "done");
  EXPECT_NE(insert("Group { }"), "done");
  EXPECT_NE(insert("<Group>"), "done");
  EXPECT_NE(insert("<ROUTE fromNode='G' fromField='a' toNode='G' toField='b'/>"), "done");
  EXPECT_EQ(insert("<!DOCTYPE Group [ <!ENTITY e \"<Shape/>\"> ]><Group>&e;</Group>"),
            "the text has elements within entities of its document type");
  EXPECT_EQ(insert("<Box/>"), "Box cannot be in field children of Group: expected child");
  EXPECT_EQ(insert("<X3D version='3.3'><Scene><Group/></Scene></X3D>"), "done");
}

TEST_P(EditedXml, LineEndsStay) {
  load("<Scene>\r\n  <Group DEF='G'/>\r\n</Scene></X3D>", "<X3D version='3.3'>\r\n", "w.x3d");
  editor->insert({&node("G"), "children", 0}, "<Group/>");
  EXPECT_EQ(editor->text(), "<X3D version='3.3'>\r\n<Scene>\r\n  <Group DEF='G'>\r\n    <Group/>"
                            "\r\n  </Group>\r\n</Scene></X3D>");
  undoAll();
}

TEST_P(EditedXml, TextsThatAreInsertedGetTheEndsOfLinesOfTheFile) {
  load("<Scene>\r\n  <Group DEF='G'/>\r\n</Scene></X3D>", "<X3D version='3.3'>\r\n", "w.x3d");
  editor->insert({&node("G"), "children", 0},
                 "<Script>\n  <!-- it's -->\n  <field name='v' type='MFFloat'\n    "
                 "accessType='inputOutput' value='1\n2'/><![CDATA[ecmascript:\n1]]>\n</Script>");
  const std::string now = editor->text();
  EXPECT_EQ(std::count(now.begin(), now.end(), '\n'), 11);
  EXPECT_EQ(std::count(now.begin(), now.end(), '\r'), 11);
  undoAll();
}

TEST(XmlEditor, EmptyScenesAreFilled) {
  const Folder folder;
  for (const auto& [text, filled] :
       {std::pair<std::string, std::string>{"<X3D version='3.3'><Scene/></X3D>",
                                            "<X3D version='3.3'><Scene>\n  <Group DEF='A'/>\n"
                                            "</Scene></X3D>"},
        {"\n\n<x3d version='3.3'>\n <scene>\n </scene>\n</x3d>\n",
         "\n\n<x3d version='3.3'>\n <scene>\n   <Group DEF='A'/>\n </scene>\n</x3d>\n"}}) {
    const auto world = loadWorld(folder.write("w.x3d", text));
    Editor editor(*world);
    editor.insert({nullptr, "", 0}, "<Group DEF='A'/>");
    EXPECT_EQ(editor.text(), filled);
    EXPECT_TRUE(editor.undo());
    EXPECT_EQ(editor.text(), text);
  }
}

TEST(XmlEditor, MarkedAndPackedFiles) {
  const Folder folder;
  const std::string text = "<X3D version='3.3'><Scene><PointLight DEF='L'/></Scene></X3D>";
  const auto world = loadWorld(folder.write("w.x3dz", packed("\xef\xbb\xbf" + text)));
  Editor editor(*world);
  EXPECT_EQ(editor.whyReadOnly(), "");
  editor.set(*world->scope.names.at("L"), "on", false);
  const std::string bytes = editor.bytes();
  EXPECT_EQ(bytes.substr(0, 2), "\x1f\x8b");
  const auto read = loadWorldFromMemory(bytes, "w.x3dz");
  EXPECT_FALSE(field<SFBool>(*read->scope.names.at("L"), "on"));
  EXPECT_EQ(editor.text(), "<X3D version='3.3'><Scene><PointLight DEF='L' on='false'/></Scene>"
                           "</X3D>");
}

TEST(XmlEditor, FilesThatCannotBeEditedAreSaid) {
  const Folder folder;
  const auto why = [&](const std::string& text) {
    const auto world = loadWorld(folder.write("a.x3d", text));
    const std::string reason = Editor(*world).whyReadOnly();
    return reason.substr(std::min(reason.find(' '), reason.size()));
  };
  EXPECT_EQ(why("<X3D version='3.3'><Scene><Group></Scene></X3D>"),
            " is not well-formed XML: mend it first");
  EXPECT_EQ(why("<X3D version='3.3'><Scene><Group DEF='A' DEF='B'/></Scene></X3D>"),
            " is not well-formed XML: mend it first");
  EXPECT_EQ(why("<X3D version='3.3'><Scene>"), " is not well-formed XML: mend it first");
  EXPECT_EQ(why("<X3D version='3.3'><head/></X3D>"), " has no Scene");
  EXPECT_EQ(why("<?xml version='1.0' encoding='ISO-8859-1'?><X3D version='3.3'><Scene/></X3D>"),
            " is in ISO-8859-1: only XML in UTF-8 can be edited");
  EXPECT_EQ(why("<!DOCTYPE X3D [ <!ENTITY e \"<Group/>\"> ]><X3D version='3.3'><Scene>&e;</Scene>"
                "</X3D>"),
            " has elements within entities of its document type");
  EXPECT_EQ(why("<!DOCTYPE X3D [ <!ATTLIST Group DEF CDATA 'x'> ]><X3D version='3.3'><Scene>"
                "<Group/></Scene></X3D>"),
            " gets values of attributes from its document type");
  EXPECT_EQ(why("<X3D version='3.3'><Scene/></X3D>"), "");
}

TEST_P(EditedXml, WhatCouldNotBeReadStaysAsItIs) {
  for (const char* body :
       {"<Foo/><Group><Foo><Group DEF='X'/></Foo></Group>",
        "<Box/>",
        "<Group><Box/></Group>",
        "<Shape><Box/><Sphere/></Shape>",
        "<Shape><Box size='1 x 2' foo='1' onclick='f()'/></Shape>",
        "<Group containerField='nothing'/>",
        "<Group><Shape containerField='nothing'/></Group>",
        "<Group DEF='a b'/>",
        "<Group USE='none'/>",
        "<Group DEF=''/>",
        "<Script><field accessType='initializeOnly' type='SFNode' name='n'><Group USE='none'/>"
        "</field></Script>",
        "text <Group>text</Group>",
        "<shape><box SIZE='1 2 3'/></shape>",
        "<Group bboxsize='1 1 1' bboxSize='2 2 2'/>",
        "<x:Group xmlns:x='y' x:z='1'/>",
        "<Script url=' \"a\" '><![CDATA[b]]>c<!-- d -->&amp;</Script>",
        "<Group children='NULL'><Shape/></Group>",
        "<ROUTE/>",
        "<ProtoDeclare/>",
        "<ProtoInstance name='none'/>",
        "<?pi?><!-- <Group/> --><Group><![CDATA[<a/>]]></Group>"}) {
    const std::string text = "<X3D version='3.3'>\n<Scene>\n<PointLight DEF='L'/>\n" +
                             std::string(body) + "\n</Scene>\n</X3D>\n";
    const auto loaded = loadWorld(folder.write("f.x3d", text));
    Editor faulty(*loaded);
    ASSERT_EQ(faulty.whyReadOnly(), "");
    EXPECT_EQ(faulty.text(), text);
    faulty.remove({nullptr, "", 0});
    EXPECT_EQ(faulty.text(),
              "<X3D version='3.3'>\n<Scene>\n" + std::string(body) + "\n</Scene>\n</X3D>\n");
    EXPECT_TRUE(faulty.undo());
    EXPECT_EQ(faulty.text(), text);
  }
}

// Random edits, all undone, give the file back; all done again, the edited one.
TEST_P(EditedXml, RandomEditsCanBeUndone) {
  loadScene("    <Group DEF='C2'/>\n    <!-- one -->\n    <Transform DEF='A' translation='1 2 3'>\n"
            "      <Shape DEF='B'><Box DEF='C' size='1 1 1'/></Shape> <!-- comma -->\n"
            "      <Shape USE='B'/>\n      <Group><Transform DEF='D'/></Group>\n"
            "      <ROUTE fromNode='A' fromField='translation' toNode='A' toField='scale'/>\n"
            "    </Transform>\n    <Group DEF='E'><Group USE='C2'/></Group>\n"
            "    <TimeSensor DEF='T'/>\n    <ProtoDeclare name='P'><ProtoInterface>"
            "<field accessType='inputOutput' type='MFNode' name='kids'/></ProtoInterface>"
            "<ProtoBody><Group><IS><connect nodeField='children' protoField='kids'/></IS></Group>"
            "</ProtoBody></ProtoDeclare>\n    <ProtoInstance name='P' DEF='I'><fieldValue "
            "name='kids'><Group/></fieldValue></ProtoInstance>\n    <ProtoInstance name='P'/>\n");
  for (unsigned seed = 1; seed <= 20; ++seed)
    editAtRandom(seed, "<Group/>", "<Transform DEF='N'>\n  <Group/>\n</Transform>");
}

TEST(XmlEditor, HostileFiles) {
  const Folder folder;
  std::string many = "<X3D version='3.3'><Scene><Group DEF='G'";
  for (int i = 0; i < 100'000; ++i) many += " a" + std::to_string(i) + "='1'";
  many += "/></Scene></X3D>";
  const auto wide = loadWorld(folder.write("wide.x3d", many));
  Editor editor(*wide);
  editor.insert({wide->scope.names.at("G").get(), "children", 0}, "<Shape/>");
  editor.rename(*wide->scope.names.at("G"), "H");
  EXPECT_NE(editor.text().find("<Group DEF='H' a0='1'"), std::string::npos);

  std::string deep = "<X3D version='3.3'><Scene>";
  for (int i = 0; i < 100'000; ++i) deep += "<Group>";
  for (int i = 0; i < 100'000; ++i) deep += "</Group>";
  deep += "<PointLight DEF='L'/></Scene></X3D>";
  const auto nested = loadWorld(folder.write("deep.x3d", deep));
  Editor within(*nested);
  within.set(*nested->scope.names.at("L"), "on", false);
  EXPECT_NE(within.text().find("<PointLight DEF='L' on='false'/>"), std::string::npos);
}

} // namespace
