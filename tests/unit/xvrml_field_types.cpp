// xvrml_field_types.cpp: the field types of ISO/IEC 19775-1 clause 5 from text to values and back,
// their defaults, and what is said about values that do not fit.
#include <gtest/gtest.h>

#include "write/value_writer.h"
#include "xvrml/numbers.h"
#include "xvrml/value_text.h"
#include "xvrml/world.h"

namespace {

using namespace xvrml;
using Messages = std::vector<std::string>;

std::string textOf(const Value& value) {
  std::string text;
  std::visit([&](const auto& v) { writeValue(text, FieldType(value.index()), &v, 0); }, value);
  return text;
}

Messages messagesOf(const World& world) {
  Messages all;
  for (const Diagnostic& one : world.diagnostics.list())
    all.push_back(one.text().substr(0, one.text().find('\n')));
  return all;
}

TEST(FieldTypes, NamesAndElements) {
  int lists = 0;
  for (int i = 0; i < fieldTypeCount; ++i) {
    const auto type = FieldType(i);
    const std::string name(fieldTypeName(type));
    FieldType found{};
    ASSERT_TRUE(fieldTypeFromName(name, found));
    EXPECT_EQ(found, type);
    EXPECT_EQ(isMultiple(type), name[0] == 'M') << name;
    EXPECT_EQ(fieldTypeName(elementType(type)), 'S' + name.substr(1)) << name;
    EXPECT_EQ(isVrml97Type(type), i < 20) << name;
    EXPECT_EQ(defaultValue(type).index(), size_t(i));
    lists += isMultiple(type);
  }
  EXPECT_EQ(fieldTypeCount, 42);
  EXPECT_EQ(lists, 21); // every SF type has its list
  FieldType type{};
  EXPECT_FALSE(fieldTypeFromName("SFVec5f", type));
  EXPECT_FALSE(isMultiple(FieldType(200)));
}

// The defaults of ISO/IEC 19775-1 5.3.
TEST(FieldTypes, Defaults) {
  const auto text = [](FieldType type) { return textOf(defaultValue(type)); };
  EXPECT_EQ(text(FieldType::SFColorRGBA), "0 0 0 0");
  EXPECT_EQ(text(FieldType::SFDouble), "0");
  EXPECT_EQ(text(FieldType::SFVec2d), "0 0");
  EXPECT_EQ(text(FieldType::SFVec4f), "0 0 0 1");
  EXPECT_EQ(text(FieldType::SFVec4d), "0 0 0 1");
  EXPECT_EQ(text(FieldType::SFMatrix3f), "1 0 0 0 1 0 0 0 1");
  EXPECT_EQ(text(FieldType::SFMatrix3d), "1 0 0 0 1 0 0 0 1");
  EXPECT_EQ(text(FieldType::SFMatrix4f), "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1");
  EXPECT_EQ(text(FieldType::SFMatrix4d), "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1");
  EXPECT_EQ(text(FieldType::MFBool), "[  ]");
}

TEST(FieldTypes, EachIsReadAndWritten) {
  const std::pair<FieldType, const char*> cases[] = {
      {FieldType::MFBool, "[ TRUE FALSE TRUE ]"},
      {FieldType::SFColorRGBA, "0.1 0.2 0.3 0.5"},
      {FieldType::MFColorRGBA, "[ 0 0 0 1, 1 1 1 0.5 ]"},
      {FieldType::SFDouble, "0.1"},
      {FieldType::MFDouble, "[ 1e+300 0.1 -3 ]"},
      {FieldType::MFImage, "[ 1 1 1\n    0x07, 0 0 0 ]"},
      {FieldType::SFMatrix3f, "1 2 3 4 5 6 7 8 0.1"},
      {FieldType::MFMatrix3f, "[ 1 2 3 4 5 6 7 8 9, 9 8 7 6 5 4 3 2 1 ]"},
      {FieldType::SFMatrix3d, "1 2 3 4 5 6 7 8 0.1"},
      {FieldType::MFMatrix3d, "[ 1 2 3 4 5 6 7 8 9 ]"},
      {FieldType::SFMatrix4f, "1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 0.1"},
      {FieldType::MFMatrix4f, "[ 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 ]"},
      {FieldType::SFMatrix4d, "1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 1e+200"},
      {FieldType::MFMatrix4d, "[ 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 ]"},
      {FieldType::SFVec2d, "3.141592653589793 1e-300"},
      {FieldType::MFVec2d, "[ 1 2, 3 4 ]"},
      {FieldType::SFVec3d, "3.141592653589793 1 2"},
      {FieldType::MFVec3d, "[ 1 2 3, 4 5 6 ]"},
      {FieldType::SFVec4d, "3.141592653589793 1 2 3"},
      {FieldType::MFVec4d, "[ 1 2 3 4, 5 6 7 8 ]"},
      {FieldType::SFVec4f, "0.1 1 2 3"},
      {FieldType::MFVec4f, "[ 1 2 3 4, 5 6 7 8 ]"},
  };
  EXPECT_EQ(std::size(cases), size_t(fieldTypeCount) - 20);
  for (const auto& [type, text] : cases) {
    std::string problem;
    const auto value = parseValue(type, text, problem, {});
    ASSERT_TRUE(value) << fieldTypeName(type) << ": " << problem;
    EXPECT_EQ(textOf(*value), text) << fieldTypeName(type);
    EXPECT_FALSE(*value == defaultValue(type)) << fieldTypeName(type);
    const Value copy = *value; // boxes are copied, not shared
    EXPECT_TRUE(copy == *value) << fieldTypeName(type);
  }
}

TEST(FieldTypes, CopiesOfABoxAreTheirOwn) {
  SFMatrix4d a, b = a;
  (*b).m[3] = 7;
  EXPECT_EQ((*a).m[3], 0);
  SFMatrix4d c = std::move(b);
  EXPECT_EQ((*c).m[3], 7);
  a = c;
  EXPECT_TRUE(a == c);
}

TEST(FieldTypes, WhatDoesNotFitIsNamed) {
  const std::tuple<FieldType, const char*, const char*> cases[] = {
      {FieldType::MFBool, "[ TRUE 1 ]", "expected TRUE or FALSE of SFBool, found '1'"},
      {FieldType::SFColorRGBA, "1 0 0", "expected a component of SFColorRGBA, found the end"},
      {FieldType::MFVec4f, "[ 1 2 3 4 5 6 ]", "2 numbers left over: SFVec4f takes 4 each"},
      {FieldType::SFDouble, "x", "expected a number of SFDouble, found 'x'"},
      {FieldType::SFDouble, "1e999", "number '1e999' is out of range for SFDouble"},
      {FieldType::SFMatrix3f, "1 0 0 0 1 0 0 0", "expected a component of SFMatrix3f"},
      {FieldType::SFMatrix3f, "1 0 0 0 1e39 0 0 0 1", "number '1e39' is out of range"},
      {FieldType::MFImage, "[ 1 1 9 ]", "SFImage of 9 components: expected 0 to 4"},
  };
  for (const auto& [type, text, expected] : cases) {
    std::string problem;
    EXPECT_FALSE(parseValue(type, text, problem, {})) << text;
    EXPECT_EQ(problem.find(expected), 0u) << problem;
  }
}

// A prototype, its instances and a Script hold values of X3D's types, and IS and routes carry them.
TEST(FieldTypes, PrototypesAndScriptsHoldThem) {
  const auto world = loadWorldFromMemory(
      "#X3D V3.3 utf8\nPROTO P [ initializeOnly SFVec4f v 1 2 3 4 inputOutput MFDouble d [ 1 2 ]\n"
      "  initializeOnly MFBool b [ TRUE FALSE ] initializeOnly SFMatrix4d m "
      "1 0 0 0 0 1 0 0 0 0 1 0 5 6 7 1 ]\n"
      "{ Group { } DEF S Script { initializeOnly SFVec4f v IS v initializeOnly MFBool b IS b } }\n"
      "P { v 0 0 0 2 d 3 } P { }",
      "test.x3dv");
  EXPECT_EQ(messagesOf(*world), Messages());
  ASSERT_EQ(world->scope.roots.size(), 2u);
  const auto get = [&](size_t root, const char* field) {
    const NodeRef& node = world->scope.roots[root];
    return textOf(node->get(*node->type().find(field)));
  };
  EXPECT_EQ(get(0, "v"), "0 0 0 2");
  EXPECT_EQ(get(0, "d"), "[ 3 ]");
  EXPECT_EQ(get(1, "v"), "1 2 3 4");
  EXPECT_EQ(get(1, "b"), "[ TRUE FALSE ]");
  EXPECT_EQ(get(1, "m"), "1 0 0 0 0 1 0 0 0 0 1 0 5 6 7 1");
}

TEST(FieldTypes, InVrml97EachIsReportedOnce) {
  const auto world = loadWorldFromMemory(
      "#VRML V2.0 utf8\nPROTO P [ field SFVec4f v 1 2 3 4 field SFVec4f w 1 2 3 4 ] { Group { } }\n"
      "Script { field MFBool b [ TRUE ] field SFVec5f c 1 }\nP { }",
      "test.wrl");
  EXPECT_EQ(messagesOf(*world),
            (Messages{"test.wrl:2:17: warning: SFVec4f is a type of X3D: other browsers of VRML97 "
                      "do not know it",
                      "test.wrl:3:16: warning: MFBool is a type of X3D: other browsers of VRML97 "
                      "do not know it",
                      "test.wrl:3:40: error: expected a field type, found 'SFVec5f'"}));
  EXPECT_EQ(world->scope.roots.size(), 2u);
}

} // namespace
