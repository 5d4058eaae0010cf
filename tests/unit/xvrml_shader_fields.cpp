// xvrml_shader_fields.cpp: Tests fields that an ORTShader declares: in each encoding, written back,
// in prototypes, with routes, and what is refused.
#include "unit/xvrml_parser_support.h"
#include "xvrml/browser.h"
#include "xvrml/edit.h"
#include "xvrml/set_field.h"

namespace {

using namespace parser_test;

constexpr const char* vrml97 = R"(#VRML V2.0 utf8
Shape {
  appearance ORTAppearance {
    shader DEF S ORTShader {
      file "glass"
      exposedField SFFloat index 1.5
      name "Glass"
      field SFColor absorption 0.5 0.25 0
      exposedField MFString profile [ "a.ies", "b.ies" ]
      exposedField SFNode picture DEF P PixelTexture { }
      field SFNode none NULL
    }
  }
}
DEF I ScalarInterpolator { key [ 0, 1 ] keyValue [ 1, 2 ] }
ROUTE I.value_changed TO S.index
)";

constexpr const char* classic = R"(#X3D V3.3 utf8
PROFILE Full
Shape {
  appearance ORTAppearance {
    shader DEF S ORTShader {
      name "Glass"
      file "glass"
      inputOutput SFFloat index 1.5
      initializeOnly SFColor absorption 0.5 0.25 0
      inputOutput MFString profile [ "a.ies" "b.ies" ]
      inputOutput SFNode picture DEF P PixelTexture { }
      initializeOnly SFNode none NULL
    }
  }
}
DEF I ScalarInterpolator { key [ 0 1 ] keyValue [ 1 2 ] }
ROUTE I.value_changed TO S.index
)";

constexpr const char* xml = R"(<X3D version='3.3' profile='Full'><Scene><Shape><ORTAppearance>
<ORTShader DEF='S' name='Glass' file='glass'>
  <field name='index' type='SFFloat' accessType='inputOutput' value='1.5'/>
  <field name='absorption' type='SFColor' accessType='initializeOnly' value='0.5 0.25 0'/>
  <field name='profile' type='MFString' accessType='inputOutput' value='"a.ies" "b.ies"'/>
  <field name='picture' type='SFNode' accessType='inputOutput'><PixelTexture DEF='P'/></field>
  <field name='none' type='SFNode' accessType='initializeOnly'/>
</ORTShader></ORTAppearance></Shape>
<ScalarInterpolator DEF='I' key='0 1' keyValue='1 2'/>
<ROUTE fromNode='I' fromField='value_changed' toNode='S' toField='index'/></Scene></X3D>)";

constexpr const char* json =
    R"({"X3D": {"@version": "3.3", "@profile": "Full", "Scene": {"-children": [
{"Shape": {"-appearance": {"ORTAppearance": {"-shader": {"ORTShader": {
  "@DEF": "S", "@name": "Glass", "@file": "glass", "field": [
  {"@name": "index", "@type": "SFFloat", "@accessType": "inputOutput", "@value": 1.5},
  {"@name": "absorption", "@type": "SFColor", "@accessType": "initializeOnly", "@value": [0.5, 0.25, 0]},
  {"@name": "profile", "@type": "MFString", "@accessType": "inputOutput", "@value": ["a.ies", "b.ies"]},
  {"@name": "picture", "@type": "SFNode", "@accessType": "inputOutput", "-children": [{"PixelTexture": {"@DEF": "P"}}]},
  {"@name": "none", "@type": "SFNode", "@accessType": "initializeOnly"}]}}}}}},
{"ScalarInterpolator": {"@DEF": "I", "@key": [0, 1], "@keyValue": [1, 2]}},
{"ROUTE": {"@fromNode": "I", "@fromField": "value_changed", "@toNode": "S", "@toField": "index"}}]}}})";

Node& named(const World& world, const std::string& name) { return *world.scope.names.at(name); }

TEST(ShaderFields, EachEncodingDeclaresThem) {
  const std::pair<const char*, const char*> files[] = {
      {vrml97, "w.wrl"}, {classic, "w.x3dv"}, {xml, "w.x3d"}, {json, "w.x3dj"}};
  const auto first = loadWorldFromMemory(vrml97, "w.wrl");
  for (const auto& [text, name] : files) {
    SCOPED_TRACE(name);
    const auto world = loadWorldFromMemory(text, name);
    EXPECT_EQ(messages(*world), "");
    const Node& shader = named(*world, "S");
    EXPECT_EQ(nodeCast<nodes::ORTShader>(&shader)->name, "Glass");
    EXPECT_EQ((field<SFFloat>(shader, "index")), 1.5f);
    EXPECT_EQ((field<SFColor>(shader, "absorption")), (Color{.5f, .25f, 0}));
    EXPECT_EQ((field<MFString>(shader, "profile")), (MFString{"a.ies", "b.ies"}));
    EXPECT_EQ((field<SFNode>(shader, "picture")).get(), &named(*world, "P"));
    EXPECT_FALSE((field<SFNode>(shader, "none")));
    EXPECT_EQ(shader.type().find("index")->access, Access::exposedField);
    EXPECT_EQ(shader.type().find("absorption")->access, Access::field);
    EXPECT_EQ(shader.type().find("index")->change, Change::shader);
    EXPECT_TRUE(shader.type().find("profile")->holdsUrls);
    EXPECT_EQ(world->scope.routes.size(), 1u);
    std::string difference;
    EXPECT_TRUE(equalScopes(first->scope, world->scope, &difference)) << difference;
  }
}

