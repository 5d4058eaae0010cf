// x3d_sai.cpp: what programs of X3D ask of scenes, nodes and matrices (ISO/IEC 19777-1): each row
// is a program of its own, in this process; some run in a process of their own, too.
#include "conformance/events/ecmascript_world.h"
#include "script/abstract_types.h"

namespace xvrml {
namespace {

const std::string header = "#X3D V3.3 utf8\nPROFILE Immersive\n";
const std::string rest = "PROTO Ball [ inputOutput SFFloat size 2 ] { Transform { } }\n"
                         "DEF T Transform { translation 1 2 3 children DEF Leaf Group { } }\n"
                         "DEF P Ball { size 5 }";

class EcmaSaiRows : public EcmaRows {};
class EcmaSai : public EcmaScript {};

std::string world(const std::string& program) {
  return header +
         EcmaWorld::script("inputOnly SFBool go directOutput TRUE",
                           "var s = Browser.currentScene; function go() { " + program + " }", rest);
}

TEST_P(EcmaSaiRows, Prints) {
  EcmaWorld r(world(GetParam().program));
  r.set("S", "go", true);
  EXPECT_EQ(r.takeOutput(), GetParam().printed);
}

constexpr EcmaRow rows[] = {
    {"NodeTellsTypeAndName", "",
     "var t = s.getNamedNode('T'); print(t.getNodeTypeName(), t.getNodeName());"
     "print(s.getNamedNode('P').getNodeTypeName(), new SFNode('Box { }').getNodeName() === '');",
     "Transform T\nBall true"},
    {"NodeTellsAbstractTypes", "",
     "var k = s.getNamedNode('T').getNodeType(); print(k[0] == X3DConstants.X3DNode,"
     "k.indexOf(X3DConstants.X3DGroupingNode) > 0, k.indexOf(X3DConstants.X3DLightNode));"
     "print(s.getNamedNode('P').getNodeType().indexOf(X3DConstants.X3DPrototypeInstance));"
     "print(new SFNode('Box { }').getNodeType().indexOf(X3DConstants.X3DGeometryNode) > 0);",
     "true true -1\n1\ntrue"},
    {"NodeTellsItsFields", "",
     "var d = s.getNamedNode('P').getFieldDefinitions().filter("
     "function(f) { return f.name == 'size'; })[0];"
     "print(d.accessType == X3DConstants.inputOutput, d.dataType == X3DConstants.SFFloat);",
     "true true"},
    {"ConstantsDiffer", "",
     "var n = 0, seen = {}; for (var k in X3DConstants) if (/^X3D/.test(k)) {"
     "n++; seen[X3DConstants[k]] = 1; } print(n > 60, Object.keys(seen).length == n);"
     "print(X3DConstants.INITIALIZED_EVENT !== undefined, X3DConstants.MFVec4f !== undefined,"
     "X3DConstants === X3DConstants); X3DConstants.SFFloat = 99; print(X3DConstants.SFFloat != "
     "99);",
     "true true\ntrue true true\ntrue"},
    {"CreatesNodes", "",
     "var n = s.createNode('Transform'); n.translation = new SFVec3f(4, 5, 6);"
     "s.getNamedNode('T').children = new MFNode(n);"
     "print(n.getNodeTypeName(), n.translation.y);"
     "['Nothing', 'Group { } Group', ''].forEach(function(name) {"
     "try { s.createNode(name); print('made'); } catch (e) { print('refused'); } });",
     "Transform 5\nrefused\nrefused\nrefused\n1: 'Nothing' is not a known node type"},
    {"TextsHaveTheVersionOfTheirHeader", "",
     "['#X3D V3.2', '#X3D V4.0', '#VRML V2.0'].forEach(function(head) {"
     "print(Browser.createX3DFromString(head + ' utf8\\nSpotLight { }').rootNodes[0].beamWidth > "
     "1); });",
     "true\nfalse\ntrue"},
    {"CreatesInstancesOfPrototypes", "",
     "var p = s.createProto('Ball'); print(p.getNodeTypeName(), p.size); p.size = 7;"
     "print(s.createProto('Ball').size, s.getNamedNode('P').size);"
     "try { s.createProto('Cube'); } catch (e) { print(e.message); }",
     "Ball 2\n2 5\ncreateProto: the scene has no prototype 'Cube'"},
    {"StringGivesAScene", "",
     "var made = Browser.createX3DFromString('DEF A Transform { children DEF B Group { } } Group { "
     "}');"
     "print(made.rootNodes.length, made.rootNodes[0].getNodeName(), made.encoding);"
     "print(made.getNamedNode('B').getNodeTypeName(), made.specificationVersion);"
     "try { made.getNamedNode('T'); } catch (e) { print(e.message); }"
     "var t = s.getNamedNode('T'); t.children = made; print(t.children.length);",
     "2 A SCRIPTED\nGroup 3.3\ngetNamedNode: the scene has no node 'T'\n2"},
    {"SceneTellsItsFacts", "",
     "print(s.specificationVersion, s.encoding, s.worldURL == Browser.getWorldURL());",
     "3.3 VRML true"},
    {"NodesAndScenesAsText", "",
     "print(s.getNamedNode('Leaf').toXMLString(), s.getNamedNode('Leaf').toVRMLString());"
     "print(/^<\\?xml/.test(s.toXMLString()), /^#X3D V3.3 utf8/.test(s.toVRMLString()));"
     "print(Browser.createX3DFromString('DEF A Group { }').rootNodes[0].toVRMLString());",
     "<Group DEF='Leaf'/> DEF Leaf Group { }\ntrue true\nDEF A Group { }"},
    {"MatricesOfSpace", "",
     "var m = new SFMatrix4f(); m.setTransform(new SFVec3f(1, 2, 3));"
     "print(m.multVecMatrix(new SFVec3f(1, 0, 0)), m[12], m[15]);"
     "print(m.inverse().multVecMatrix(new SFVec3f(1, 2, 3)), m.transpose()[3]);"
     "var t = new SFVec3f(), r = new SFRotation(), z = new SFVec3f();"
     "m.setTransform(new SFVec3f(1, 2, 3), new SFRotation(0, 1, 0, 1), new SFVec3f(2, 2, 2));"
     "m.getTransform(t, r, z); print(t, Math.round(r.angle * 1e4) / 1e4, Math.round(z.x * 1e4) / "
     "1e4);"
     "var d = new SFMatrix4d(); d.setTransform(new SFVec3d(1, 0, 0));"
     "print(d.multLeft(d).multVecMatrix(new SFVec3d(0, 0, 0)).x, d.multRight(m) instanceof "
     "SFMatrix4d);",
     "2 2 3 1 1\n0 0 0 1\n1 2 3 1 2\n2 true"},
    {"MatricesOfThePlane", "",
     "var m = new SFMatrix3f(); m.setTransform(new SFVec2f(1, 2), Math.PI / 2, new SFVec2f(3, 3));"
     "var v = m.multVecMatrix(new SFVec2f(1, 0)); print(Math.round(v.x), Math.round(v.y));"
     "print(m[6], m[7], m[8]); var t = new SFVec2f(), r = new SFRotation(), z = new SFVec2f();"
     "m.getTransform(t, r, z); print(t, Math.round(r.angle * 1e4) / 1e4, Math.round(z.y * 1e4) / "
     "1e4);"
     "try { m.multLeft(new SFMatrix4f()); } catch (e) { print(e.message); }",
     "1 5\n1 2 1\n1 2 1.5708 3\nexpected SFMatrix3f, got SFMatrix4f"},
    {"MatricesOfFieldsChangeThem", "",
     "var n = new SFNode('Script { inputOutput SFMatrix4f m 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1 }');"
     "n.m.setTransform(new SFVec3f(7, 8, 9)); print(n.m[12], n.m[13], n.m[14]);",
     "7 8 9"}};
INSTANTIATE_TEST_SUITE_P(All, EcmaSaiRows, testing::ValuesIn(rows), rowName);

TEST_F(EcmaSai, WorksInAProcess) {
  BrowserOptions options;
  options.scriptPath = XVRML_SCRIPTS;
  options.scriptIsolation = BrowserOptions::Isolation::always;
  Scripted r(header +
                 EcmaWorld::script(
                     "inputOnly SFBool go outputOnly SFString out",
                     "function go() { var s = Browser.currentScene; var made = "
                     "Browser.createX3DFromString('DEF B Group { }');"
                     "out = [s.createProto('Ball').size, s.createNode('Box').getNodeTypeName(),"
                     "made.getNamedNode('B').toVRMLString(), s.encoding,"
                     "s.getNamedNode('T').getNodeType().length > 2].join(' '); }",
                     rest),
             options);
  r.set("S", "go", true);
  EXPECT_EQ(r.get("S", "out"), "2 Box DEF B Group { } VRML true");
  EXPECT_EQ(r.messages(), Log());
}

// prepareEvents is called before the events of each time, and never for programs without it.
TEST_F(EcmaSai, PreparesEvents) {
  EcmaWorld r(header + EcmaWorld::script("outputOnly SFInt32 frame",
                                         "var n = 0; function prepareEvents() { frame = ++n; }"));
  r.log("S", "frame");
  r.browser.tick(1);
  r.browser.tick(2);
  EXPECT_EQ(r.take(), (Log{"1 S.frame 1", "2 S.frame 2"}));
}

// A program that is newer than the engine's language says so, and where.
TEST_F(EcmaSai, NewerProgramsSaySo) {
  if (runsEs2020()) GTEST_SKIP() << "the engine runs them (ecmascript_2020.cpp)";
  struct Row {
    const char *program, *message; // the program begins in line 3
  };
  constexpr Row newer[] = {{"var a = 1;\nlet b = a;", "4: Script S: SyntaxError: 'let'"},
                           {"\n\nvar f = x => x + 1;", "5: Script S: SyntaxError: '=>'"},
                           {"var t = `a`;", "3: Script S: SyntaxError: '`'"},
                           {"var t = '';\nt = `a => ${t} b`;", "4: Script S: SyntaxError: '`'"},
                           {"class A { }", "3: Script S: SyntaxError: 'class'"},
                           {"for (var x of [1]) { }", "3: Script S: SyntaxError: 'of'"},
                           {"f(...[1]);", "3: Script S: SyntaxError: '...'"}};
  for (const Row& row : newer) {
    EcmaWorld r(header + EcmaWorld::script("inputOnly SFBool go", row.program));
    const Log messages = r.messages();
    ASSERT_FALSE(messages.empty()) << row.program;
    EXPECT_EQ(messages[0].find(std::string(row.message) + " is newer than ECMAScript 5.1"), 0u)
        << messages[0];
  }
  // A program that does not compile for another reason keeps its own message; words may be names.
  EcmaWorld r(header + EcmaWorld::script("inputOnly SFBool go", "var let_ = { of: 1 }; var ("));
  const Log messages = r.messages();
  ASSERT_FALSE(messages.empty());
  EXPECT_EQ(messages[0].find("newer"), std::string::npos) << messages[0];
}

// Every role of the .node files is an abstract type of X3D, or one that X3D does not have.
TEST(AbstractTypes, RolesAreKnown) {
  const std::vector<std::string_view> own = {
      "surfaced",    "repeating",       "declaring",       "lines",     "sided",
      "faces",       "exact",           "parent",          "flat",      "placedLight",
      "selecting",   "indexedGeometry", "shader",          "slotted",   "splineInterpolator",
      "listing",     "placing",         "placedViewpoint", "geoOrigin", "contour",
      "texturePatch"};
  for (const NodeType* type : nodeTypes())
    for (const std::string& role : type->abstract) {
      const bool known = !abstractTypeOfRole(role).empty() ||
                         std::find(own.begin(), own.end(), role) != own.end() ||
                         role.ends_with("Property");
      EXPECT_TRUE(known) << type->name << ": " << role;
    }
}

} // namespace
} // namespace xvrml
