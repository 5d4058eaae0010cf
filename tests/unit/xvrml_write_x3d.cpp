// xvrml_write_x3d.cpp: worlds written as X3D, in ClassicVRML and in XML (ISO/IEC 19776-1 and -2).
#include <gtest/gtest.h>

#include "xvrml/nodes.h"
#include "xvrml/world.h"

namespace {

using namespace xvrml;

std::string written(const std::string& vrml, Encoding encoding, const std::string& name = "w.wrl") {
  return writeWorld(*loadWorldFromMemory(vrml, name), "", encoding);
}

// Returns what stands between <Scene> and </Scene>.
std::string scene(const std::string& vrml) {
  const std::string text = written("#VRML V2.0 utf8\n" + vrml, Encoding::x3dXml);
  const size_t begin = text.find("<Scene>") + 7;
  return text.substr(begin, text.find("\n  </Scene>") - begin);
}

TEST(WriteX3d, TheSuffixSaysTheEncoding) {
  EXPECT_EQ(writtenEncoding("a.wrl"), Encoding::vrml97);
  EXPECT_EQ(writtenEncoding("a.x3d.old"), Encoding::vrml97);
  EXPECT_EQ(writtenEncoding("folder.x3d/world"), Encoding::vrml97);
  EXPECT_EQ(writtenEncoding("a.X3DV"), Encoding::x3dClassic);
  EXPECT_EQ(writtenEncoding("a.x3d"), Encoding::x3dXml);
  EXPECT_EQ(writtenEncoding("a.x3dj"), Encoding::x3dJson);
  EXPECT_EQ(writtenEncoding("a.JSON"), Encoding::x3dJson);
  EXPECT_EQ(writtenEncoding(""), Encoding::vrml97);
}

TEST(WriteX3d, ClassicHasTheWordsOfX3d) {
  EXPECT_EQ(written(R"(#VRML V2.0 utf8 by hand
# one
PROTO P [ exposedField SFFloat f 1 ] { Collision { collide FALSE } }
P { }
DEF S Switch { choice Group { } }
DEF C Script { field SFBool b TRUE eventIn MFNode n })",
                    Encoding::x3dClassic),
            R"(#X3D V3.3 utf8
# one
PROFILE Immersive

PROTO P [
  inputOutput SFFloat f 1
] {
  Collision {
    enabled FALSE
  }
}
P { }
DEF S Switch {
  children [
    Group { }
  ]
}
DEF C Script {
  initializeOnly SFBool b TRUE
  inputOnly MFNode n
}
)");
}

TEST(WriteX3d, TheHeadIsKept) {
  const std::string text = "#X3D V3.2 utf8\nPROFILE Interchange\nCOMPONENT Text:1\n"
                           "META \"title\" \"a \\\"b\\\" & <c>\"\n\nGroup { }\n";
  EXPECT_EQ(written(text, Encoding::x3dClassic, "w.x3dv"), text);
  EXPECT_EQ(written(text, Encoding::x3dXml, "w.x3dv"),
            "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
            "<X3D profile='Interchange' version='3.2'>\n  <head>\n"
            "    <component name='Text' level='1'/>\n"
            "    <meta name='title' content='a \"b\" &amp; &lt;c&gt;'/>\n  </head>\n"
            "  <Scene>\n    <Group/>\n  </Scene>\n</X3D>\n");
}

// Returns what stands in the list of the scene.
std::string jsonScene(const std::string& vrml) {
  const std::string text = written("#VRML V2.0 utf8\n" + vrml, Encoding::x3dJson);
  const std::string begin = "\"-children\": [", end = "\n      ]\n    }\n  }\n}\n";
  const size_t first = text.find(begin) + begin.size();
  EXPECT_TRUE(text.ends_with(end) || text.ends_with("[]\n    }\n  }\n}\n")) << text;
  return text.substr(first, text.size() - first - end.size());
}

