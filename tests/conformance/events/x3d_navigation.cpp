// x3d_navigation.cpp: what X3D adds to viewpoints and navigation (ISO/IEC 19775-1 clause 23), and
// to LOD and Switch: expectations follow from the clauses.
#include "behaviour/viewer/interaction.h"
#include "conformance/events/viewing.h"
#include "xvrml/nodes.h"

namespace xvrml {
namespace {

const std::string head = "#X3D V3.3 utf8\nPROFILE Immersive\n";

// 23.4.5: the extents are what is seen at least; a picture of another shape shows more.
TEST(OrthoViewpoint, ShowsItsExtent) {
  Running r(head + "OrthoViewpoint { fieldOfView [ -2 -1 2 1 ] position 1 2 3 }");
  CameraSettings camera = r.browser.camera(2);
  EXPECT_EQ(camera.fovy, 0);
  EXPECT_NEAR(camera.height, 2, 1e-9);
  EXPECT_NEAR(r.browser.camera(1).height, 4, 1e-9); // the width decides
  EXPECT_NEAR(r.browser.camera(4).height, 2, 1e-9); // the height decides
  EXPECT_NEAR(camera.matrix[12], 1, 1e-6);
}

TEST(OrthoViewpoint, AnExtentAsideMovesThePicture) {
  // Turned by a quarter about y: the picture's x axis is -z of the world.
  Running r(head + "Transform { scale 3 3 3 children OrthoViewpoint { fieldOfView [ 0 1 2 5 ] "
                   "position 0 0 0 orientation 0 1 0 1.5707963 } }");
  const CameraSettings camera = r.browser.camera(0.5);
  EXPECT_NEAR(camera.height, 12, 1e-5); // 4 by 2 units of a system that is three times as large
  EXPECT_NEAR(camera.matrix[12], 0, 1e-5);
  EXPECT_NEAR(camera.matrix[13], 9, 1e-5);
  EXPECT_NEAR(camera.matrix[14], -3, 1e-5);
}

TEST(OrthoViewpoint, AnExtentThatIsNoneIsTheDefault) {
  for (const char* extent : {"[ ]", "[ 1 2 3 ]", "[ 1 1 -1 -1 ]", "[ 0 0 0 1 ]"}) {
    Running r(head + "OrthoViewpoint { fieldOfView " + extent + " }");
    EXPECT_NEAR(r.browser.camera(1).height, 2, 1e-9) << extent;
  }
}

// The pointer's rays are parallel.
TEST(OrthoViewpoint, PointsAtWhatItShows) {
  Running r(head + "OrthoViewpoint { fieldOfView [ -4 -4 4 4 ] } Transform { translation 3 3 0 "
                   "children [ DEF T TouchSensor { } Shape { geometry Box { } } ] }");
  r.log("T", "isOver");
  r.browser.setAspect(1);
  r.browser.pointer(0.75, 0.75, false);
  EXPECT_EQ(r.take(), Log{"0 T.isOver TRUE"});
  r.browser.pointer(0.3, 0.3, false);
  EXPECT_EQ(r.take(), Log{"0 T.isOver FALSE"});
}

TEST(ViewpointGroup, IsListedUnlessItIsNotDisplayed) {
  Running r(head + "Viewpoint { description \"a\" } ViewpointGroup { children [ Viewpoint { "
                   "description \"b\" } ViewpointGroup { displayed FALSE children DEF C Viewpoint "
                   "{ description \"c\" } } OrthoViewpoint { description \"d\" } ] }");
  std::string list;
  for (const ViewpointName& one : r.browser.viewpoints()) list += one.description;
  EXPECT_EQ(list, "abd");
  EXPECT_TRUE(r.browser.bindViewpoint("C")); // it can be bound all the same
}

// 23.3.1: EXAMINE turns about centerOfRotation, given in the viewpoint's coordinate system.
TEST(CenterOfRotation, IsWhatExamineTurnsAbout) {
  Running r(head + "NavigationInfo { type \"EXAMINE\" } Transform { translation 0 0 5 children "
                   "Viewpoint { position 0 0 3 centerOfRotation 0 0 -1 } }");
  const auto distance = [&] {
    const CameraSettings c = r.browser.camera(1);
    return std::hypot(c.matrix[12], c.matrix[13], c.matrix[14] - 4);
  };
  EXPECT_NEAR(distance(), 4, 1e-5);
  for (int i = 0; i < 5; ++i) {
    r.browser.navigate({.turn = 1}, 0.3);
    EXPECT_NEAR(distance(), 4, 1e-5);
  }
  EXPECT_GT(std::abs(r.browser.camera(1).matrix[12]), 0.1);
}

// 23.3.1: retainUserOffsets keeps how far the viewer has gone until the node is bound again.
TEST(RetainUserOffsets, BringsTheViewerBack) {
  for (const bool retains : {true, false}) {
    Running r(head +
              "NavigationInfo { type \"FLY\" speed 1 } DEF A Viewpoint { position 0 0 10 "
              "retainUserOffsets " +
              (retains ? "TRUE" : "FALSE") + " } DEF B Viewpoint { position 5 0 0 }");
    r.browser.navigate({.ahead = 1}, 2);
    EXPECT_EQ(eyeOf(r.browser), "0 0 8");
    r.set("B", "set_bind", true);
    EXPECT_EQ(eyeOf(r.browser), "5 0 0");
    r.set("A", "set_bind", true);
    EXPECT_EQ(eyeOf(r.browser), retains ? "0 0 8" : "0 0 10");
    r.set("A", "set_bind", false);
    EXPECT_EQ(eyeOf(r.browser), "5 0 0");
    r.set("A", "set_bind", true); // it had left the stack
    EXPECT_EQ(eyeOf(r.browser), retains ? "0 0 8" : "0 0 10");
  }
}

// 23.4.4: transitionType and transitionTime say how the view changes, where it moves at all.
TEST(Transition, TakesTheTimeOfNavigationInfo) {
  Running r(head + "DEF N NavigationInfo { transitionTime 4 } Viewpoint { position 0 0 10 } DEF B "
                   "Viewpoint { position 10 0 10 }");
  r.browser.setTransition(1);
  r.log("N", "transitionComplete");
  r.set("B", "set_bind", true);
  r.browser.tick(2);
  EXPECT_EQ(eyeOf(r.browser), "5 0 10"); // smooth, so half of the way is at half of the time
  EXPECT_EQ(r.take(), Log{});
  r.browser.tick(4);
  EXPECT_EQ(eyeOf(r.browser), "10 0 10");
  EXPECT_EQ(r.take(), Log{"4 N.transitionComplete TRUE"});
}

TEST(Transition, TeleportIsAtOnce) {
  Running r(head + "DEF N NavigationInfo { transitionType \"TELEPORT\" } Viewpoint { } DEF B "
                   "Viewpoint { position 10 0 10 }");
  r.browser.setTransition(1);
  r.log("N", "transitionComplete");
  r.set("B", "set_bind", true);
  EXPECT_EQ(eyeOf(r.browser), "10 0 10");
  EXPECT_EQ(r.take(), Log{"0 N.transitionComplete TRUE"});
}

TEST(NavigationType, ExamineIsTheDefaultOfX3d) {
  for (const char* info : {"", "NavigationInfo { }"}) {
    Running x3d(head + info + " Group { }");
    EXPECT_EQ(x3d.browser.navigation(), Navigation::examine) << info;
    Running vrml(std::string(info) + " Group { }");
    EXPECT_EQ(vrml.browser.navigation(), Navigation::walk) << info;
  }
}

// Each encoding writes the type that the other one has as its default.
TEST(NavigationType, IsKeptByWriters) {
  Running vrml("NavigationInfo { }"), x3d(head + "NavigationInfo { }");
  for (Running* r : {&vrml, &x3d})
    for (const Encoding encoding : {Encoding::vrml97, Encoding::x3dClassic, Encoding::x3dXml}) {
      const auto again = loadWorldFromMemory(writeWorld(r->browser.world(), "", encoding), "again");
      const auto* info = nodeCast<nodes::NavigationInfo>(again->scope.roots[0]);
      ASSERT_NE(info, nullptr);
      EXPECT_EQ(info->type[0], r == &vrml ? "WALK" : "EXAMINE");
    }
}

// 10.4.4, 23.4.3: LOD and Switch have addChildren and removeChildren, as groups have.
TEST(AddChildren, OfSwitchAndLod) {
  for (const char* type : {"Switch", "LOD"}) {
    Running r(head + "DEF S " + type + " { children DEF A Group { } } DEF B Group { }");
    const char* list = type == std::string("LOD") ? "level" : "choice";
    r.set("S", "addChildren", MFNode{r.browser.node("B")});
    EXPECT_EQ(r.get("S", list), "[A, B]") << type;
    r.set("S", "removeChildren", MFNode{r.browser.node("A")});
    EXPECT_EQ(r.get("S", list), "[B]") << type;
  }
}

// ISO/IEC 19775-1:2023 10.3.1: what is invisible is not drawn, and so no pointer is over it.
TEST(Visible, DecidesWhatIsPointedAt) {
  Running r(head + "DEF G Group { visible FALSE children [ DEF T TouchSensor { } DEF S Shape { "
                   "geometry Box { } } ] }");
  r.log("T", "isOver");
  r.browser.pointer(0, 0, false);
  EXPECT_EQ(r.take(), Log{});
  r.set("G", "visible", true);
  r.browser.pointer(0.01, 0, false); // sensors are told of a pointer that moves
  EXPECT_EQ(r.take(), Log{"0 T.isOver TRUE"});
  r.set("S", "visible", false);
  r.browser.pointer(0.02, 0, false);
  EXPECT_EQ(r.take(), Log{"0 T.isOver FALSE"});
}

} // namespace
} // namespace xvrml
