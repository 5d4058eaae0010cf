// editor_gizmo.cpp: Tests where the handles of the selected node are seen, and that dragging one of
// them does what it shows.
#include <cmath>

#include "edit/gizmo.h"
#include "unit/editor_support.h"
#include "xvrml/nodes.h"

namespace {

using namespace editor_test;
using namespace vv;
using namespace xvrml;
using Kind = TransformTool::Kind;

constexpr const char* text =
    "#VRML V2.0 utf8\n"
    "DEF OUTER Transform { translation 1 0.5 0 rotation 0 0 1 0.5 scale 2 1 1 children [\n"
    "  DEF T Transform { rotation 0 0 1 0.3 children [\n"
    "    DEF S Shape { appearance Appearance { material DEF M Material { } }\n"
    "      geometry DEF G Box { size 0.4 0.2 0.2 } } ] } ] }\n"
    "DEF LAMP PointLight { }\n";

// A viewer who sees the axes of the world at an angle, from 8 away.
EditView aslant(double aspect = 1.5) {
  EditView view = front(aspect);
  const Imath::V3d back = Imath::V3d(2, 1.5, 3).normalized(),
                   right = Imath::V3d(0, 1, 0).cross(back).normalized(), up = back.cross(right);
  const Imath::V3d columns[] = {right, up, back, Imath::V3d(1, 0.5, 0) + back * 8.};
  for (size_t i = 0; i < 4; ++i)
    for (size_t k = 0; k < 3; ++k) view.camera.matrix[4 * i + k] = columns[i][int(k)];
  return view;
}

struct Handles : testing::Test {
  EditedWorld world{text};
  EditView view = aslant();
  Gizmo gizmo;

