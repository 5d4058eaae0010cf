// rotations.cpp: axes of rotations are normalised (5.8) wherever a node receives one: files,
// events, prototypes, programs. The direction is kept.
#include <cmath>

#include "conformance/events/support.h"

namespace xvrml {
namespace {

// The axis 0 1.618034 1 has length 1.902113; this is its normalised direction.
const std::string golden = "0 0.850651 0.525731 1.25";
const SFRotation wild{0, 1.618034f, 1, 1.25f};

TEST(Rotations, OfAFileAreNormalized) {
  Running r("DEF T Transform { rotation 0 1.618034 1 1.25 scaleOrientation 3 0 4 1 }");
  EXPECT_EQ(r.get("T", "rotation"), golden);
  EXPECT_EQ(r.get("T", "scaleOrientation"), "0.6 0 0.8 1");
}

TEST(Rotations, InListsAreNormalizedOneByOne) {
  Running r("DEF O OrientationInterpolator { key [ 0 1 ] keyValue [ 1 0 0 0, 0 1.618034 1 1.25 ] } "
            "DEF E Extrusion { orientation [ 0 0 5 1, 0 0 1 2 ] }");
  EXPECT_EQ(r.get("O", "keyValue"), "[1 0 0 0, " + golden + "]");
}

TEST(Rotations, OneMessageSaysHowManyAndWhich) {
  Running r(
      "DEF O OrientationInterpolator { key [ 0 1 2 ] keyValue [ 0 1 1 0, 0 3 4 1, 2 0 0 1 ] }");
  const auto& list = r.browser.world().diagnostics.list();
  ASSERT_EQ(list.size(), 1u);
  EXPECT_EQ(list[0].message, "OrientationInterpolator.keyValue: the axis 0 3 4 has length 5, not "
                             "1; it and 1 more are normalised");
}

// Many files write 0 1 1 for "between y and z".
TEST(Rotations, ComponentsUpToOneAreNoWordWorth) {
  Running r("DEF T Transform { rotation 0 1 1 1 } DEF U Transform { rotation 0.577 0.577 0.577 1 } "
            "DEF V Transform { rotation 0 0 0 1 }");
  EXPECT_TRUE(r.browser.world().diagnostics.list().empty());
  EXPECT_EQ(r.get("T", "rotation"), "0 0.707107 0.707107 1");
  EXPECT_EQ(r.get("U", "rotation"), "0.577 0.577 0.577 1"); // the digits of a file, not an error
  EXPECT_EQ(r.get("V", "rotation"), "0 0 0 1");             // no rotation
}

TEST(Rotations, OfEventsAreNormalizedAndSentSo) {
  Running r("DEF T Transform {} DEF U Transform {} ROUTE T.rotation_changed TO U.set_rotation");
  r.log("T", "rotation");
  r.set("T", "rotation", wild);
  EXPECT_EQ(r.take(), Log{"0 T.rotation " + golden});
  EXPECT_EQ(r.get("T", "rotation"), golden);
  EXPECT_EQ(r.get("U", "rotation"), golden);
}

TEST(Rotations, ThroughPrototypesAreNormalizedWhereANodeTakesThem) {
  Running r("PROTO P [ exposedField SFRotation turn 0 0 2 1 ] { Transform { rotation IS turn } } "
            "DEF A P {} DEF B P { turn 0 1.618034 1 1.25 }");
  const auto inside = [&](const char* name) {
    Node& node = *renderedNode(r.browser.node(name).get());
    return textOf(node.get(*node.type().find("rotation")));
  };
  EXPECT_EQ(inside("A"), "0 0 1 1");
  EXPECT_EQ(inside("B"), golden);
  r.log("A", "turn");
  r.set("A", "turn", wild);
  EXPECT_EQ(inside("A"), golden);
  EXPECT_EQ(r.get("A", "turn"), golden);
  EXPECT_EQ(r.take(), Log{"0 A.turn " + golden});
}

TEST(Rotations, OfProgramsAreNormalizedAndWrittenSo) {
  const NodeType& type = *findNodeType("Transform");
  const NodeRef node(type.create(type));
  node->set(*type.find("rotation"), wild);
  EXPECT_EQ(textOf(node->get(*type.find("rotation"))), golden);
  // Written directly, without any check.
  *static_cast<SFRotation*>(node->storage(*type.find("scaleOrientation"))) = {0, 2, 0, 1};
  World world;
  world.scope.roots.push_back(node);
  const auto again = loadWorldFromMemory(writeWorld(world), "again.wrl");
  EXPECT_TRUE(again->diagnostics.list().empty());
  EXPECT_EQ(textOf(again->scope.roots[0]->get(*type.find("rotation"))), golden);
  EXPECT_EQ(textOf(again->scope.roots[0]->get(*type.find("scaleOrientation"))), "0 1 0 1");
}

TEST(Rotations, OddNumbersStayAsTheyAre) {
  const NodeType& type = *findNodeType("Transform");
  const NodeRef node(type.create(type));
  const auto through = [&](SFRotation r) {
    node->set(*type.find("rotation"), r);
    return std::get<SFRotation>(node->get(*type.find("rotation")));
  };
  EXPECT_EQ(through({0, 0, 0, 1}), (SFRotation{0, 0, 0, 1}));
  EXPECT_EQ(through({3e38f, 0, 0, 1}), (SFRotation{1, 0, 0, 1}));
  EXPECT_EQ(through({0, 0, -1e-30f, 1}), (SFRotation{0, 0, -1, 1}));
  EXPECT_TRUE(std::isnan(through({std::nanf(""), 0, 0, 1}).x));
  const SFRotation once = through({1, 2, 3, 1});
  EXPECT_EQ(through(once), once);
}

TEST(Rotations, FieldsOfScriptsHoldWhatTheyAreGiven) {
  Running r("DEF S Script { field SFRotation r 0 2 0 1 }");
  EXPECT_EQ(r.get("S", "r"), "0 2 0 1");
}

} // namespace
} // namespace xvrml
