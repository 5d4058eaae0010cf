// xvrml_node_test.cpp: nodes in general: references, nodes described at run time, ranges, the
// registry, type names, limits and messages.
#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <utility>

#include <xvrml/diagnostics.h>
#include <xvrml/limits.h>
#include <xvrml/nodes.h>

#include "nodes/registry.h"

namespace xvrml {
namespace {

struct Counted : nodes::Group {
  explicit Counted(int& alive) : alive_(alive) { ++alive_; }
  ~Counted() override { --alive_; }
  int& alive_;
};

TEST(NodeRef, CountsReferences) {
  int alive = 0;
  {
    NodeRef first(new Counted(alive)), second = first, third = std::move(second);
    EXPECT_EQ(first, third);
    EXPECT_FALSE(second);
    first = nullptr;
    EXPECT_EQ(alive, 1);
    third = third.operator=(third);
    EXPECT_EQ(alive, 1);
  }
  EXPECT_EQ(alive, 0);
}

TEST(NodeRef, AChainOfAMillionNodesIsReleased) {
  int alive = 0;
  NodeRef top;
  for (int i = 0; i < 1'000'000; ++i) {
    auto* group = new Counted(alive);
    group->children.push_back(std::move(top));
    top = NodeRef(group);
  }
  EXPECT_EQ(alive, 1'000'000);
  top = nullptr;
  EXPECT_EQ(alive, 0);
}

// A million Materials have no room for strings that none of them sets.
TEST(RareFields, TakeNoRoomBeforeOneIsSet) {
  EXPECT_LT(sizeof(nodes::Material), 8 * sizeof(std::string));
  nodes::Material material, other;
  const FieldInfo& field = *material.type().find("diffuseTextureMapping");
  const FieldInfo& another = *material.type().find("normalTextureMapping");
  ASSERT_TRUE(field.rare);
  const Node& read = material;
  EXPECT_TRUE(read.isUnset(field));
  EXPECT_EQ(read.storage(field), std::as_const(other).storage(field)) << "the shared default";
  EXPECT_EQ(material.get(field), Value(SFString()));
  EXPECT_TRUE(material.set(field, SFString("picture")));
  EXPECT_FALSE(read.isUnset(field) || read.isUnset(*material.type().find("shininess")));
  EXPECT_EQ(material.get(field), Value(SFString("picture")));
  EXPECT_EQ(material.rare.get().diffuseTextureMapping, "picture");
  EXPECT_EQ(read.storage(field), material.storage(field));
  EXPECT_EQ(material.get(another), Value(SFString()));
  EXPECT_EQ(other.get(field), Value(SFString()));
}

TEST(DynamicNode, HoldsWhatItsTypeDeclares) {
  auto type = std::make_shared<NodeType>();
  type->name = "Thing";
  type->index = -1;
  type->fields.push_back(
      {"go", FieldType::SFBool, Access::eventIn, Change::none, false, false, 0, {}, {}, "", ""});
  type->fields.push_back({"title",
                          FieldType::SFString,
                          Access::field,
                          Change::none,
                          false,
                          false,
                          0,
                          std::string("none"),
                          {},
                          "",
                          ""});
  type->fields.push_back({"points",
                          FieldType::MFVec3f,
                          Access::exposedField,
                          Change::none,
                          false,
                          false,
                          1,
                          MFVec3f{{1, 2, 3}},
                          {},
                          "",
                          ""});
  const NodeRef node(new DynamicNode(type));
  const FieldInfo &title = *type->find("title"), &points = *type->find("points");
  EXPECT_TRUE(node->get(title) == Value(std::string("none")));
  EXPECT_TRUE(node->get(points) == points.defaultValue);
  EXPECT_TRUE(node->set(points, MFVec3f{}));
  EXPECT_TRUE(node->get(points) == Value(MFVec3f()));
  EXPECT_FALSE(node->set(title, 1.0f));
  EXPECT_FALSE(node->set(*type->find("go"), true)); // events are not stored
  EXPECT_EQ(nodeCast<nodes::Box>(node), nullptr);
  *static_cast<SFString*>(node->storage(title)) = "some";
  EXPECT_TRUE(node->get(title) == Value(std::string("some")));
  type.reset(); // the node keeps its type alive
  EXPECT_EQ(node->type().name, "Thing");
}

FieldInfo ranged(FieldType type, FieldRange range) {
  FieldInfo field;
  field.type = type;
  field.range = range;
  return field;
}

TEST(Range, EndsAreOpenOrClosed) {
  const FieldInfo open = ranged(FieldType::SFFloat, {0, 1, true, true}),
                  closed = ranged(FieldType::SFFloat, {0, 1, false, false});
  EXPECT_FALSE(inRange(open, 0.0f));
  EXPECT_FALSE(inRange(open, 1.0f));
  EXPECT_TRUE(inRange(open, 0.5f));
  EXPECT_TRUE(inRange(closed, 0.0f));
  EXPECT_TRUE(inRange(closed, 1.0f));
  EXPECT_FALSE(inRange(closed, 1.0000001f));
  EXPECT_FALSE(inRange(closed, -0.1f));
  EXPECT_FALSE(inRange(closed, std::numeric_limits<float>::quiet_NaN()));
}

TEST(Range, EveryNumberCounts) {
  const FieldInfo colours = ranged(FieldType::MFColor, {0, 1, false, false});
  EXPECT_TRUE(inRange(colours, MFColor{{0, 1, 0.5f}}));
  EXPECT_FALSE(inRange(colours, MFColor{{0, 1, 0.5f}, {0, 0, 2}}));
  EXPECT_TRUE(inRange(colours, MFColor{}));
  const FieldInfo axis = ranged(FieldType::SFRotation, {-1, 1, false, false});
  EXPECT_TRUE(inRange(axis, SFRotation{0, 1, 0, 100}));
  EXPECT_FALSE(inRange(axis, SFRotation{0, 2, 0, 0}));
  const FieldInfo index =
      ranged(FieldType::MFInt32, {-1, std::numeric_limits<double>::infinity(), false, true});
  EXPECT_TRUE(inRange(index, MFInt32{-1, 0, std::numeric_limits<int32_t>::max()}));
  EXPECT_FALSE(inRange(index, MFInt32{-2}));
}

TEST(Range, TheExceptionHoldsForAllNumbersOrNone) {
  const FieldInfo& size = *findNodeType("Group")->find("bboxSize");
  EXPECT_TRUE(inRange(size, SFVec3f{-1, -1, -1}));
  EXPECT_TRUE(inRange(size, SFVec3f{1, 2, 3}));
  EXPECT_FALSE(inRange(size, SFVec3f{1, -1, 1}));
  EXPECT_FALSE(inRange(size, SFVec3f{0, 1, 1}));
}

// The float nearest to pi/2 is above it. A file that writes pi/2 as precisely as float allows must
// be within (0,pi/2].
TEST(Range, EndsAreRoundedToFloat) {
  const FieldInfo& beam = *findNodeType("SpotLight")->find("beamWidth");
  EXPECT_TRUE(inRange(beam, 1.57079637f));
  EXPECT_FALSE(inRange(beam, 1.5708f));
}

TEST(Registry, RefusesWhatDoesNotFit) {
  const size_t before = nodeTypes().size();
  NodeType type = nodes::Box::nodeType();
  const NodeType* const list[] = {&type};
  type.name = "AnotherBox"; // the index belongs to Box
  EXPECT_FALSE(addNodeTypes(list));
  type.name = "Sphere"; // the name is taken
  type.index = int(before);
  EXPECT_FALSE(addNodeTypes(list));
  EXPECT_EQ(nodeTypes().size(), before);
  EXPECT_EQ(findNodeType("AnotherBox"), nullptr);
}

TEST(FieldTypes, HaveNamesAndNeutralValues) {
  for (int i = 0; i < fieldTypeCount; ++i) {
    FieldType type = FieldType::SFBool;
    ASSERT_TRUE(fieldTypeFromName(fieldTypeName(FieldType(i)), type));
    EXPECT_EQ(int(type), i);
    EXPECT_EQ(defaultValue(type).index(), size_t(i));
    EXPECT_EQ(isMultiple(type), fieldTypeName(type).starts_with("MF"));
  }
  FieldType type = FieldType::SFBool;
  for (const char* name : {"", "SF", "sfbool", "SFBoolean", "MFbool", "SFVec5f"})
    EXPECT_FALSE(fieldTypeFromName(name, type)) << name;
  EXPECT_TRUE(defaultValue(FieldType::SFRotation) == Value(SFRotation{0, 0, 1, 0}));
}

TEST(Limits, AreSetByName) {
  Limits limits;
  EXPECT_TRUE(setLimit(limits, "nesting", 7));
  EXPECT_EQ(limits.nesting, 7u);
  EXPECT_FALSE(setLimit(limits, "Nesting", 8));
  EXPECT_EQ(limits.nesting, 7u);
  uint64_t value = 100;
  for (const LimitInfo& info : limitTable()) {
    EXPECT_TRUE(setLimit(limits, info.name, ++value)) << info.name;
    EXPECT_EQ(limits.*info.value, value) << info.name;
    EXPECT_FALSE(info.text.empty()) << info.name;
  }
}

TEST(Diagnostic, SaysWhereAndWhat) {
  EXPECT_EQ((Diagnostic{Severity::error, "a.wrl", 3, 5, "wrong", ""}.text()),
            "a.wrl:3:5: error: wrong");
  EXPECT_EQ((Diagnostic{Severity::warning, "a.wrl", 0, 0, "odd", ""}.text()),
            "a.wrl: warning: odd");
  EXPECT_EQ((Diagnostic{Severity::note, "", 0, 0, "so", ""}.text()), "note: so");
}

TEST(Diagnostic, TheCaretStandsBelowTheColumn) {
  EXPECT_EQ((Diagnostic{Severity::error, "f", 1, 3, "m", "ab!"}.text()),
            "f:1:3: error: m\nab!\n  ^");
  EXPECT_EQ((Diagnostic{Severity::error, "f", 1, 3, "m", "\t !"}.text()),
            "f:1:3: error: m\n\t !\n\t ^");
  EXPECT_EQ((Diagnostic{Severity::error, "f", 1, 3, "m", "äö!"}.text()),
            "f:1:3: error: m\näö!\n  ^"); // columns count characters
}

// Errors and other messages have separate quotas, so that one kind cannot hide the other.
TEST(Diagnostics, CountWhatTheyDrop) {
  Diagnostics diagnostics;
  diagnostics.limit = 2;
  const SourcePosition where{std::make_shared<const std::string>("f"), 1, 2};
  for (int i = 0; i < 4; ++i) diagnostics.warn(where, "one");
  for (int i = 0; i < 3; ++i) diagnostics.error(where, "two");
  ASSERT_EQ(diagnostics.list().size(), 4u);
  EXPECT_EQ(diagnostics.list()[0].text(), "f:1:2: warning: one");
  EXPECT_EQ(diagnostics.list()[3].text(), "f:1:2: error: two");
  EXPECT_EQ(diagnostics.errors(), 3u);
  EXPECT_EQ(diagnostics.warnings(), 4u);
  EXPECT_EQ(diagnostics.dropped(), 3u);
}

} // namespace
} // namespace xvrml
