// xvrml_versions.cpp: fields by the version of a node's file: names, access, ranges, defaults
// (docs/versions.md).
#include <gtest/gtest.h>

#include "nodes/registry.h"
#include "xvrml/nodes.h"
#include "xvrml/versions.h"
#include "xvrml/world.h"

namespace {

using namespace xvrml;

std::unique_ptr<World> load(const std::string& version, const std::string& text) {
  const bool x3d = version != "2.0";
  return loadWorldFromMemory((x3d ? "#X3D V" : "#VRML V") + version + " utf8\n" + text,
                             x3d ? "a.x3dv" : "a.wrl");
}

std::vector<std::string> messagesOf(const World& world) {
  std::vector<std::string> all;
  for (const Diagnostic& one : world.diagnostics.list())
    all.push_back(one.text().substr(0, one.text().find('\n')));
  return all;
}

std::string nameOf(const FieldInfo* field) { return field ? field->name : "none"; }

// ISO/IEC 19775-1 10.4.3, 23.4.2 and 23.4.3 call these otherwise than VRML97.
TEST(Versions, NamesAreThoseOfTheFile) {
  const auto x3d = load("3.3", "Switch { } Collision { } LOD { }");
  const Node &choice = *x3d->scope.roots[0], &collision = *x3d->scope.roots[1],
             &lod = *x3d->scope.roots[2];
  EXPECT_EQ(nameOf(findField(choice, "children")), "choice");
  EXPECT_EQ(nameOf(findEventIn(choice, "set_children")), "choice");
  EXPECT_EQ(nameOf(findEventOut(choice, "children_changed")), "choice");
  EXPECT_EQ(nameOf(findField(collision, "enabled")), "collide");
  EXPECT_EQ(nameOf(findField(lod, "children")), "level");
  EXPECT_EQ(nameOf(findEventOut(lod, "children_changed")), "level");
  EXPECT_EQ(nameOf(findEventOut(lod, "level_changed")), "activeLevel_changed");
  EXPECT_EQ(fieldName(choice, *choice.type().find("choice")), "children");
  EXPECT_EQ(fieldName(lod, *lod.type().find("activeLevel_changed")), "level_changed");

  const auto vrml = load("2.0", "Switch { } Collision { } LOD { }");
  EXPECT_EQ(findField(*vrml->scope.roots[0], "children"), nullptr);
  EXPECT_EQ(findField(*vrml->scope.roots[1], "enabled"), nullptr);
  EXPECT_EQ(nameOf(findEventOut(*vrml->scope.roots[2], "level_changed")), "level");
  EXPECT_EQ(fieldName(*vrml->scope.roots[0], *choice.type().find("choice")), "choice");
}

// A Layer's pickable is isPickable up to X3D 3.3 (ISO/IEC 19775-1:2013 35.4.1).
TEST(Versions, NamesOfX3dMayChange) {
  for (const auto& [version, name] : {std::pair("3.3", "isPickable"), {"4.0", "pickable"}}) {
    const auto world = load(version, "LayerSet { layers DEF L Layer { isPickable FALSE } }");
    EXPECT_EQ(world->diagnostics.errors(), 0u);
    const Node& layer = *world->scope.names.at("L");
    EXPECT_EQ(fieldName(layer, *layer.type().find("pickable")), name);
    const std::string text = writeWorld(*world, "", Encoding::x3dClassic);
    EXPECT_NE(text.find(std::string(" ") + name + " FALSE"), text.npos) << text;
  }
}

// A name that was mapped is mapped to itself, so several layers may ask.
TEST(Versions, OurNamesAreMappedToThemselves) {
  for (const char* version : {"2.0", "3.3", "4.0"})
    for (const NodeType* type : nodeTypes()) {
      if (type->name == "Script" || !type->create || type->standard == Standard::none) continue;
      const auto world = load(version, "Shape { geometry Box { } }");
      const NodeRef node(type->create(*type));
      node->source = world->scope.roots[0]->source;
      for (const FieldInfo& field : type->fields) {
        const std::string name(fieldName(*node, field));
        const std::string own(ownName(*node, name));
        EXPECT_EQ(own, field.name) << type->name;
        EXPECT_EQ(ownName(*node, own), own) << type->name;
      }
    }
}

// 23.3.1 and 7.4.7: [in,out] since X3D 3.0.
TEST(Versions, FieldsTakeEventsSinceTheVersionThatSaysSo) {
  const std::string routes = "DEF A WorldInfo { } DEF B WorldInfo { }\n"
                             "ROUTE A.title_changed TO B.set_title\nROUTE A.info TO B.info";
  EXPECT_EQ(messagesOf(*load("3.0", routes)), std::vector<std::string>());
  EXPECT_EQ(load("2.0", routes)->diagnostics.errors(), 4u);
  const std::string proto =
      "PROTO V [ inputOutput SFString d \"\" ] { Viewpoint { description IS d } }\nV { }";
  EXPECT_EQ(messagesOf(*load("3.3", proto)), std::vector<std::string>());
  std::string old = proto;
  old.replace(old.find("inputOutput"), 11, "exposedField");
  EXPECT_EQ(messagesOf(*load("2.0", old)),
            std::vector<std::string>{
                "a.wrl:2:69: warning: field 'description' of Viewpoint cannot be exposedField 'd' "
                "of the interface (4.8.2): it takes the value of the instance, but no events"});
  // ISO/IEC 19775-1:2023 13.3.2, 13.3.3, 15.4.1
  const std::string parts = "Shape { geometry DEF C Cone { } } DEF S BooleanFilter { }\n"
                            "ROUTE S.inputTrue TO C.set_bottom";
  EXPECT_EQ(messagesOf(*load("4.0", parts)), std::vector<std::string>());
  EXPECT_EQ(load("3.3", parts)->diagnostics.errors(), 1u);
}

// ISO/IEC 19775-1:2023 17.4 and 10.4.4.
TEST(Versions, RangesAreThoseOfTheFile) {
  const std::string text = "DEF L PointLight { intensity 5 } DEF T Transform { scale -1 1 1 }";
  const auto four = load("4.0", text);
  EXPECT_EQ(messagesOf(*four), std::vector<std::string>());
  EXPECT_EQ(nodeCast<nodes::PointLight>(four->scope.roots[0])->intensity, 5);
  EXPECT_EQ(nodeCast<nodes::Transform>(four->scope.roots[1])->scale, Vec3f(-1, 1, 1));
  const FieldInfo& intensity = *four->scope.roots[0]->type().find("intensity");
  EXPECT_TRUE(inRange(*four->scope.roots[0], intensity, SFFloat(9)));
  EXPECT_FALSE(inRange(*four->scope.roots[0], intensity, SFFloat(-1)));
  const auto three = load("3.3", text);
  EXPECT_EQ(three->diagnostics.warnings(), 2u);
  EXPECT_EQ(nodeCast<nodes::PointLight>(three->scope.roots[0])->intensity, 1);
  EXPECT_FALSE(inRange(*three->scope.roots[0], intensity, SFFloat(9)));
}

// The angles of a SpotLight: 6.45 of VRML97; ISO/IEC 19775-1:2013 17.4.3; :2023 17.4.4.
TEST(Versions, DefaultsAreThoseOfTheFile) {
  struct Row {
    const char* version;
    float beamWidth, cutOffAngle;
  };
  for (const Row& row : {Row{"2.0", 1.570796f, 0.785398f}, Row{"3.2", 1.570796f, 0.785398f},
                         Row{"3.3", 0.7853982f, 1.5707963f}, Row{"4.0", 0.5890486f, 1.5707963f}}) {
    const auto world = load(row.version, "SpotLight { }");
    const auto& light = *nodeCast<nodes::SpotLight>(world->scope.roots[0]);
    EXPECT_FLOAT_EQ(light.beamWidth, row.beamWidth) << row.version;
    EXPECT_FLOAT_EQ(light.cutOffAngle, row.cutOffAngle) << row.version;
    // A written file has the angles where its version has other ones.
    for (const Encoding encoding : {Encoding::vrml97, Encoding::x3dClassic, Encoding::x3dXml}) {
      const std::string text = writeWorld(*world, "", encoding);
      const auto again = loadWorldFromMemory(text, "b");
      const auto& same = *nodeCast<nodes::SpotLight>(again->scope.roots[0]);
      EXPECT_EQ(same.beamWidth, light.beamWidth) << text;
      EXPECT_EQ(same.cutOffAngle, light.cutOffAngle) << text;
    }
  }
  EXPECT_EQ(
      nodeCast<nodes::NavigationInfo>(load("3.0", "NavigationInfo { }")->scope.roots[0])->type,
      (MFString{"EXAMINE", "ANY"}));
}

TEST(Versions, EveryRevisionIsOfAFieldThatIsThere) {
  int last = -1;
  for (const FieldRevision& one : nodes::revisions()) {
    EXPECT_GE(one.type, last);
    last = one.type;
    const NodeType& type = *nodeTypes()[size_t(one.type)];
    const FieldInfo* const field = type.find(one.field);
    ASSERT_NE(field, nullptr) << type.name << '.' << one.field;
    EXPECT_EQ(one.defaultValue.index(), size_t(field->type)) << type.name << '.' << one.field;
    EXPECT_FALSE(one.clause.empty());
  }
  EXPECT_GE(last, 0);
}

} // namespace
