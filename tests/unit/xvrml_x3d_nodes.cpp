// xvrml_x3d_nodes.cpp: the nodes of ISO/IEC 19775-1 (X3D) and the fields that it adds to those of
// VRML97, against lists typed from the standard.
#include <gtest/gtest.h>

#include <algorithm>

#include <xvrml/nodes.h>

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
    {"10.4.2", "StaticGroup", 0, 0, 3, 0},
    {"12.4.6", "PhysicalMaterial", 0, 17, 0, 0},
    {"12.4.10", "UnlitMaterial", 0, 7, 0, 0},
    {"19.4.3", "CoordinateInterpolator2D", 1, 2, 0, 1},
    {"19.4.4", "EaseInEaseOut", 1, 2, 0, 1},
    {"19.4.8", "PositionInterpolator2D", 1, 2, 0, 1},
    {"19.4.10", "SplinePositionInterpolator", 1, 5, 0, 1},
    {"19.4.11", "SplinePositionInterpolator2D", 1, 5, 0, 1},
    {"19.4.12", "SplineScalarInterpolator", 1, 5, 0, 1},
    {"19.4.13", "SquadOrientationInterpolator", 1, 3, 0, 1},
    {"30.4.1", "BooleanFilter", 1, 0, 0, 3},
    {"30.4.2", "BooleanSequencer", 3, 2, 0, 1},
    {"30.4.3", "BooleanToggle", 1, 1, 0, 0},
    {"30.4.4", "BooleanTrigger", 1, 0, 0, 1},
    {"30.4.5", "IntegerSequencer", 3, 2, 0, 1},
    {"30.4.6", "IntegerTrigger", 1, 1, 0, 1},
    {"30.4.7", "TimeTrigger", 1, 0, 0, 1},
    {"39.4.1", "ColorChaser", 2, 0, 3, 2},
    {"39.4.2", "ColorDamper", 2, 2, 3, 2},
    {"39.4.3", "CoordinateChaser", 2, 0, 3, 2},
    {"39.4.4", "CoordinateDamper", 2, 2, 3, 2},
    {"39.4.5", "OrientationChaser", 2, 0, 3, 2},
    {"39.4.6", "OrientationDamper", 2, 2, 3, 2},
    {"39.4.7", "PositionChaser", 2, 0, 3, 2},
    {"39.4.8", "PositionChaser2D", 2, 0, 3, 2},
    {"39.4.9", "PositionDamper", 2, 2, 3, 2},
    {"39.4.10", "PositionDamper2D", 2, 2, 3, 2},
    {"39.4.11", "ScalarChaser", 2, 0, 3, 2},
    {"39.4.12", "ScalarDamper", 2, 2, 3, 2},
    {"39.4.13", "TexCoordChaser2D", 2, 0, 3, 2},
    {"39.4.14", "TexCoordDamper2D", 2, 2, 3, 2},
};

// A field that X3D adds to a node of VRML97.
struct Addition {
  const char* node;
  const char* field;
  Access access;
  Value value;
};
const Addition additions[] = {
    {"Appearance", "alphaMode", Access::exposedField, SFString("AUTO")},
    {"Appearance", "alphaCutoff", Access::exposedField, 0.5f},
    {"Box", "solid", Access::field, true},
    {"Cone", "solid", Access::field, true},
    {"Cylinder", "solid", Access::field, true},
    {"Sphere", "solid", Access::field, true},
    {"Text", "solid", Access::field, false},
};

int count(const NodeType& type, Access access) {
  return int(std::count_if(type.fields.begin(), type.fields.end(),
                           [&](const FieldInfo& field) { return field.access == access; }));
}

TEST(X3dNodes, InterfacesAreThoseOfTheStandard) {
  EXPECT_EQ(std::count_if(nodeTypes().begin(), nodeTypes().end(),
                          [](const NodeType* type) { return type->standard == Standard::x3d; }),
            std::ssize(interfaces));
  for (const Interface& expected : interfaces) {
    SCOPED_TRACE(expected.name);
    const NodeType* type = findNodeType(expected.name);
    ASSERT_NE(type, nullptr);
    EXPECT_EQ(type->standard, Standard::x3d);
    EXPECT_EQ(type->clause, expected.clause);
    EXPECT_EQ(count(*type, Access::eventIn), expected.eventIns);
    EXPECT_EQ(count(*type, Access::exposedField), expected.exposedFields);
    EXPECT_EQ(count(*type, Access::field), expected.fields);
    EXPECT_EQ(count(*type, Access::eventOut), expected.eventOuts);
    for (const FieldInfo& field : type->fields) EXPECT_FALSE(field.ofX3d) << field.name;
  }
}

TEST(X3dNodes, FieldsAreAddedToNodesOfVrml97) {
  std::ptrdiff_t marked = 0;
  for (const NodeType* type : nodeTypes())
    marked += std::count_if(type->fields.begin(), type->fields.end(),
                            [](const FieldInfo& field) { return field.ofX3d; });
  EXPECT_EQ(marked, std::ssize(additions));
  for (const Addition& expected : additions) {
    SCOPED_TRACE(std::string(expected.node) + '.' + expected.field);
    const NodeType* type = findNodeType(expected.node);
    ASSERT_NE(type, nullptr);
    const FieldInfo* field = type->find(expected.field);
    ASSERT_NE(field, nullptr);
    EXPECT_TRUE(field->ofX3d);
    EXPECT_EQ(field->access, expected.access);
    EXPECT_EQ(field->defaultValue, expected.value);
  }
}

} // namespace
} // namespace xvrml