TEST(WriteX3d, JsonHasAnObjectForEachNode) {
  EXPECT_EQ(jsonScene("DEF T Transform { translation 1 2 3 children [ Group { } Shape { geometry "
                      "DEF B Box { size 1 1 2 } } ] }\nTransform { children [ Shape { geometry USE "
                      "B } ] }"),
            R"(
        { "Transform": {
          "@DEF": "T",
          "-children": [
            { "Group": {} },
            { "Shape": {
              "-geometry": { "Box": {
                "@DEF": "B",
                "@size": [1, 1, 2]
              } }
            } }
          ],
          "@translation": [1, 2, 3]
        } },
        { "Transform": {
          "-children": [
            { "Shape": {
              "-geometry": { "Box": {
                "@USE": "B"
              } }
            } }
          ]
        } })");
}

TEST(WriteX3d, JsonHasListsOfDeclaredFields) {
  EXPECT_EQ(jsonScene("Script { field SFBool b TRUE eventIn MFNode n field MFNode k Group { } }"),
            R"(
        { "Script": {
          "field": [
            {
              "@accessType": "initializeOnly",
              "@type": "SFBool",
              "@name": "b",
              "@value": true
            },
            {
              "@accessType": "inputOnly",
              "@type": "MFNode",
              "@name": "n"
            },
            {
              "@accessType": "initializeOnly",
              "@type": "MFNode",
              "@name": "k",
              "-children": [
                { "Group": {} }
              ]
            }
          ]
        } })");
}

// Every value reads back equal: texts with marks, control characters and zero bytes, empty lists,
// pictures, and names that are words of JSON.
TEST(WriteX3d, JsonReadsBackEqual) {
  const std::string text =
      "#X3D V3.3 utf8\nPROFILE Full\nCOMPONENT Text:1\nUNIT length mm 0.001\nMETA \"a\" "
      "\"\\\"b\\\\\"\n"
      "PROTO P [ inputOutput SFString s \"null\" inputOutput MFNode n [ Group { } ] "
      "initializeOnly MFString l [ ] ] { Transform { children IS n } }\n"
      "EXTERNPROTO E [ inputOutput SFFloat f ] [ \"e.x3dv#E\" ]\n"
      "DEF null P { s \"{\\\"a\\\": [\" n [ DEF G Group { } ] l [ \"\" \"null\" ] }\n"
      "DEF S Script { inputOutput MFBool b [ TRUE FALSE ] inputOutput MFString t [ \"one, [\" ] "
      "inputOutput SFImage i 1 2 3 0xff0000 0x0000ff inputOutput MFImage m [ 1 1 1 7, 0 0 0 ] "
      "inputOutput SFDouble d 1e-300 inputOutput MFVec3d v [ 1 2 3, 4 5 6e200 ] inputOutput SFNode "
      "g USE G outputOnly SFTime when url \"javascript: function f() {\n\treturn "
      "'\\\\x01';\n}\" }\n"
      "Shape { geometry IndexedLineSet { coord Coordinate { point [ ] } coordIndex [ 0 -1 ] } }\n"
      "ROUTE null.s_changed TO null.set_s\n";
  const auto world = loadWorldFromMemory(text, "w.x3dv");
  const std::string json = writeWorld(*world, "", Encoding::x3dJson);
  const auto again = loadWorldFromMemory(json, "w.x3dv");
  const auto said = [](const World& of) {
    std::string all;
    for (const Diagnostic& one : of.diagnostics.list()) all += one.message + '\n';
    return all;
  };
  EXPECT_EQ(said(*again), said(*world)) << json;
  EXPECT_EQ(again->head.version.encoding, Encoding::x3dJson);
  std::string difference;
  EXPECT_TRUE(equalScopes(world->scope, again->scope, &difference)) << difference << json;
  EXPECT_EQ(writeWorld(*again, "", Encoding::x3dJson), json);
  EXPECT_EQ(writeWorld(*again, "", Encoding::x3dClassic),
            writeWorld(*world, "", Encoding::x3dClassic));
}

