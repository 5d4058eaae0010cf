// xvrml_nodes_test.cpp: the 54 nodes of ISO/IEC 14772-1:1997 clause 6 and those of OpenRT, against
// lists typed from the standard. Nodes that X3D adds are in xvrml_x3d_nodes.cpp.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <xvrml/nodes.h>
#include <xvrml/numbers.h>

namespace xvrml {
namespace {

// The clause, the node, and how many eventIns, exposedFields, fields and eventOuts its interface
// has.
struct Interface {
  const char* clause;
  const char* name;
  int eventIns, exposedFields, fields, eventOuts;
};
constexpr Interface interfaces[] = {
    {"6.2", "Anchor", 2, 4, 2, 0},
    {"6.3", "Appearance", 0, 3, 0, 0},
    {"6.4", "AudioClip", 0, 6, 0, 2},
    {"6.5", "Background", 1, 10, 0, 1},
    {"6.6", "Billboard", 2, 2, 2, 0},
    {"6.7", "Box", 0, 0, 1, 0},
    {"6.8", "Collision", 2, 2, 3, 1},
    {"6.9", "Color", 0, 1, 0, 0},
    {"6.10", "ColorInterpolator", 1, 2, 0, 1},
    {"6.11", "Cone", 0, 0, 4, 0},
    {"6.12", "Coordinate", 0, 1, 0, 0},
    {"6.13", "CoordinateInterpolator", 1, 2, 0, 1},
    {"6.14", "Cylinder", 0, 0, 5, 0},
    {"6.15", "CylinderSensor", 0, 6, 0, 3},
    {"6.16", "DirectionalLight", 0, 5, 0, 0},
    {"6.17", "ElevationGrid", 1, 3, 10, 0},
    {"6.18", "Extrusion", 4, 0, 10, 0},
    {"6.19", "Fog", 1, 3, 0, 1},
    {"6.20", "FontStyle", 0, 0, 9, 0},
    {"6.21", "Group", 2, 1, 2, 0},
    {"6.22", "ImageTexture", 0, 1, 2, 0},
    {"6.23", "IndexedFaceSet", 4, 4, 10, 0},
    {"6.24", "IndexedLineSet", 2, 2, 3, 0},
    {"6.25", "Inline", 0, 1, 2, 0},
    {"6.26", "LOD", 0, 1, 2, 0},
    {"6.27", "Material", 0, 6, 0, 0},
    {"6.28", "MovieTexture", 0, 5, 2, 2},
    {"6.29", "NavigationInfo", 1, 5, 0, 1},
    {"6.30", "Normal", 0, 1, 0, 0},
    {"6.31", "NormalInterpolator", 1, 2, 0, 1},
    {"6.32", "OrientationInterpolator", 1, 2, 0, 1},
    {"6.33", "PixelTexture", 0, 1, 2, 0},
    {"6.34", "PlaneSensor", 0, 5, 0, 3},
    {"6.35", "PointLight", 0, 7, 0, 0},
    {"6.36", "PointSet", 0, 2, 0, 0},
    {"6.37", "PositionInterpolator", 1, 2, 0, 1},
    {"6.38", "ProximitySensor", 0, 3, 0, 5},
    {"6.39", "ScalarInterpolator", 1, 2, 0, 1},
    {"6.40", "Script", 0, 1, 2, 0},
    {"6.41", "Shape", 0, 2, 0, 0},
    {"6.42", "Sound", 0, 9, 1, 0},
    {"6.43", "Sphere", 0, 0, 1, 0},
    {"6.44", "SphereSensor", 0, 3, 0, 3},
    {"6.45", "SpotLight", 0, 10, 0, 0},
    {"6.46", "Switch", 0, 2, 0, 0},
    {"6.47", "Text", 0, 4, 0, 0},
    {"6.48", "TextureCoordinate", 0, 1, 0, 0},
    {"6.49", "TextureTransform", 0, 4, 0, 0},
    {"6.50", "TimeSensor", 0, 5, 0, 4},
    {"6.51", "TouchSensor", 0, 1, 0, 6},
    {"6.52", "Transform", 2, 6, 2, 0},
    {"6.53", "Viewpoint", 1, 4, 1, 2},
    {"6.54", "VisibilitySensor", 0, 3, 0, 3},
    {"6.55", "WorldInfo", 0, 0, 2, 0},
    {"", "ORTAppearance", 0, 4, 0, 0},
    {"", "ORTAsphere", 0, 0, 7, 0},
    {"", "ORTBackground", 1, 1, 0, 1},
    {"", "ORTInstance", 2, 1, 2, 0},
    {"", "ORTLight", 0, 2, 0, 0},
    {"", "ORTQuadric", 0, 0, 5, 0},
    {"", "ORTSensor", 0, 7, 1, 0},
    {"", "ORTShader", 0, 3, 0, 0},
    {"", "ORTStatic", 2, 1, 2, 0},
    {"", "ORTViewpoint", 1, 5, 1, 2},
};

int count(const NodeType& type, Access access) {
  int number = 0;
  for (const FieldInfo& field : type.fields)
    number += (field.exposedSince ? Access::field : field.access) == access && !field.ofX3d &&
              field.name != "metadata";
  return number;
}

bool stored(const FieldInfo& field) {
  return field.access == Access::field || field.access == Access::exposedField;
}

TEST(Nodes, InterfacesAreThoseOfTheStandard) {
  EXPECT_EQ(std::count_if(nodeTypes().begin(), nodeTypes().end(),
                          [](const NodeType* type) { return type->standard != Standard::x3d; }),
            std::ssize(interfaces));
  for (const Interface& expected : interfaces) {
    SCOPED_TRACE(expected.name);
    const NodeType* type = findNodeType(expected.name);
    ASSERT_NE(type, nullptr);
    EXPECT_EQ(type->clause, expected.clause);
    EXPECT_EQ(type->standard, type->clause.empty() ? Standard::none : Standard::vrml97);
    EXPECT_EQ(count(*type, Access::eventIn), expected.eventIns);
    EXPECT_EQ(count(*type, Access::exposedField), expected.exposedFields);
    EXPECT_EQ(count(*type, Access::field), expected.fields);
    EXPECT_EQ(count(*type, Access::eventOut), expected.eventOuts);
  }
}

TEST(Nodes, AreNumberedInOrderAndDescribed) {
  int index = 0;
  std::set<std::string> names;
  for (const NodeType* type : nodeTypes()) {
    SCOPED_TRACE(type->name);
    EXPECT_EQ(type->index, index++);
    EXPECT_EQ(findNodeType(type->name), type);
    EXPECT_TRUE(names.insert(type->name).second);
    EXPECT_FALSE(type->text.empty());
    EXPECT_FALSE(type->abstract.empty());
    EXPECT_FALSE(type->component.empty());
    for (const FieldInfo& field : type->fields) {
      SCOPED_TRACE(field.name);
      EXPECT_FALSE(field.text.empty());
      EXPECT_EQ(type->find(field.name), &field);
      const bool holdsNodes = field.type == FieldType::SFNode || field.type == FieldType::MFNode;
      EXPECT_EQ(holdsNodes, !field.nodeTypes.empty());
    }
  }
  EXPECT_EQ(findNodeType("box"), nullptr);
  EXPECT_EQ(findNodeType(""), nullptr);
}

// Programs have nodes::NAME::typeIndex compiled in. The fingerprint (FNV-1a) is that of the names
// in the order of their numbers when the numbers were fixed; it never changes. New nodes come
// after.
TEST(Nodes, NumbersNeverChange) {
  constexpr size_t fixedNodes = 61;
  ASSERT_GE(nodeTypes().size(), fixedNodes);
  uint64_t fingerprint = 0xcbf29ce484222325;
  for (const NodeType* type : nodeTypes().first(fixedNodes))
    for (const char c : type->name + '\n')
      fingerprint = (fingerprint ^ static_cast<unsigned char>(c)) * 0x100000001b3;
  EXPECT_EQ(fingerprint, 0x9c2532e7d78c72b3u)
      << "a line of libxvrml/nodes/numbers.txt has changed; older programs would cast wrongly";
  static_assert(nodes::Appearance::typeIndex == 0);
  static_assert(nodes::Box::typeIndex == 14);
  static_assert(nodes::ORTBackground::typeIndex == 44);
  static_assert(nodes::Switch::typeIndex == 60);
}

Value defaultOf(const char* node, const char* field) {
  const NodeType* type = findNodeType(node);
  const FieldInfo* info = type ? type->find(field) : nullptr;
  EXPECT_NE(info, nullptr) << node << '.' << field;
  return info ? info->defaultValue : Value();
}

struct Default {
  const char* node;
  const char* field;
  Value value;
};

TEST(Nodes, DefaultsAreThoseOfTheStandard) {
  const MFVec2f square = {{1, 1}, {1, -1}, {-1, -1}, {-1, 1}, {1, 1}};
  const Default defaults[] = {
      {"Anchor", "bboxSize", SFVec3f{-1, -1, -1}},
      {"AudioClip", "pitch", 1.0f},
      {"Background", "skyColor", MFColor{{0, 0, 0}}},
      {"Background", "skyAngle", MFFloat{}},
      {"Billboard", "axisOfRotation", SFVec3f{0, 1, 0}},
      {"Box", "size", SFVec3f{2, 2, 2}},
      {"Collision", "collide", true},
      {"Collision", "proxy", NodeRef()},
      {"Cone", "bottomRadius", 1.0f},
      {"Cone", "height", 2.0f},
      {"Cylinder", "radius", 1.0f},
      {"Cylinder", "top", true},
      {"CylinderSensor", "diskAngle", 0.262f},
      {"CylinderSensor", "maxAngle", -1.0f},
      {"CylinderSensor", "autoOffset", true},
      {"DirectionalLight", "ambientIntensity", 0.0f},
      {"DirectionalLight", "direction", SFVec3f{0, 0, -1}},
      {"DirectionalLight", "intensity", 1.0f},
      {"ElevationGrid", "xDimension", int32_t(0)},
      {"ElevationGrid", "zSpacing", 1.0f},
      {"ElevationGrid", "creaseAngle", 0.0f},
      {"Extrusion", "crossSection", square},
      {"Extrusion", "orientation", MFRotation{{0, 0, 1, 0}}},
      {"Extrusion", "scale", MFVec2f{{1, 1}}},
      {"Extrusion", "spine", MFVec3f{{0, 0, 0}, {0, 1, 0}}},
      {"Extrusion", "beginCap", true},
      {"Fog", "fogType", std::string("LINEAR")},
      {"Fog", "visibilityRange", 0.0f},
      {"FontStyle", "family", MFString{"SERIF"}},
      {"FontStyle", "justify", MFString{"BEGIN"}},
      {"FontStyle", "style", std::string("PLAIN")},
      {"FontStyle", "topToBottom", true},
      {"ImageTexture", "repeatS", true},
      {"IndexedFaceSet", "ccw", true},
      {"IndexedFaceSet", "convex", true},
      {"IndexedFaceSet", "solid", true},
      {"IndexedFaceSet", "colorPerVertex", true},
      {"IndexedFaceSet", "creaseAngle", 0.0f},
      {"IndexedFaceSet", "coordIndex", MFInt32{}},
      {"LOD", "range", MFFloat{}},
      {"Material", "ambientIntensity", 0.2f},
      {"Material", "diffuseColor", SFColor{0.8f, 0.8f, 0.8f}},
      {"Material", "emissiveColor", SFColor{0, 0, 0}},
      {"Material", "shininess", 0.2f},
      {"Material", "specularColor", SFColor{0, 0, 0}},
      {"Material", "transparency", 0.0f},
      {"MovieTexture", "speed", 1.0f},
      {"MovieTexture", "stopTime", 0.0},
      {"NavigationInfo", "avatarSize", MFFloat{0.25f, 1.6f, 0.75f}},
      {"NavigationInfo", "type", MFString{"WALK", "ANY"}},
      {"NavigationInfo", "headlight", true},
      {"PixelTexture", "image", SFImage{}},
      {"PlaneSensor", "maxPosition", SFVec2f{-1, -1}},
      {"PointLight", "attenuation", SFVec3f{1, 0, 0}},
      {"PointLight", "radius", 100.0f},
      {"Script", "directOutput", false},
      {"Shape", "geometry", NodeRef()},
      {"Sound", "direction", SFVec3f{0, 0, 1}},
      {"Sound", "maxBack", 10.0f},
      {"Sound", "spatialize", true},
      {"Sphere", "radius", 1.0f},
      {"SphereSensor", "offset", SFRotation{0, 1, 0, 0}},
      {"SpotLight", "beamWidth", 1.570796f},
      {"SpotLight", "cutOffAngle", 0.785398f},
      {"Switch", "whichChoice", int32_t(-1)},
      {"Text", "maxExtent", 0.0f},
      {"TextureTransform", "scale", SFVec2f{1, 1}},
      {"TimeSensor", "cycleInterval", 1.0},
      {"Transform", "scale", SFVec3f{1, 1, 1}},
      {"Transform", "rotation", SFRotation{0, 0, 1, 0}},
      {"Viewpoint", "fieldOfView", 0.785398f},
      {"Viewpoint", "position", SFVec3f{0, 0, 10}},
      {"Viewpoint", "jump", true},
      {"WorldInfo", "title", std::string()},
      {"ORTAsphere", "conic", 0.0f},
      {"ORTAsphere", "semiAperture", 1.0f},
      {"ORTAsphere", "terms", MFFloat{}},
      {"ORTQuadric", "coefficients", MFFloat{1, 1, 1, 0, 0, 0, 0, 0, 0, -1}},
      {"ORTQuadric", "low", SFVec3f{-1, -1, -1}},
      {"ORTShader", "options", MFString{}},
  };
  for (const Default& expected : defaults)
    EXPECT_TRUE(defaultOf(expected.node, expected.field) == expected.value)
        << expected.node << '.' << expected.field;
}

TEST(Nodes, DefaultsAreInRangeAndInNewNodes) {
  for (const NodeType* type : nodeTypes()) {
    const NodeRef node(type->create(*type));
    EXPECT_EQ(&node->type(), type);
    for (const FieldInfo& field : type->fields) {
      if (!stored(field)) continue;
      SCOPED_TRACE(type->name + '.' + field.name);
      EXPECT_EQ(field.defaultValue.index(), size_t(field.type));
      EXPECT_TRUE(node->get(field) == field.defaultValue);
      EXPECT_TRUE(inRange(field, field.defaultValue));
    }
  }
}

const FieldRange& rangeOf(const char* node, const char* field) {
  return findNodeType(node)->find(field)->range;
}

TEST(Nodes, RangesAreThoseOfTheStandard) {
  const FieldRange& size = rangeOf("Box", "size"); // (0,inf)
  EXPECT_TRUE(size.minimum == 0 && size.minimumOpen && std::isinf(size.maximum) &&
              size.maximumOpen);
  const FieldRange& colour = rangeOf("Material", "diffuseColor"); // [0,1]
  EXPECT_TRUE(colour.minimum == 0 && !colour.minimumOpen && colour.maximum == 1 &&
              !colour.maximumOpen);
  const FieldRange& angle = rangeOf("SpotLight", "cutOffAngle"); // (0,pi/2]
  EXPECT_TRUE(angle.minimum == 0 && angle.minimumOpen && !angle.maximumOpen);
  EXPECT_DOUBLE_EQ(angle.maximum, 1.5707963267948966);
  const FieldRange& view = rangeOf("Viewpoint", "fieldOfView"); // (0,pi)
  EXPECT_TRUE(view.minimumOpen && view.maximumOpen);
  const FieldRange& index = rangeOf("IndexedFaceSet", "coordIndex"); // [-1,inf)
  EXPECT_TRUE(index.minimum == -1 && !index.minimumOpen);
  const FieldRange& bounds = rangeOf("Group", "bboxSize"); // (0,inf) or -1
  EXPECT_TRUE(bounds.minimum == 0 && bounds.minimumOpen && bounds.also == -1);
  EXPECT_FALSE(rangeOf("Transform", "translation").bounded());
}

TEST(Nodes, RolesAreThoseOfTheStandard) {
  std::map<std::string, int> roles;
  for (const NodeType* type : nodeTypes())
    if (type->standard != Standard::x3d)
      for (const std::string& role : type->abstract) ++roles[role];
  EXPECT_EQ(roles["child"],
            32 + 6); // 4.6.5; ORTStatic, ORTInstance, ORTLight, ORTSensor, ORTViewpoint,
                     // ORTBackground
  EXPECT_EQ(roles["grouping"], 8 + 2);
  EXPECT_EQ(roles["geometry"], 10 + 2);
  EXPECT_EQ(roles["texture"], 3);
  EXPECT_EQ(roles["light"], 3);
  EXPECT_EQ(roles["sensor"], 7);
  EXPECT_EQ(roles["interpolator"], 6);
  EXPECT_EQ(roles["bindable"], 4 + 2);
  EXPECT_EQ(roles["audio"], 2);
  EXPECT_EQ(roles["appearance"], 2);
  EXPECT_TRUE(findNodeType("Transform")->is("child"));
  EXPECT_FALSE(findNodeType("Box")->is("child"));
  EXPECT_EQ(findNodeType("Sound")->find("source")->nodeTypes, "audio");
}

// Makes values that differ from every default and from seed to seed.
struct Maker {
  int seed;
  float number(int i = 0) const { return 100.5f + float(seed) + 0.125f * float(i); }
  void operator()(SFBool& v) const { v = seed % 2 == 0; }
  template <Numeric T> void operator()(T& v) const {
    for (int i = 0; i < numberCount<T>; ++i) numbersOf(v)[i] = number(i);
  }
  void operator()(SFImage& v) const { v = {2, 1, 1, {uint8_t(seed), 7}}; }
  void operator()(SFInt32& v) const { v = 1000 + seed; }
  void operator()(SFNode& v) const { v = NodeRef(new nodes::Group); }
  void operator()(SFRotation& v) const { // the axis has length 1
    v = {std::cos(float(seed)), 0, std::sin(float(seed)), number(3)};
  }
  void operator()(SFString& v) const {
    v = "a string too long for a short one " + std::to_string(seed);
  }
  template <class T> void operator()(std::vector<T>& v) const {
    for (int i = 0; i < 2; ++i) {
      T value{};
      (*this)(value);
      v.push_back(value);
    }
  }
};

// Writes all fields of a node, then reads them all: overlapping or misplaced storage would show.
TEST(Nodes, EveryFieldKeepsItsValue) {
  for (const NodeType* type : nodeTypes()) {
    const NodeRef node(type->create(*type));
    std::vector<Value> written;
    for (const FieldInfo& field : type->fields) {
      Value value = defaultValue(field.type);
      std::visit(Maker{int(written.size())}, value);
      EXPECT_EQ(node->set(field, value), stored(field)) << type->name << '.' << field.name;
      written.push_back(value);
    }
    for (size_t i = 0; i < written.size(); ++i) {
      const FieldInfo& field = type->fields[i];
      if (!stored(field)) continue;
      EXPECT_TRUE(node->get(field) == written[i]) << type->name << '.' << field.name;
    }
  }
}

TEST(Nodes, AValueOfAnotherTypeIsRefused) {
  for (const NodeType* type : nodeTypes()) {
    const NodeRef node(type->create(*type));
    for (const FieldInfo& field : type->fields) {
      const auto other = FieldType((size_t(field.type) + 1) % fieldTypeCount);
      EXPECT_FALSE(node->set(field, defaultValue(other))) << type->name << '.' << field.name;
      if (!stored(field)) continue;
      EXPECT_TRUE(node->get(field) == field.defaultValue) << type->name << '.' << field.name;
    }
  }
}

size_t sizeOf(const FieldInfo& field) {
  return std::visit([](const auto& value) { return sizeof(value); }, defaultValue(field.type));
}

TEST(Nodes, StorageDoesNotOverlap) {
  constexpr size_t padding = alignof(Node); // a member may start in the tail padding of its base
  for (const NodeType* type : nodeTypes()) {
    size_t end = sizeof(Node) - padding, endOfRare = 0;
    for (const FieldInfo& field : type->fields) {
      if (!stored(field)) continue;
      if (field.rare) {
        EXPECT_GE(field.rareOffset, endOfRare) << type->name << '.' << field.name;
        endOfRare = field.rareOffset + sizeOf(field);
        continue;
      }
      EXPECT_GE(field.offset, end) << type->name << '.' << field.name;
      end = field.offset + sizeOf(field);
    }
    EXPECT_LT(end, 1024u) << type->name;
  }
}

TEST(Nodes, StructsAndTablesSpeakOfTheSameFields) {
  nodes::Material material;
  material.diffuseColor = {0.1f, 0.2f, 0.3f};
  EXPECT_TRUE(material.get(*material.type().find("diffuseColor")) ==
              Value(SFColor{0.1f, 0.2f, 0.3f}));
  nodes::NavigationInfo navigation; // its field `type` hides Node::type()
  EXPECT_EQ(static_cast<Node&>(navigation).type().name, "NavigationInfo");
  EXPECT_EQ(nodeCast<nodes::Material>(&material), &material);
  EXPECT_EQ(nodeCast<nodes::Material>(&navigation), nullptr);
  EXPECT_EQ(nodeCast<nodes::Material>(NodeRef()), nullptr);
}

TEST(Nodes, EventsAreFoundUnderAllTheirNames) {
  const NodeType& transform = *findNodeType("Transform");
  const FieldInfo* translation = transform.find("translation");
  EXPECT_EQ(transform.findEventIn("translation"), translation); // 4.7
  EXPECT_EQ(transform.findEventIn("set_translation"), translation);
  EXPECT_EQ(transform.findEventOut("translation"), translation);
  EXPECT_EQ(transform.findEventOut("translation_changed"), translation);
  EXPECT_EQ(transform.findEventIn("translation_changed"), nullptr);
  EXPECT_EQ(transform.findEventOut("set_translation"), nullptr);
  EXPECT_EQ(transform.findEventIn("addChildren"), transform.find("addChildren"));
  EXPECT_EQ(transform.findEventOut("addChildren"), nullptr);
  EXPECT_EQ(transform.findEventIn("bboxSize"), nullptr); // a field receives no events

  const NodeType& interpolator = *findNodeType("ScalarInterpolator");
  EXPECT_EQ(interpolator.findEventIn("fraction"), interpolator.find("set_fraction")); // 4.10.2
  EXPECT_EQ(interpolator.findEventOut("value"), interpolator.find("value_changed"));
  const NodeType& faces = *findNodeType("IndexedFaceSet");
  EXPECT_EQ(faces.findEventIn("set_coordIndex"), faces.find("set_coordIndex"));
  EXPECT_EQ(faces.findEventIn("coordIndex"),
            faces.find("set_coordIndex")); // not the field of that name
}

TEST(Nodes, AnEventInKnowsTheFieldThatItSets) {
  const auto setBy = [](std::string_view node, std::string_view in) {
    const NodeType& type = *findNodeType(node);
    const FieldInfo* field = type.fieldSetBy(*type.find(in));
    return field ? field->name : "";
  };
  EXPECT_EQ(setBy("IndexedFaceSet", "set_coordIndex"), "coordIndex");
  EXPECT_EQ(setBy("ElevationGrid", "set_height"), "height");
  EXPECT_EQ(setBy("Viewpoint", "set_bind"), "");    // there is no field of that name
  EXPECT_EQ(setBy("Transform", "translation"), ""); // an exposedField sets itself
}

} // namespace
} // namespace xvrml