TEST(ShaderFields, AreWrittenAsTheyWereDeclared) {
  for (const char* text : {vrml97, classic, xml, json}) {
    const auto world = loadWorldFromMemory(text, "w");
    for (const auto& [encoding, name] :
         {std::pair{Encoding::vrml97, "again.wrl"}, std::pair{Encoding::x3dClassic, "again.x3dv"},
          std::pair{Encoding::x3dXml, "again.x3d"}}) {
      const std::string written = writeWorld(*world, "", encoding);
      SCOPED_TRACE(written);
      const auto again = loadWorldFromMemory(written, name);
      EXPECT_EQ(messages(*again), "");
      std::string difference;
      EXPECT_TRUE(equalScopes(world->scope, again->scope, &difference)) << difference;
    }
    EXPECT_NE(writeWorld(*world, "", Encoding::vrml97).find("exposedField SFFloat index 1.5\n"),
              std::string::npos);
    EXPECT_NE(writeWorld(*world, "", Encoding::x3dClassic)
                  .find("initializeOnly SFColor absorption 0.5 0.25 0\n"),
              std::string::npos);
    EXPECT_NE(
        writeWorld(*world, "", Encoding::x3dXml)
            .find("<field accessType='inputOutput' type='SFFloat' name='index' value='1.5'/>"),
        std::string::npos);
  }
}

TEST(ShaderFields, UrlsLeadToTheSameFilesFromAnotherFolder) {
  const Folder folder;
  const std::string path =
      folder.write("a/w.wrl", header + "ORTLight { shader ORTShader { "
                                       "field MFString profile \"lamp.ies\" } }");
  const std::string written = writeWorld(*loadWorld(path), folder.path("w.wrl"));
  EXPECT_NE(written.find("field MFString profile [ \"a/lamp.ies\" ]"), std::string::npos)
      << written;
}

TEST(ShaderFields, EqualComparesThem) {
  const auto shader = [](const std::string& fields) {
    return parse("ORTBackground { shader ORTShader { " + fields + " } }");
  };
  const auto differ = [&](const std::string& a, const std::string& b) {
    return !equalScopes(shader(a)->scope, shader(b)->scope);
  };
  EXPECT_FALSE(differ("field SFFloat x 1", "field SFFloat x 1"));
  EXPECT_TRUE(differ("field SFFloat x 1", "field SFFloat x 2"));
  EXPECT_TRUE(differ("field SFFloat x 1", "field SFInt32 x 1"));
  EXPECT_TRUE(differ("field SFFloat x 1", "exposedField SFFloat x 1"));
  EXPECT_TRUE(differ("field SFFloat x 1", "field SFFloat y 1"));
  EXPECT_TRUE(differ("field SFFloat x 1", ""));
}

TEST(ShaderFields, InPrototypesTheyCanBeIs) {
  const std::string text =
      "PROTO Lens [ exposedField SFFloat n 1.5 field MFString maps [ ] ] {\n"
      "  ORTAppearance { shader DEF S ORTShader {\n"
      "    name \"Glass\" exposedField SFFloat index IS n field MFString picture IS maps\n"
      "    field SFFloat abbe 30 } } }\n"
      "Shape { appearance DEF A Lens { n 1.75 maps \"a.png\" } }\n"
      "Shape { appearance DEF B Lens { } }\n";
  const auto world = parse(text);
  EXPECT_EQ(messages(*world), "");
  const auto shaderOf = [&](const char* name) -> const Node& {
    const auto* appearance = nodeCast<nodes::ORTAppearance>(renderedNode(&named(*world, name)));
    return *appearance->shader;
  };
  EXPECT_EQ((field<SFFloat>(shaderOf("A"), "index")), 1.75f);
  EXPECT_EQ((field<MFString>(shaderOf("A"), "picture")), MFString{"a.png"});
  EXPECT_EQ((field<SFFloat>(shaderOf("B"), "index")), 1.5f);
  EXPECT_EQ((field<SFFloat>(shaderOf("B"), "abbe")), 30);
  EXPECT_NE(&shaderOf("A"), &shaderOf("B"));
  setField(*world, named(*world, "B"), "n", 1.25f);
  EXPECT_EQ((field<SFFloat>(shaderOf("B"), "index")), 1.25f);
  const auto again = loadWorldFromMemory(writeWorld(*parse(text)), "again.wrl");
  EXPECT_EQ(messages(*again), "");
  EXPECT_TRUE(equalScopes(parse(text)->scope, again->scope));
}