// Comments at the top name the program that wrote a file, also in JSON.
TEST(WriteX3d, JsonKeepsTheCommentsAtTheTop) {
  const auto world =
      loadWorldFromMemory("#VRML V2.0 utf8\n# by \"hand\"\n#two\nGroup { }", "w.wrl");
  const auto again = loadWorldFromMemory(writeWorld(*world, "", Encoding::x3dJson), "w.json");
  EXPECT_NE(writeWorld(*again).find("# by \"hand\"\n#two\n"), std::string::npos)
      << writeWorld(*again);
}

TEST(WriteX3d, CommentsOfXmlHoldNoPairOfHyphens) {
  EXPECT_TRUE(written("#VRML V2.0 utf8\n# a---b-\nGroup { }", Encoding::x3dXml)
                  .starts_with("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<!-- a- -b- -->\n"));
}

TEST(WriteX3d, FieldsAreAttributesAndNodesAreElements) {
  EXPECT_EQ(scene("Transform { translation 1 2 3 children [ Shape { geometry DEF B Box { size 1 1 "
                  "1 } } Shape { geometry USE B } ] }"),
            "\n    <Transform translation='1 2 3'>"
            "\n      <Shape>\n        <Box DEF='B' size='1 1 1'/>"
            "\n      </Shape>"
            "\n      <Shape>\n        <Box USE='B'/>\n      </Shape>"
            "\n    </Transform>");
}

TEST(WriteX3d, StringsKeepTheirCharacters) {
  EXPECT_EQ(
      scene("WorldInfo { title \"a 'b' \\\"c\\\" \\\\ & <\nnew\" info [ \"x\" \"y \\\"z\\\"\" ] }"),
      "\n    <WorldInfo info='\"x\", \"y \\\"z\\\"\"' "
      "title='a &apos;b&apos; \"c\" \\ &amp; &lt;&#10;new'/>");
}

TEST(WriteX3d, BytesThatAreNotUtf8AreLatin1AndControlCharactersAreReplaced) {
  EXPECT_EQ(scene("WorldInfo { title \"\xe9\x01\" }"),
            "\n    <WorldInfo title='&#233;\xef\xbf\xbd'/>");
}

TEST(WriteX3d, ProgramsStandInCdata) {
  EXPECT_EQ(
      scene("Script { eventIn SFBool b url \"ecmascript:\nfunction b(v) { if (v && 1 < 2) ; }\" }"),
      "\n    <Script>\n      <field accessType='inputOnly' type='SFBool' name='b'/>"
      "\n      <![CDATA[ecmascript:\nfunction b(v) { if (v && 1 < 2) ; }]]>\n    </Script>");
  // A program that ends a CDATA section is an attribute.
  EXPECT_EQ(scene("Script { url \"ecmascript:\nx[y[0]]>1;\" }"),
            "\n    <Script url='\"ecmascript:&#10;x[y[0]]&gt;1;\"'/>");
}

TEST(WriteX3d, PrototypesHaveAnInterfaceABodyAndConnections) {
  EXPECT_EQ(scene("PROTO P [ exposedField SFVec3f at 0 0 1 field MFNode c [ Group { } ] eventIn "
                  "SFVec3f go ] { Transform { translation IS at set_scale IS go children IS c } }\n"
                  "EXTERNPROTO E [ field SFFloat x ] \"e.wrl\"\n"
                  "DEF I P { at 1 2 3 c [ Group { } NULL ] }"),
            R"(
    <ProtoDeclare name='P'>
      <ProtoInterface>
        <field accessType='inputOutput' type='SFVec3f' name='at' value='0 0 1'/>
        <field accessType='initializeOnly' type='MFNode' name='c'>
          <Group/>
        </field>
        <field accessType='inputOnly' type='SFVec3f' name='go'/>
      </ProtoInterface>
      <ProtoBody>
        <Transform>
          <IS>
            <connect nodeField='children' protoField='c'/>
            <connect nodeField='translation' protoField='at'/>
            <connect nodeField='set_scale' protoField='go'/>
          </IS>
        </Transform>
      </ProtoBody>
    </ProtoDeclare>
    <ProtoInstance DEF='I' name='P'>
      <fieldValue name='at' value='1 2 3'/>
      <fieldValue name='c'>
        <Group/>
        <Group/>
      </fieldValue>
    </ProtoInstance>
    <ExternProtoDeclare name='E' url='"e.wrl"'>
      <field accessType='initializeOnly' type='SFFloat' name='x'/>
    </ExternProtoDeclare>)");
}

