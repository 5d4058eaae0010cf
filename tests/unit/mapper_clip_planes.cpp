// mapper_clip_planes.cpp: what ClipPlanes leave of what is drawn (ISO/IEC 19775-1 11.4.1), by the
// bounds of the world and by the objects that are written: scope, nesting, events, and groups that
// move, turn or change below them.
#include <cmath>

#include <fmt/format.h>

#include "unit/mapper_fixture.h"

using namespace xvrml;
using namespace xvrml::test;

namespace {

class MapClipPlanes : public MapRunning {
 protected:
  void loadX3d(const std::string& body, size_t warnings = 0) {
    mapper_.reset();
    engine_.reset();
    world_ = loadWorldFromMemory("#X3D V3.3 utf8\nPROFILE Full\n" + body, "test.x3dv");
    EXPECT_EQ(world_->diagnostics.list().size(), 0u);
    engine_ = std::make_unique<Engine>(world_->diagnostics, makeInteraction);
    engine_->adoptScope(world_->scope, true);
    mapper_ = std::make_unique<OpenRTMapper>(*world_, MapOptions());
    frame();
    EXPECT_EQ(world_->diagnostics.list().size(), warnings);
  }
  static double rounded(double x) { return std::round(x * 1e5) / 1e5 + 0.0; }
  std::string extent() {
    const Bounds b = mapper_->bounds();
    if (b.empty) return "empty";
    std::string text;
    for (int i = 0; i < 3; ++i)
      text += fmt::format("{}{:g}..{:g}", i == 0 ? "" : " ", rounded(b.minimum[i]),
                          rounded(b.maximum[i]));
    return text;
  }
  // Compares with a mapper that sees the world for the first time.
  void expectAsFresh() {
    frame();
    const RTcontext own = rtGetCurrent(), other = rtNewContext("threads=1");
    {
      OpenRTMapper fresh(*world_, MapOptions());
      fresh.map(mapper_->viewpointCamera(0));
      const Bounds a = mapper_->bounds(), b = fresh.bounds();
      EXPECT_EQ(structure(*mapper_), structure(fresh));
      for (int i = 0; i < 3; ++i) {
        EXPECT_EQ(a.minimum[i], b.minimum[i]);
        EXPECT_EQ(a.maximum[i], b.maximum[i]);
      }
    }
    rtDeleteContext(other);
    rtMakeCurrent(own);
  }
  uint64_t trianglesDrawn() {
    uint64_t sum = 0;
    for (const ExplainedObject& o : mapper_->explain()) sum += o.triangles * o.instances;
    return sum;
  }
};

const std::string box = "Shape { geometry Box { } }";

TEST_F(MapClipPlanes, CutTheSiblingsAndAllBelowThem) {
  loadX3d("Group { children [ " + box +
          " ClipPlane { plane 1 0 0 -0.5 } Transform { translation 0 5 "
          "0 children " +
          box + " } ] }\n");
  EXPECT_EQ(extent(), "0.5..1 -1..6 -1..1");
}

TEST_F(MapClipPlanes, CutNothingOutsideOfTheirGroup) {
  loadX3d(box + " Group { children [ ClipPlane { plane 1 0 0 -9 } " + box + " ] }\n");
  EXPECT_EQ(extent(), "-1..1 -1..1 -1..1");
  EXPECT_EQ(trianglesDrawn(), 12u);
}

TEST_F(MapClipPlanes, AreInTheCoordinatesOfTheirGroup) {
  loadX3d("Transform { translation 10 0 0 rotation 0 0 1 1.5707963 scale 2 2 2 children [ " + box +
          " ClipPlane { plane 1 0 0 0 } ] }\n");
  EXPECT_EQ(extent(), "8..12 0..2 -2..2"); // the group's x is the world's y
}

TEST_F(MapClipPlanes, OfTheWorldCutAllOfIt) {
  loadX3d("ClipPlane { plane 0 -1 0 0.25 }\n" + box + "\nTransform { translation 3 0 0 children " +
          box + " }\n");
  EXPECT_EQ(extent(), "-1..4 -1..0.25 -1..1");
}

TEST_F(MapClipPlanes, OfAllGroupsAboveAddUp) {
  loadX3d(
      "Group { children [ ClipPlane { plane 1 0 0 0 } Transform { translation 0.5 0 0 children [ "
      "ClipPlane { plane 0 1 0 0 } ClipPlane { plane -1 0 0 0.25 } " +
      box + " ] } ] }\n");
  EXPECT_EQ(extent(), "0..0.75 0..1 -1..1");
}

TEST_F(MapClipPlanes, ThatAreOffOrNoPlaneCutNothing) {
  loadX3d("Group { children [ ClipPlane { enabled FALSE plane 1 0 0 -9 } " + box + " ] }\n");
  EXPECT_EQ(extent(), "-1..1 -1..1 -1..1");
  loadX3d("Group { children [ ClipPlane { plane 0 0 0 -1 } " + box + " ] }\n", 1);
  EXPECT_EQ(extent(), "-1..1 -1..1 -1..1");
  EXPECT_EQ(world_->diagnostics.list()[0].text(),
            "test.x3dv:3:20: warning: ClipPlane: plane needs a direction: its first three numbers "
            "are 0; nothing is cut away");
}

TEST_F(MapClipPlanes, MayHaveNumbersOfAnySize) {
  for (const float factor : {1e-38f, 1e-20f, 3.f, 1e20f, 1e38f}) {
    loadX3d(fmt::format("Group {{ children [ ClipPlane {{ plane {} 0 0 {} }} {} ] }}\n", factor,
                        -factor / 2, box));
    EXPECT_EQ(extent(), "0.5..1 -1..1 -1..1") << factor;
  }
}

TEST_F(MapClipPlanes, CutSpheresConesLinesAndPoints) {
  for (const std::string geometry : {"Sphere { }", "Cylinder { }", "Cone { }"}) {
    loadX3d("Group { children [ ClipPlane { plane 0 1 0 -0.5 } Shape { geometry " + geometry +
            " } ] }\n");
    EXPECT_FLOAT_EQ(float(mapper_->bounds().minimum[1]), 0.5f) << geometry;
    EXPECT_FLOAT_EQ(float(mapper_->bounds().maximum[1]), 1.0f) << geometry;
  }
  loadX3d("Group { children [ ClipPlane { plane 1 0 0 0 } Shape { geometry IndexedLineSet { coord "
          "Coordinate { point [ -1 0 0, 1 2 0, -1 5 0, -2 5 0 ] } coordIndex [ 0 1 -1 2 3 ] } } "
          "Shape { geometry PointSet { coord Coordinate { point [ -3 0 0, 0 0 3 ] } } } ] }\n");
  EXPECT_EQ(extent(), "0..1 0..2 0..3");
}

TEST_F(MapClipPlanes, KeepWhatIsInstancedElsewhereWhole) {
  loadX3d("DEF B Shape { geometry DEF G " + grid(60) + " }\n" +
          repeat("Transform { translation 0 9 0 children USE B }\n", 6) +
          "Group { children [ ClipPlane { plane 1 0 0 -30 } USE B Shape { geometry USE G } ] }\n");
  EXPECT_EQ(trianglesDrawn(), 7200u * 7 + 3600u * 2);
}

TEST_F(MapClipPlanes, FollowEvents) {
  loadX3d("Group { children [ DEF C ClipPlane { plane 1 0 0 0 } DEF T Transform { children DEF S " +
          box + " } ] }\n" + box + "\n");
  for (const float d : {-0.5f, -0.25f, -2.f, 0.f}) {
    send("C", "set_plane", Vec4f{1, 0, 0, d});
    cost();
    expectAsFresh();
  }
  send("T", "set_translation", Vec3f{0.75f, 3, 0});
  frame();
  EXPECT_EQ(extent(), "-1..1.75 -1..4 -1..1");
  expectAsFresh();
  send("T", "set_translation", Vec3f{-0.75f, 3, 0});
  const Cost moved = cost();
  EXPECT_EQ(moved.regroupings, 0u);
  EXPECT_EQ(moved.defined, 1u) << "the group alone is written again";
  EXPECT_EQ(extent(), "-1..1 -1..4 -1..1");
  expectAsFresh();
  send("C", "set_enabled", false);
  frame();
  EXPECT_EQ(extent(), "-1.75..1 -1..4 -1..1");
  expectAsFresh();
}

TEST_F(MapClipPlanes, ThatMoveWithTheirGroupCutNothingAnew) {
  loadX3d("DEF T Transform { children [ ClipPlane { plane 1 0 0 0 } " + box +
          " ] }\nDEF I "
          "PositionInterpolator { }\nROUTE I.value_changed TO T.set_translation\n");
  send("T", "set_translation", Vec3f{5, 0, 0});
  EXPECT_EQ(cost(), (Cost{.moved = 1}));
  EXPECT_EQ(extent(), "5..6 -1..1 -1..1");
}

TEST_F(MapClipPlanes, ThatComeAndGoChangeTheirGroup) {
  loadX3d("DEF G Group { children [ Transform { translation 1 0 0 children " + box +
          " } ] }\nDEF T "
          "Transform { translation 0 9 0 children USE G }\n");
  EXPECT_EQ(extent(), "0..2 -1..10 -1..1");
  scraps_.push_back(loadWorldFromMemory(
      "#X3D V3.3 utf8\nPROFILE Full\nClipPlane { plane -1 0 0 0.5 }\n", "scrap.x3dv"));
  const NodeRef plane = scraps_.back()->scope.roots.at(0);
  send("G", "addChildren", MFNode{plane});
  frame();
  EXPECT_EQ(extent(), "0..0.5 -1..10 -1..1");
  expectAsFresh();
  send("G", "removeChildren", MFNode{plane});
  frame();
  EXPECT_EQ(extent(), "0..2 -1..10 -1..1");
  expectAsFresh();
}

TEST_F(MapClipPlanes, CutThroughObjectsOfTheirOwnBelow) {
  loadX3d(
      "DEF T Transform { children [ ClipPlane { plane 1 0 0 0 } Transform { translation 0.5 0 0 "
      "children [ LOD { children " +
      box + " } Group { children [ DirectionalLight { } " + box +
      " ] } DEF D Transform { translation 0 3 0 children LOD { children " + box + " } } ] } ] }\n");
  EXPECT_EQ(extent(), "0..1.5 -1..4 -1..1");
  send("D", "set_translation", Vec3f{-1, 4, 0});
  frame();
  EXPECT_EQ(extent(), "0..1.5 -1..5 -1..1");
  expectAsFresh();
  send("T", "set_translation", Vec3f{7, 0, 0});
  frame();
  EXPECT_EQ(extent(), "7..8.5 -1..5 -1..1");
  expectAsFresh();
}

TEST_F(MapClipPlanes, CutBillboardsAsTheyTurn) {
  loadX3d(
      "Viewpoint { position 0 0 10 }\nGroup { children [ ClipPlane { plane 0 0 1 0 } Billboard { "
      "children Shape { geometry Box { size 2 2 6 } } } ] }\n");
  CameraSettings beside = mapper_->viewpointCamera(0);
  beside.matrix[12] = 10; // position and direction: the viewer stands on the x axis
  beside.matrix[14] = 0;
  const uint64_t before = mapper_->stats().objectsDefined;
  mapper_->map(beside);
  EXPECT_EQ(mapper_->stats().objectsDefined, before + 1);
  mapper_->map(beside);
  EXPECT_EQ(mapper_->stats().objectsDefined, before + 1);
  EXPECT_EQ(extent(), "-3..3 -1..1 0..1");
}

TEST_F(MapClipPlanes, WarnOfMoreThanSixteen) {
  loadX3d("Group { children [ " + repeat("ClipPlane { plane 1 0 0 0.9 } ", 16) +
              "ClipPlane { plane 1 0 0 -0.9 } " + box + " ] }\n",
          1);
  EXPECT_EQ(extent(), "-0.9..1 -1..1 -1..1");
  // Also in groups within each other: memory does not grow with the square of the depth.
  std::string text = box;
  for (int i = 0; i < 200; ++i)
    text = "Group { children [ ClipPlane { plane 1 0 0 0." + std::to_string(100 + i) + " } " +
           text + " ] }";
  loadX3d(text + "\n", 1);
  EXPECT_EQ(extent(), "-0.284..1 -1..1 -1..1"); // the outermost planes count: 0.299 to 0.284
}

} // namespace