TEST(ShaderFields, RoutesChangeThem) {
  Browser browser(loadWorldFromMemory(vrml97, "w.wrl"));
  EXPECT_TRUE(browser.set(named(browser.world(), "I"), "set_fraction", .25f));
  EXPECT_EQ((field<SFFloat>(named(browser.world(), "S"), "index")), 1.25f);
  bool changed = false;
  for (const FieldChange& one : browser.takeChanges())
    changed |= one.node && one.node->defName == "S" && one.field->name == "index";
  EXPECT_TRUE(changed);
}

TEST(ShaderFields, EditsChangeThemInPlace) {
  const std::string before = header + "ORTBackground { shader DEF S ORTShader { # glass\n"
                                      "  exposedField SFFloat index 1.50 # crown\n"
                                      "  field SFColor tint 1 1 .50\n"
                                      "  exposedField SFNode texture NULL\n} }\n";
  const Folder folder;
  const auto world = loadWorld(folder.write("w.wrl", before));
  Editor editor(*world);
  Node& shader = named(*world, "S");
  editor.set(shader, "index", 1.75f);
  editor.set(shader, "tint", Color{1, 0, .5f});
  EXPECT_EQ(editor.text(), header + "ORTBackground { shader DEF S ORTShader { # glass\n"
                                    "  exposedField SFFloat index 1.75 # crown\n"
                                    "  field SFColor tint 1 0 .50\n"
                                    "  exposedField SFNode texture NULL\n} }\n");
  EXPECT_EQ((field<SFFloat>(shader, "index")), 1.75f);
  const NodeRef picture = editor.insert({&shader, "texture", 0}, "DEF T PixelTexture { }");
  editor.set(shader, "file", std::string("glass"));
  EXPECT_NE(editor.text().find("texture DEF T PixelTexture { }\n  file \"glass\"\n} }"),
            std::string::npos)
      << editor.text();
  editor.remove({&shader, "texture", 0});
  EXPECT_NE(editor.text().find("texture NULL\n"), std::string::npos) << editor.text();
  while (editor.undo()) {}
  EXPECT_EQ(editor.text(), before);
  EXPECT_EQ((field<SFFloat>(shader, "index")), 1.5f);
  EXPECT_THROW(editor.set(shader, "abbe", 30.f), EditError);
}

TEST(ShaderFields, DeclarationsThatCannotBe) {
  const auto said = [](const std::string& fields) {
    return messages(*parse("ORTBackground { shader DEF S ORTShader { name \"x\" " + fields +
                           " options \"1f a 1\" } }"));
  };
  EXPECT_NE(said("eventIn SFFloat index")
                .find("test.wrl:2:67: error: ORTShader declares its "
                      "parameters as field or exposedField, not as "
                      "eventIn: 'index' is left out"),
            std::string::npos)
      << said("eventIn SFFloat index");
  EXPECT_NE(said("eventOut SFFloat index").find("not as eventOut"), std::string::npos);
  EXPECT_NE(said("field SFFloat name 1").find("declared already"), std::string::npos);
  EXPECT_NE(said("field SFFloat a 1 field SFFloat a 2").find("declared already"),
            std::string::npos);
  EXPECT_NE(said("field SFNode picture Shape { }").find("expected texture"), std::string::npos);
  EXPECT_NE(said("field SFFlot index 1").find("SFFlot"), std::string::npos);
  EXPECT_NE(said("field SFFloat index \"a\"").find("error"), std::string::npos);
  // The reader goes on behind them.
  const auto world = parse("ORTBackground { shader DEF S ORTShader { eventIn SFFloat a "
                           "field SFFlot index 1 field SFFloat b 2 name \"x\" } }");
  EXPECT_EQ((field<SFString>(named(*world, "S"), "name")), "x");
  EXPECT_EQ((field<SFFloat>(named(*world, "S"), "b")), 2);
  // In X3D the words are others, and other nodes declare nothing.
  EXPECT_NE(messages(*loadWorldFromMemory("#X3D V3.3 utf8\nPROFILE Full\nORTBackground { shader "
                                          "ORTShader { inputOnly SFFloat a } }",
                                          "w.x3dv"))
                .find("as initializeOnly or inputOutput, not as inputOnly"),
            std::string::npos);
  EXPECT_NE(messages(*parse("ORTAppearance { field SFFloat a 1 }")), "");
}

TEST(ShaderFields, AShaderWithoutDeclarationsHasTheBuiltInType) {
  const auto world = parse("ORTBackground { shader DEF S ORTShader { } }\n"
                           "ORTBackground { shader DEF T ORTShader { field SFFloat a 1 } }");
  EXPECT_EQ(&named(*world, "S").type(), findNodeType("ORTShader"));
  EXPECT_EQ(findNodeType("ORTShader")->find("a"), nullptr);
  EXPECT_NE(nodeCast<nodes::ORTShader>(&named(*world, "T")), nullptr);
}

} // namespace
