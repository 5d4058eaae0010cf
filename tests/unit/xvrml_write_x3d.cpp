// xvrml_write_x3d.cpp: worlds written as X3D, in ClassicVRML and in XML (ISO/IEC 19776-1 and -2).
#include <gtest/gtest.h>

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
      </fieldValue>
    </ProtoInstance>
    <ExternProtoDeclare name='E' url='"e.wrl"'>
      <field accessType='initializeOnly' type='SFFloat' name='x'/>
    </ExternProtoDeclare>)");
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