  void SetUp() override { world.editor.select({world.node("T")}); }
  bool place() { return gizmo.place(world.editor, view); }
  void show(Kind kind) {
    while (gizmo.kind() != kind) gizmo.cycle();
    place();
  }
  // The place of a point of the world in the picture.
  std::array<double, 2> seen(const Imath::V3d& point) const {
    std::array<double, 2> at{};
    EXPECT_TRUE(projectPoint(view.camera, view.aspect, &point.x, at[0], at[1]));
    return at;
  }
  std::array<double, 16> matrix() {
    NodePlacement placement;
    EXPECT_TRUE(world.browser.locate(*world.node("T"), placement));
    return placement.path.back().toWorld;
  }
  Imath::V3d origin() {
    const auto m = matrix();
    return {m[12], m[13], m[14]};
  }
  double length(const Gizmo::Handle& handle) {
    const std::array<double, 2> pivot = seen(origin());
    return std::hypot((handle.end[0] - pivot[0]) * view.aspect, handle.end[1] - pivot[1]);
  }
};

TEST_F(Handles, ArrowsPointAlongTheAxesOfTheWorld) {
  place();
  ASSERT_EQ(gizmo.handles().size(), 3u);
  const double size = .3 * halfHeightAt(view, origin());
  EXPECT_NEAR(size, .3 * 8 * std::tan(view.camera.fovy / 2), 1e-6);
  for (int axis = 0; axis < 3; ++axis) {
    Imath::V3d end = origin();
    end[axis] += size;
    const Gizmo::Handle& handle = gizmo.handles()[size_t(axis)];
    EXPECT_EQ(handle.axis, axis);
    EXPECT_NEAR(handle.end[0], seen(end)[0], 1e-6);
    EXPECT_NEAR(handle.end[1], seen(end)[1], 1e-6);
  }
}

TEST_F(Handles, TheyHaveOneSizeInThePicture) {
  place();
  std::vector<double> near;
  for (const Gizmo::Handle& handle : gizmo.handles()) near.push_back(length(handle));
  for (size_t k = 0; k < 3; ++k) view.camera.matrix[12 + k] += 92 * view.camera.matrix[8 + k];
  place();
  for (size_t i = 0; i < 3; ++i) // perspective shortens them a little less from afar
    EXPECT_NEAR(length(gizmo.handles()[i]), near[i], .05);
}

TEST_F(Handles, AHandleIsFoundAtItsPlace) {
  for (const Kind kind : {Kind::move, Kind::turn, Kind::scale}) {
    show(kind);
    ASSERT_EQ(gizmo.handles().size(), 3u) << int(kind);
    for (const Gizmo::Handle& handle : gizmo.handles())
      EXPECT_EQ(gizmo.axisAt(handle.end[0], handle.end[1]), handle.axis) << int(kind);
    EXPECT_EQ(gizmo.axisAt(-.9, .9), -1);
    if (kind == Kind::turn) continue;
    EXPECT_EQ(gizmo.axisAt(seen(origin())[0], seen(origin())[1]), -1) << "free for clicks";
  }
}

TEST_F(Handles, AKeyGoesThroughTheKinds) {
  EXPECT_EQ(gizmo.kind(), Kind::move);
  gizmo.cycle();
  EXPECT_EQ(gizmo.kind(), Kind::turn);
  gizmo.cycle();
  EXPECT_EQ(gizmo.kind(), Kind::scale);
  gizmo.cycle();
  EXPECT_FALSE(gizmo.kind());
  place();
  EXPECT_TRUE(gizmo.handles().empty());
  gizmo.cycle();
  EXPECT_EQ(gizmo.kind(), Kind::move);
  EXPECT_TRUE(place());
  EXPECT_FALSE(place()) << "nothing else is shown";
}

TEST_F(Handles, OneNodeWithAPlaceHasThem) {
  for (const char* name : {"T", "OUTER", "S", "LAMP"}) {
    world.editor.select({world.node(name)});
    place();
    EXPECT_EQ(gizmo.handles().size(), 3u) << name;
  }
  for (const char* name : {"M", "G"}) {
    world.editor.select({world.node(name)});
    place();
    EXPECT_TRUE(gizmo.handles().empty()) << name;
  }
  world.editor.select({world.node("T"), world.node("LAMP")});
  place();
  EXPECT_TRUE(gizmo.handles().empty());
  world.editor.select({});
  place();
  EXPECT_TRUE(gizmo.handles().empty());
}

TEST_F(Handles, AnArrowThatPointsAtTheViewerIsLeftOut) {
  view = front();
  view.camera.matrix[12] = 1;
  view.camera.matrix[13] = .5;
  for (const double fovy : {view.camera.fovy, 0.}) {
    view.camera.fovy = fovy;
    view.camera.height = 8;
    show(Kind::move);
    ASSERT_EQ(gizmo.handles().size(), 2u);
    EXPECT_EQ(gizmo.handles()[0].axis, 0);
    EXPECT_EQ(gizmo.handles()[1].axis, 1);
    show(Kind::turn);
    EXPECT_EQ(gizmo.handles().size(), 3u) << "rings are lines at least";
    gizmo.cycle(); // to scale
    gizmo.cycle();
    gizmo.cycle();
  }
}

TEST_F(Handles, AParallelViewHasThemInItsOwnSize) {
  view.camera.fovy = 0;
  view.camera.height = 10;
  place();
  ASSERT_EQ(gizmo.handles().size(), 3u);
  // The length of the y axis, seen from above at an angle: .3 of the half height times its cosine.
  const double across = std::sqrt(1 - std::pow(view.camera.matrix[9], 2));
  EXPECT_NEAR(length(gizmo.handles()[1]), .3 * across, 1e-6);
}

TEST_F(Handles, BehindTheViewerThereAreNone) {
  view = front();
  view.camera.matrix[14] = -10;
  place();
  EXPECT_TRUE(gizmo.handles().empty());
}

// Drags the handle of an axis by a tenth of the picture along itself, as the window does.
void drag(WorldEditor& editor, const Gizmo& gizmo, const EditView& view, int axis, double part) {
  const auto handle = std::find_if(gizmo.handles().begin(), gizmo.handles().end(),
                                   [axis](const auto& one) { return one.axis == axis; });
  ASSERT_NE(handle, gizmo.handles().end());
  const EditModel::Line line = handle->lines.front();
  TransformTool tool(editor, *gizmo.kind(), view, line.x1, line.y1);
  tool.chooseAxis(axis);
  tool.point(editor, line.x1 + part * (line.x1 - line.x0), line.y1 + part * (line.y1 - line.y0));
  tool.accept(editor);
}

TEST_F(Handles, AnArrowMovesAlongIt) {
  show(Kind::move);
  for (int axis = 0; axis < 3; ++axis) {
    const Imath::V3d before = origin();
    place();
    drag(world.editor, gizmo, view, axis, .5);
    const Imath::V3d way = origin() - before;
    EXPECT_GT(way[axis], .1);
    EXPECT_NEAR(way[(axis + 1) % 3], 0, 1e-5);
    EXPECT_NEAR(way[(axis + 2) % 3], 0, 1e-5);
  }
}

TEST_F(Handles, ABoxScalesAlongTheNodesOwnAxis) {
  show(Kind::scale);
  const auto before = matrix();
  // The arrow of x is the node's own axis: the first column of its matrix.
  const Imath::V3d own = Imath::V3d(before[0], before[1], before[2]).normalized();
  const std::array<double, 2> end = seen(origin() + own * .3 * halfHeightAt(view, origin()));
  EXPECT_NEAR(gizmo.handles()[0].end[0], end[0], 1e-6);
  EXPECT_NEAR(gizmo.handles()[0].end[1], end[1], 1e-6);
  drag(world.editor, gizmo, view, 0, .5);
  const Vec3f scale = static_cast<nodes::Transform&>(*world.node("T")).scale;
  EXPECT_GT(scale.x, 1.2f);
  EXPECT_EQ(scale.y, 1);
  EXPECT_EQ(scale.z, 1);
}

// A ring that is seen as a circle, and one that is seen as a line: the near side follows.
TEST_F(Handles, ARingTurnsAsThePointerDoes) {
  EditedWorld plain("#VRML V2.0 utf8\nDEF T Transform { children Shape { geometry Box { } } }\n");
  plain.editor.select({plain.node("T")});
  const auto turned = [&plain](int axis, double x0, double y0, double x1, double y1) {
    TransformTool tool(plain.editor, Kind::turn, front(), x0, y0);
    tool.chooseAxis(axis);
    tool.point(plain.editor, x1, y1);
    const Rotation rotation = static_cast<nodes::Transform&>(*plain.node("T")).rotation;
    tool.cancel(plain.editor);
    const float component = axis == 0 ? rotation.x : axis == 1 ? rotation.y : rotation.z;
    EXPECT_NEAR(std::abs(component), 1, 1e-5);
    return double(component * rotation.angle);
  };
  EXPECT_NEAR(turned(2, .3, 0, 0, .3), M_PI / 2, 1e-5);
  // To the right about y, upwards about -x: the radius of the ring is .3 of the picture's half.
  EXPECT_NEAR(turned(1, 0, 0, .15, 0), .5, 1e-5);
  EXPECT_NEAR(turned(0, 0, 0, 0, .15), -.5, 1e-5);
  EXPECT_NEAR(turned(1, .1, .2, .04, .2), -.2, 1e-5);
}

TEST(HandlesOf, MirroredAndFlatParents) {
  EditedWorld world("#X3D V3.3 utf8\nPROFILE Immersive\n"
                    "Transform { scale -1 1 1 children DEF T Transform { translation 1 0 0 "
                    "children Shape { geometry Box { } } } }\n",
                    "x3dv");
  world.editor.select({world.node("T")});
  Gizmo gizmo;
  EditView view = aslant(1);
  view.camera.matrix[12] -= 2; // the node is seen at -1
  gizmo.place(world.editor, view);
  ASSERT_EQ(gizmo.handles().size(), 3u);
  drag(world.editor, gizmo, view, 0, .5);
  EXPECT_LT(static_cast<nodes::Transform&>(*world.node("T")).translation.x, .9f)
      << "to the right in the world is to the left in a mirror";
  auto& outer = static_cast<nodes::Transform&>(*world.browser.world().scope.roots.front());
  outer.scale = {1, 0, 1};
  gizmo.place(world.editor, view);
  EXPECT_TRUE(gizmo.handles().empty()) << "there is no way back from a flat place";
}

TEST_F(Handles, AnArrowBelowAPanelPointsTheOtherWay) {
  const Imath::V3d pivot = origin();
  place();
  const double right = gizmo.handles()[0].end[0];
  ASSERT_GT(right, seen(pivot)[0]) << "the x axis goes to the right";
  FreePart free{-1, (right + seen(pivot)[0]) / 2};
  EXPECT_TRUE(gizmo.place(world.editor, view, free));
  ASSERT_EQ(gizmo.handles().size(), 3u);
  const Gizmo::Handle& arrow = gizmo.handles()[0];
  EXPECT_TRUE(arrow.isOpposite);
  EXPECT_LT(arrow.end[0], seen(pivot)[0]);
  EXPECT_FALSE(gizmo.handles()[1].isOpposite);
  const double before = origin().x;
  drag(world.editor, gizmo, view, 0, .1);
  EXPECT_NE(origin().x, before) << "it moves the node all the same";
  free = {seen(pivot)[0] - 1e-3, seen(pivot)[0] + 1e-3};
  gizmo.place(world.editor, view, free);
  EXPECT_FALSE(gizmo.handles()[0].isOpposite) << "neither end is free";
}

} // namespace