// The positions of what Switch and LOD choose from stay, and so does what is drawn.
TEST(WriteX3d, AnEmptyGroupTakesThePlaceOfNull) {
  const char* const text = "Switch { whichChoice 1 choice [ NULL Shape { } NULL ] }\n"
                           "Group { children [ NULL Shape { } ] }";
  const char* const script = "Script { field MFNode n [ NULL Shape { } ] field SFNode o NULL }";
  EXPECT_EQ(scene(text), "\n    <Switch whichChoice='1'>\n      <Group/>\n      <Shape/>\n      "
                         "<Group/>\n    </Switch>\n    <Group>\n      <Shape/>\n    </Group>");
  EXPECT_EQ(scene(script),
            "\n    <Script>\n      <field accessType='initializeOnly' type='MFNode' name='n'>\n"
            "        <Group/>\n        <Shape/>\n      </field>\n"
            "      <field accessType='initializeOnly' type='SFNode' name='o'/>\n    </Script>");
  const auto again = loadWorldFromMemory(
      written(std::string("#VRML V2.0 utf8\n") + text, Encoding::x3dJson), "w.x3dj");
  const auto& choice = nodeCast<nodes::Switch>(again->scope.roots.at(0))->choice;
  ASSERT_EQ(choice.size(), 3u);
  EXPECT_TRUE(nodeCast<nodes::Group>(choice[0]));
  EXPECT_TRUE(nodeCast<nodes::Shape>(choice[1]));
  EXPECT_EQ(nodeCast<nodes::Group>(again->scope.roots.at(1))->children.size(), 1u);
}

// VRML97 lets a texture replace the diffuseColor, wherever it stands.
TEST(WriteX3d, TexturesOfMaterialsAreToldAsWell) {
  const auto changes = [](const std::string& colour) {
    const auto world = loadWorldFromMemory(
        "#X3D V4.0 utf8\nShape { appearance Appearance { material Material { " + colour +
            " diffuseTexture PixelTexture { image 1 1 3 0xff0000 } } } }",
        "w.x3dv");
    return changesByWriting(*world, Encoding::vrml97).size();
  };
  EXPECT_EQ(changes(""), 1u);
  EXPECT_EQ(changes("diffuseColor 1 1 1"), 0u);
}

TEST(WriteX3d, ColoursBelowTexturesAreToldAsWell) {
  const auto changes = [](const std::string& geometry) {
    const auto world = loadWorldFromMemory(
        "#X3D V3.3 utf8\nShape { appearance Appearance { texture PixelTexture { image 1 1 3 "
        "0xff0000 } } geometry " +
            geometry + " }",
        "w.x3dv");
    return changesByWriting(*world, Encoding::vrml97).size();
  };
  EXPECT_EQ(changes("IndexedFaceSet { color Color { color 0 1 1 } }"), 1u);
  EXPECT_EQ(changes("IndexedFaceSet { }"), 0u);
  EXPECT_EQ(changes("Box { }"), 0u);
}

TEST(WriteX3d, RoutesAreElements) {
  EXPECT_EQ(
      scene("DEF T TimeSensor { }\nDEF S Switch { }\nROUTE T.isActive TO S.set_whichChoice\n"),
      "\n    <TimeSensor DEF='T'/>\n    <Switch DEF='S'/>");
  EXPECT_EQ(scene("DEF A Group { }\nDEF S Switch { }\nROUTE A.children_changed TO S.set_choice\n"),
            "\n    <Group DEF='A'/>\n    <Switch DEF='S'/>"
            "\n    <ROUTE fromNode='A' fromField='children_changed' toNode='S' "
            "toField='set_children'/>");
}

} // namespace
