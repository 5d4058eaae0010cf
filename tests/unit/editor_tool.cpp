// editor_tool.cpp: Tests moving, turning and scaling with the pointer against the places that the
// camera shows.
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "edit/transform_tool.h"
#include "unit/editor_support.h"
#include "xvrml/nodes.h"

namespace {

using namespace editor_test;
using namespace vv;
using namespace xvrml;
using Kind = TransformTool::Kind;

// A box below a turned and scaled parent, seen from z = 10.
constexpr const char* text =
    "#VRML V2.0 utf8\n"
    "DEF OUTER Transform { translation 1 2 0 rotation 0 0 1 0.7 scale 2 2 2 children [\n"
    "  DEF T Transform { translation 0.3 0.1 0 rotation 0 1 0 0.5 children [\n"
    "    DEF S Shape { geometry Box { size 0.4 0.2 0.2 } } ] } ] }\n";

struct Tool : testing::Test {
  EditedWorld world{text};
  EditView view = front(1.5);

  void SetUp() override { world.editor.select({world.node("T")}); }
  // The matrix from the node's own coordinates to the world.
  std::array<double, 16> matrix() {
    NodePlacement placement;
    EXPECT_TRUE(world.browser.locate(*world.node("T"), placement));
    return placement.path.back().toWorld;
  }
  // Returns where the node's origin is seen.
  std::array<double, 2> seen() {
    const std::array<double, 16> m = matrix();
    std::array<double, 2> at{};
    EXPECT_TRUE(projectPoint(view.camera, view.aspect, &m[12], at[0], at[1]));
    return at;
  }
};

TEST_F(Tool, AFreeMoveFollowsThePointer) {
  const std::array<double, 2> before = seen();
  const double depth = matrix()[14];
  TransformTool tool(world.editor, Kind::move, view, before[0] + 0.05, before[1] - 0.02);
  tool.point(world.editor, before[0] + 0.3, before[1] + 0.4);
  tool.accept(world.editor);
  EXPECT_NEAR(seen()[0], before[0] + 0.25, 1e-5);
  EXPECT_NEAR(seen()[1], before[1] + 0.42, 1e-5);
  EXPECT_NEAR(matrix()[14], depth, 1e-5) << "in the plane that faces the viewer";
  EXPECT_EQ(world.editor.editor().undoName(), "Move Transform");
  world.editor.undo();
  EXPECT_EQ(world.editor.editor().text(), text);
}

TEST_F(Tool, AMoveAlongAnAxisOfTheWorld) {
  const std::array<double, 16> before = matrix();
  const std::array<double, 2> at = seen();
  TransformTool tool(world.editor, Kind::move, view, at[0], at[1]);
  tool.chooseAxis(0);
  tool.point(world.editor, at[0] + 0.2, at[1] + 0.1);
  EXPECT_NEAR(seen()[0], at[0] + 0.2, 0.01);
  EXPECT_NEAR(matrix()[13], before[13], 1e-5);
  EXPECT_NEAR(matrix()[14], before[14], 1e-5);
  for (const char* key : {"1", ".", "5", "7", "Backspace"}) EXPECT_TRUE(tool.type(key));
  EXPECT_FALSE(tool.type("Q"));
  tool.point(world.editor, 0, 0);
  EXPECT_NEAR(matrix()[12], before[12] + 1.5, 1e-5);
  EXPECT_NE(tool.text().find("Move along x: 1.5"), std::string::npos);
  EXPECT_TRUE(tool.type("-"));
  tool.point(world.editor, 0, 0);
  EXPECT_NEAR(matrix()[12], before[12] - 1.5, 1e-5);
  tool.cancel(world.editor);
  EXPECT_EQ(matrix(), before);
  EXPECT_EQ(world.editor.editor().text(), text);
}

// Sums are those of the numbers in the file: 0.05 and 0.01 are 0.06 there, and not 0.060000002.
TEST(ToolNumbers, SmallStepsAddUp) {
  EditedWorld plain("#VRML V2.0 utf8\nDEF T Transform { translation 0 0 0 children Group { } }\n");
  plain.editor.select({plain.node("T")});
  for (int i = 1; i <= 20; ++i) {
    TransformTool tool(plain.editor, Kind::move, front(), 0, 0);
    tool.chooseAxis(0);
    for (const char* key : {".", "0", "1"}) tool.type(key);
    tool.point(plain.editor, 0, 0);
    tool.accept(plain.editor);
    const std::string wanted = fmt::format("translation {} 0 0 children", i / 100.0);
    EXPECT_NE(plain.editor.editor().text().find(wanted), std::string::npos)
        << wanted << "\n"
        << plain.editor.editor().text();
  }
}

TEST_F(Tool, AMoveAlongAnAxisOfItsOwn) {
  const std::array<double, 16> before = matrix();
  TransformTool tool(world.editor, Kind::move, view, 0, 0);
  tool.chooseAxis(0);
  tool.chooseAxis(0);
  tool.type("2");
  tool.point(world.editor, 0, 0);
  // The node's x axis in the world is the first column, whose length is the scale of the parent.
  for (size_t i = 0; i < 3; ++i) EXPECT_NEAR(matrix()[12 + i], before[12 + i] + before[i], 1e-5);
  tool.cancel(world.editor);
}

TEST_F(Tool, ATurnKeepsTheCentreAndTheSize) {
  const std::array<double, 16> before = matrix();
  const std::array<double, 2> at = seen();
  // A quarter turn of the pointer about the centre, to the left.
  TransformTool tool(world.editor, Kind::turn, view, at[0] + 0.1 / view.aspect, at[1]);
  tool.point(world.editor, at[0], at[1] + 0.1);
  tool.accept(world.editor);
  const std::array<double, 16> after = matrix();
  for (size_t column = 0; column < 3; ++column) {
    // Rotated by 90 degrees about z: (x, y) becomes (-y, x).
    EXPECT_NEAR(after[4 * column], -before[4 * column + 1], 1e-5);
    EXPECT_NEAR(after[4 * column + 1], before[4 * column], 1e-5);
    EXPECT_NEAR(after[4 * column + 2], before[4 * column + 2], 1e-5);
  }
  for (size_t i = 12; i < 15; ++i) EXPECT_NEAR(after[i], before[i], 1e-5);
  world.editor.undo();
  EXPECT_EQ(world.editor.editor().text(), text);
}

TEST_F(Tool, ATurnAboutAnAxisByANumber) {
  const std::array<double, 16> before = matrix();
  TransformTool tool(world.editor, Kind::turn, view, 0.5, 0.5);
  tool.chooseAxis(1);
  for (const char* key : {"9", "0"}) tool.type(key);
  tool.point(world.editor, 0, 0);
  const std::array<double, 16> after = matrix();
  for (size_t column = 0; column < 3; ++column) { // (z, x) becomes (-x, z)
    EXPECT_NEAR(after[4 * column], before[4 * column + 2], 1e-5);
    EXPECT_NEAR(after[4 * column + 2], -before[4 * column], 1e-5);
  }
  tool.cancel(world.editor);
}

TEST_F(Tool, AScaleIsThatOfTheDistance) {
  const std::array<double, 2> at = seen();
  TransformTool tool(world.editor, Kind::scale, view, at[0] + 0.1, at[1]);
  tool.point(world.editor, at[0] + 0.25, at[1]);
  EXPECT_NEAR(static_cast<nodes::Transform&>(*world.node("T")).scale.y, 2.5f, 1e-4);
  tool.chooseAxis(1);
  tool.type("3");
  tool.point(world.editor, 0, 0);
  const Vec3f scale = static_cast<nodes::Transform&>(*world.node("T")).scale;
  EXPECT_EQ(scale, (Vec3f{1, 3, 1}));
  tool.type("Backspace");
  tool.type("0");
  tool.point(world.editor, 0, 0);
  EXPECT_EQ(static_cast<nodes::Transform&>(*world.node("T")).scale, scale) << "never 0";
  tool.accept(world.editor);
}

TEST_F(Tool, StepsAreRound) {
  TransformTool tool(world.editor, Kind::turn, view, 0.9, seen()[1]);
  tool.setSnap(true);
  tool.point(world.editor, 0.9, seen()[1] + 0.123);
  const std::string shown = tool.text();
  const double angle = std::stod(shown.substr(shown.find(':') + 1));
  EXPECT_EQ(std::remainder(angle, 5), 0) << shown;
  tool.cancel(world.editor);
}

TEST_F(Tool, OtherNodesGetATransform) {
  world.editor.select({world.node("S")});
  TransformTool tool(world.editor, Kind::move, view, 0, 0);
  tool.chooseAxis(2);
  tool.type("1");
  tool.point(world.editor, 0, 0);
  EXPECT_EQ(world.editor.selected()->type().name, "Transform");
  tool.cancel(world.editor);
  EXPECT_EQ(world.editor.selected(), world.node("S").get());
  EXPECT_EQ(world.editor.editor().text(), text);
}

TEST_F(Tool, WhatCannotBeMovedIsSaid) {
  world.editor.select({});
  EXPECT_THROW(TransformTool(world.editor, Kind::move, view, 0, 0), EditError);
  EXPECT_FALSE(world.editor.editor().isInStep());
}

TEST_F(Tool, WhatIsBehindTheViewerMovesByNumbers) {
  view.camera.matrix[14] = -10; // the viewer looks away
  const std::array<double, 16> before = matrix();
  TransformTool tool(world.editor, Kind::move, view, 0, 0);
  tool.chooseAxis(1);
  tool.type("1");
  tool.point(world.editor, 0, 0);
  EXPECT_NEAR(matrix()[13], before[13] + 1, 1e-5);
  EXPECT_TRUE(world.editor.editor().isInStep());
  EXPECT_THROW(world.editor.save(), EditError) << "the move may still be taken back";
  tool.cancel(world.editor);
  EXPECT_EQ(world.editor.editor().text(), text);
}

TEST_F(Tool, AMirroredParentTurnsAsThePointerDoes) {
  EditedWorld mirrored("#X3D V3.3 utf8\nPROFILE Immersive\nTransform { scale -1 1 1 children "
                       "DEF T Transform { children Shape { geometry Box { } } } }\n",
                       "x3dv");
  mirrored.editor.select({mirrored.node("T")});
  TransformTool tool(mirrored.editor, Kind::turn, view, 0, 0);
  tool.chooseAxis(2);
  for (const char* key : {"9", "0"}) tool.type(key);
  tool.point(mirrored.editor, 0, 0);
  NodePlacement placement;
  ASSERT_TRUE(mirrored.browser.locate(*mirrored.node("T"), placement));
  // The mirrored x axis (-1, 0, 0) becomes (0, -1, 0).
  EXPECT_NEAR(placement.path.back().toWorld[1], -1, 1e-5);
  tool.cancel(mirrored.editor);
}

TEST_F(Tool, AfterUndoWhatWasMovedIsSelectedAgain) {
  world.editor.select({world.node("S")});
  TransformTool tool(world.editor, Kind::move, view, 0, 0);
  tool.point(world.editor, 0.3, 0.2);
  tool.accept(world.editor);
  ASSERT_EQ(world.editor.selected()->type().name, "Transform");
  EXPECT_NE(world.editor.selected(), world.node("T").get());
  for (int i = 0; i < 2; ++i) {
    world.editor.undo();
    EXPECT_EQ(world.editor.selection(), MFNode{world.node("S")});
    EXPECT_EQ(world.editor.editor().text(), text);
    world.editor.redo();
  }
}

TEST(RotationOf, AnglesAreFromZeroToPi) {
  Imath::Quatd turn;
  turn.setAxisAngle(Imath::V3d(0, 1, 0), 4);
  const Rotation rotation = rotationOf(turn);
  EXPECT_NEAR(rotation.y, -1, 1e-6);
  EXPECT_NEAR(rotation.angle, 2 * std::numbers::pi - 4, 1e-6);
  const Rotation none = rotationOf(Imath::Quatd());
  EXPECT_EQ(none.z, 1);
  EXPECT_EQ(none.angle, 0);
}

} // namespace
