// pointing.cpp: picking, TouchSensor, Anchor, and which sensor receives the pointer: clauses
// 4.6.7.3, 6.51, 6.2.
#include <filesystem>
#include <fstream>

#include "conformance/events/viewing.h"

namespace xvrml {
namespace {

// Moves the pointer to (x, y), looking along -z.
void at(Running& r, double x, double y, bool button = false) {
  const double origin[3] = {x, y, 10}, direction[3] = {0, 0, -1};
  r.browser.pointerRay(origin, direction, button);
}

bool pickAt(Running& r, double x, double y, PickHit& hit, PickOptions options = {}, double z = 10) {
  const double origin[3] = {x, y, z}, direction[3] = {0, 0, z > 0 ? -1.0 : 1.0};
  return r.browser.pick(origin, direction, options, hit);
}

std::string text(const std::array<double, 3>& v) {
  return fmt::format("{:g} {:g} {:g}", tidy(v[0]), tidy(v[1]), tidy(v[2]));
}

const std::string box = "Shape { geometry Box {} } ";

TEST(Picking, FindsTheNearestShapeWithItsPathAndPlaces) {
  Running r("DEF T Transform { translation 1 0 0 scale 2 2 2 children [ DEF S Shape { geometry Box "
            "{} } ] }"
            "Transform { translation 0 0 -5 children Shape { geometry Box { size 100 100 1 } } }");
  PickHit hit;
  ASSERT_TRUE(pickAt(r, 1.5, 0.5, hit));
  EXPECT_EQ(hit.distance, 8);
  EXPECT_EQ(text(hit.point), "1.5 0.5 2");
  EXPECT_EQ(text(hit.normal), "0 0 1");
  EXPECT_FLOAT_EQ(hit.texCoord.x, 0.625f); // a quarter of the face's width from its centre
  EXPECT_FLOAT_EQ(hit.texCoord.y, 0.625f);
  ASSERT_EQ(hit.path.size(), 2u);
  EXPECT_EQ(hit.path[0].node->defName, "T");
  EXPECT_EQ(hit.path[1].node->defName, "S");
  EXPECT_EQ(hit.path[1].toWorld[0], 2);
  ASSERT_TRUE(pickAt(r, -20, 0, hit));
  EXPECT_EQ(text(hit.point), "-20 0 -4.5");
  EXPECT_FALSE(pickAt(r, 80, 0, hit));
}

TEST(Picking, SpheresAreExactAndTexturesBeginAtTheirBack) {
  Running r("Shape { geometry Sphere { radius 2 } }");
  PickHit hit;
  ASSERT_TRUE(pickAt(r, 1.2, 0, hit));
  EXPECT_NEAR(hit.point[2], 1.6, 1e-12);
  EXPECT_NEAR(hit.normal[0], 0.6, 1e-12);
  ASSERT_TRUE(pickAt(r, 0, 0, hit));
  EXPECT_FLOAT_EQ(hit.texCoord.x, 0.5f);
  EXPECT_FLOAT_EQ(hit.texCoord.y, 0.5f);
}

// ISO/IEC 19775-1 11.4.1.
TEST(Picking, WhatClipPlanesCutAwayIsNotThere) {
  Running r(
      "#X3D V3.3 utf8\nTransform { rotation 0 0 1 1.5707963 children [ DEF C ClipPlane { plane 0 0 "
      "-1 0.5 } "
      "ClipPlane { plane 0 1 0 0 } DEF Front Transform { children Shape { geometry Box { size 2 "
      "2 4 } } } ] } DEF Behind Transform { translation 0 0 -9 children " +
      box + "}");
  const auto name = [&](double x) {
    PickHit hit;
    return pickAt(r, x, 0, hit, {.bothSides = true})
               ? hit.path.back().node->type().name + " " + text(hit.point)
               : "nothing";
  };
  // The plane z = 0.5 opens the box: its far side is hit from within. The world's -x is the group's
  // y.
  EXPECT_EQ(name(-0.5), "Shape -0.5 0 -2");
  EXPECT_EQ(name(0.5), "Shape 0.5 0 -8") << "the other half of the front box is gone";
  r.set("C", "enabled", false);
  EXPECT_EQ(name(-0.5), "Shape -0.5 0 2");
  r.set("C", "plane", Vec4f{0, 0, 1, -5});
  r.set("C", "enabled", true);
  EXPECT_EQ(name(-0.5), "Shape -0.5 0 -8") << "nothing is left of the front box";
}

TEST(Picking, BacksOfSolidGeometryAreNotThere) {
  const std::string points =
      "coord Coordinate { point [ -1 -1 0, 1 -1 0, 1 1 0, -1 1 0 ] } coordIndex [ 0 1 2 3 ] ";
  PickHit hit;
  Running front("Shape { geometry IndexedFaceSet { " + points + "} }"),
      turned("Shape { geometry IndexedFaceSet { ccw FALSE " + points + "} }"),
      both("Shape { geometry IndexedFaceSet { solid FALSE " + points + "} }");
  EXPECT_TRUE(pickAt(front, 0, 0, hit));
  EXPECT_FALSE(pickAt(front, 0, 0, hit, {}, -10));
  EXPECT_TRUE(pickAt(front, 0, 0, hit, {.bothSides = true}, -10));
  EXPECT_FALSE(pickAt(turned, 0, 0, hit));
  EXPECT_TRUE(pickAt(turned, 0, 0, hit, {}, -10));
  EXPECT_EQ(text(hit.normal), "0 0 -1");
  EXPECT_TRUE(pickAt(both, 0, 0, hit));
  EXPECT_TRUE(pickAt(both, 0, 0, hit, {}, -10));
}

TEST(Picking, OnlyTheChosenChildOfASwitchIsThere) {
  Running r("DEF W Switch { choice [ Transform { translation 5 0 0 children " + box + "} " + box +
            "] }");
  PickHit hit;
  EXPECT_FALSE(pickAt(r, 0, 0, hit));
  r.set("W", "whichChoice", 1);
  EXPECT_TRUE(pickAt(r, 0, 0, hit));
  EXPECT_FALSE(pickAt(r, 5, 0, hit));
  r.set("W", "whichChoice", 0);
  EXPECT_TRUE(pickAt(r, 5, 0, hit));
}

TEST(Picking, TheLevelOfDetailIsThatForTheViewer) {
  Running r("DEF V Viewpoint { position 0 0 4 } LOD { range 8 level [ DEF NEAR Shape { geometry "
            "Box {} } DEF FAR Shape { geometry Box {} } ] }");
  PickHit hit;
  ASSERT_TRUE(pickAt(r, 0, 0, hit));
  EXPECT_EQ(hit.path.back().node->defName, "NEAR");
  r.set("V", "position", Vec3f{0, 0, 9});
  ASSERT_TRUE(pickAt(r, 0, 0, hit));
  EXPECT_EQ(hit.path.back().node->defName, "FAR");
}

TEST(Picking, BillboardsFaceTheViewer) {
  Running r("DEF V Viewpoint { position 10 0 0 orientation 0 1 0 1.5707963 } Billboard { children "
            "Shape { geometry Box { size 2 2 0.2 } } }");
  const double origin[3] = {10, 0, -0.9}, direction[3] = {-1, 0, 0};
  PickHit hit;
  ASSERT_TRUE(r.browser.pick(origin, direction, {}, hit));
  EXPECT_NEAR(hit.point[0], 0.1, 1e-6);
  r.set("V", "position", Vec3f{0, 0, 10});
  ASSERT_TRUE(r.browser.pick(origin, direction, {}, hit) == false || hit.point[0] > 0.9);
}

TEST(Picking, FollowsWhatMovesAndWhatIsRedefined) {
  Running r("DEF T Transform { children Group { children Shape { geometry IndexedFaceSet { coord "
            "DEF C Coordinate {"
            " point [ -1 -1 0, 1 -1 0, 0 1 0 ] } coordIndex [ 0 1 2 ] } } } } DEF G Group {}");
  PickHit hit;
  EXPECT_TRUE(pickAt(r, 0, 0, hit));
  r.set("T", "translation", Vec3f{5, 0, 0});
  EXPECT_FALSE(pickAt(r, 0, 0, hit));
  EXPECT_TRUE(pickAt(r, 5, 0, hit));
  r.set("C", "point", MFVec3f{{9, 9, 0}, {11, 9, 0}, {10, 11, 0}});
  EXPECT_FALSE(pickAt(r, 5, 0, hit));
  EXPECT_TRUE(pickAt(r, 15, 10, hit));
  r.set("G", "addChildren", MFNode{r.browser.node("T")});
  r.browser.removeRoot(r.node("T"));
  EXPECT_TRUE(pickAt(r, 15, 10, hit));
  r.set("G", "children", MFNode{});
  EXPECT_FALSE(pickAt(r, 15, 10, hit));
}

TEST(Picking, LargeMeshesGiveWhatSmallOnesDo) {
  std::string heights;
  for (int i = 0; i < 60 * 60; ++i) heights += fmt::format("{} ", (i * 7919 % 13) * 0.1);
  Running r("Transform { rotation 1 0 0 1.5707963 children Shape { geometry ElevationGrid { solid "
            "FALSE xDimension 60 zDimension 60 height [ " +
            heights + " ] } } }");
  PickHit hit;
  for (int i = 0; i < 58; ++i) { // at grid points the height must be that of the file
    ASSERT_TRUE(pickAt(r, i + 1e-4, -20 - 1e-4, hit)) << i;
    EXPECT_NEAR(hit.point[2], ((20 * 60 + i) * 7919 % 13) * 0.1, 2e-3) << i;
  }
}

TEST(Picking, SingularAndInfiniteThingsAreSkipped) {
  Running r("DEF T Transform { children " + box +
            "} Transform { scale 1 1 0.000000000000000000000000001 children " + box + "}");
  r.set("T", "scale", Vec3f{0, 1, 1});
  PickHit hit;
  pickAt(r, 0, 0, hit);
  const double origin[3] = {0, 0, INFINITY}, zero[3] = {0, 0, 0}, nan[3] = {NAN, 0, 0};
  EXPECT_FALSE(r.browser.pick(origin, zero, {}, hit));
  EXPECT_FALSE(r.browser.pick(zero, zero, {}, hit));
  EXPECT_FALSE(r.browser.pick(zero, nan, {}, hit));
}

TEST(Picking, NormalsOfStretchedShapesStayAtRightAngles) {
  Running r(
      "Transform { scale 3 1 1 rotation 0 1 0 0.7853982 children Shape { geometry Box {} } }");
  PickHit hit;
  ASSERT_TRUE(pickAt(r, 1, 0, hit));
  EXPECT_NEAR(std::hypot(hit.normal[0], hit.normal[1], hit.normal[2]), 1, 1e-12);
  EXPECT_NEAR(hit.normal[0], std::sqrt(0.5), 1e-6); // the face stays flat, however it is stretched
}

struct Touch : Running {
  explicit Touch(const std::string& vrml) : Running(vrml) {
    for (const char* out : {"isOver", "isActive", "touchTime"}) log("S", out);
  }
};

TEST(TouchSensor, SendsIsOverWhenThePointerComesAndGoes) {
  Touch r("Group { children [ DEF S TouchSensor {} " + box + "] }");
  at(r, 5, 0);
  EXPECT_EQ(r.take(), Log{});
  at(r, 0, 0);
  at(r, 0.5, 0);
  EXPECT_EQ(r.take(), Log{"0 S.isOver TRUE"});
  at(r, 5, 0);
  EXPECT_EQ(r.take(), Log{"0 S.isOver FALSE"});
}

TEST(TouchSensor, PointNormalAndTextureCoordinateAreInItsOwnCoordinates) {
  Running r("Transform { translation 1 0 0 scale 2 2 2 rotation 0 1 0 1.5707963 children [ DEF S "
            "TouchSensor {}"
            " Transform { translation 0 0 1 children Shape { geometry Box {} } } ] }");
  at(r, 2.5, 0.5);
  EXPECT_EQ(r.get("S", "isOver"), "TRUE");
  const Vec3f p = std::get<Vec3f>(r.browser.get(r.node("S"), "hitPoint_changed")),
              n = std::get<Vec3f>(r.browser.get(r.node("S"), "hitNormal_changed"));
  EXPECT_NEAR(p.x, -1, 1e-6);
  EXPECT_NEAR(p.y, 0.25, 1e-6);
  EXPECT_NEAR(p.z, 0.75, 1e-6);
  EXPECT_NEAR(n.x, -1, 1e-6);
  const Vec2f t = std::get<Vec2f>(r.browser.get(r.node("S"), "hitTexCoord_changed"));
  EXPECT_NEAR(t.y, 0.625, 1e-6);
}

TEST(TouchSensor, HitEventsComeWithEachMotionAndWithNothingElse) {
  Running r("Group { children [ DEF S TouchSensor {} " + box + "] }");
  r.log("S", "hitPoint_changed");
  at(r, 0, 0);
  at(r, 0, 0);
  at(r, 0.5, 0);
  at(r, 5, 0);
  EXPECT_EQ(r.take(), (Log{"0 S.hitPoint_changed 0 0 1", "0 S.hitPoint_changed 0.5 0 1"}));
}

TEST(TouchSensor, TouchTimeComesWithTheReleaseOverTheSameGeometry) {
  Touch r("Group { children [ DEF S TouchSensor {} " + box + "] }");
  r.browser.tick(2);
  at(r, 0, 0, true);
  EXPECT_EQ(r.take(), (Log{"2 S.isOver TRUE", "2 S.isActive TRUE"}));
  r.browser.tick(3);
  at(r, 0, 0, false);
  EXPECT_EQ(r.take(), (Log{"3 S.isActive FALSE", "3 S.touchTime 3"}));
}

TEST(TouchSensor, AReleaseElsewhereIsNoTouch) {
  Touch r("Group { children [ DEF S TouchSensor {} " + box + "] }");
  at(r, 0, 0, true);
  at(r, 5, 0, true);
  at(r, 5, 0, false);
  EXPECT_EQ(r.take(), (Log{"0 S.isOver TRUE", "0 S.isActive TRUE", "0 S.isOver FALSE",
                           "0 S.isActive FALSE"}));
}

TEST(TouchSensor, OffAndBackOverBeforeTheReleaseIsATouch) {
  Touch r("Group { children [ DEF S TouchSensor {} " + box + "] }");
  at(r, 0, 0, true);
  at(r, 5, 0, true);
  at(r, 0, 0, true);
  r.take();
  at(r, 0, 0, false);
  EXPECT_EQ(r.take(), (Log{"0 S.isActive FALSE", "0 S.touchTime 0"}));
}

TEST(TouchSensor, APressBesideItAndAReleaseOverItIsNoTouch) {
  Touch r("Group { children [ DEF S TouchSensor {} " + box + "] }");
  at(r, 5, 0, true);
  at(r, 0, 0, true);
  at(r, 0, 0, false);
  EXPECT_EQ(r.take(), Log{"0 S.isOver TRUE"});
}

TEST(TouchSensor, WhileOneHasGrabbedThePointerOthersAreSilent) {
  Touch r("Group { children [ DEF O TouchSensor {} Transform { translation 5 0 0 children " + box +
          "} ] }"
          "Group { children [ DEF S TouchSensor {} " +
          box + "] }");
  r.log("O", "isOver");
  at(r, 0, 0, true);
  r.take();
  at(r, 5, 0, true);
  EXPECT_EQ(r.take(), Log{"0 S.isOver FALSE"});
  at(r, 5, 0, false);
  EXPECT_EQ(r.take(), (Log{"0 S.isActive FALSE", "0 O.isOver TRUE"}));
}

TEST(TouchSensor, DisablingItLetsGo) {
  Touch r("Group { children [ DEF S TouchSensor {} " + box + "] }");
  at(r, 0, 0, true);
  r.take();
  r.set("S", "enabled", false);
  EXPECT_EQ(r.take(), (Log{"0 S.isActive FALSE", "0 S.isOver FALSE"}));
  at(r, 0, 0, false);
  at(r, 0.5, 0, false);
  EXPECT_EQ(r.take(), Log{});
  r.set("S", "enabled", true);
  at(r, 0, 0, false);
  EXPECT_EQ(r.take(), Log{"0 S.isOver TRUE"});
}

TEST(TouchSensor, OneThatLeavesTheSceneLetsGo) {
  Touch r("DEF G Group { children [ DEF S TouchSensor {} " + box + "] }");
  at(r, 0, 0, true);
  r.take();
  r.set("G", "removeChildren", MFNode{r.browser.node("S")});
  EXPECT_EQ(r.take(), (Log{"0 S.isActive FALSE", "0 S.isOver FALSE"}));
}

TEST(PointingSensors, TheLowestGroupWithAnEnabledOneWins) {
  Running r("Group { children [ DEF HIGH TouchSensor {} Group { children [ DEF LOW TouchSensor {} "
            "Group { children " +
            box + "} ] } ] }");
  at(r, 0, 0);
  EXPECT_EQ(r.get("LOW", "isOver"), "TRUE");
  EXPECT_EQ(r.get("HIGH", "isOver"), "FALSE");
  r.set("LOW", "enabled", false);
  at(r, 0.1, 0);
  EXPECT_EQ(r.get("LOW", "isOver"), "FALSE");
  EXPECT_EQ(r.get("HIGH", "isOver"), "TRUE");
}

TEST(PointingSensors, AllSiblingsGetThePointer) {
  Running r("Group { children [ DEF A TouchSensor {} " + box +
            "DEF B TouchSensor {} DEF P PlaneSensor {} ] }");
  at(r, 0, 0, true);
  for (const char* name : {"A", "B", "P"}) EXPECT_EQ(r.get(name, "isActive"), "TRUE") << name;
  EXPECT_EQ(r.browser.sensorsAtPointer().size(), 3u);
}

TEST(PointingSensors, AtTheTopOfTheFileTheySenseTheWholeWorld) {
  Running r("DEF S TouchSensor {} Group { children " + box + "}");
  at(r, 0, 0);
  EXPECT_EQ(r.get("S", "isOver"), "TRUE");
}

TEST(PointingSensors, APrototypeMayStandForOne) {
  Running r("PROTO P [ eventOut SFBool over ] { TouchSensor { isOver IS over } } Group { children "
            "[ DEF I P {} " +
            box + "] }");
  r.log("I", "over");
  at(r, 0, 0);
  EXPECT_EQ(r.take(), Log{"0 I.over TRUE"});
}

TEST(PointingSensors, GeometryInFrontHidesThoseBehind) {
  Running r("Group { children [ DEF S TouchSensor {} " + box +
            "] } Transform { translation 0 0 5 children " + box + "}");
  at(r, 0, 0);
  EXPECT_EQ(r.get("S", "isOver"), "FALSE");
}

TEST(PointingSensors, ThePictureIsFromMinusOneToOne) {
  Running r("Viewpoint { position 0 0 10 fieldOfView 1.5707963 } Transform { translation 0 9 0 "
            "children [ DEF S TouchSensor {}"
            " Shape { geometry Box { size 1 1 0.0001 } } ] }");
  r.browser.setAspect(2);
  r.browser.pointer(0, 0.9, false);
  EXPECT_EQ(r.get("S", "isOver"), "TRUE");
  r.browser.pointer(0, 0.7, false);
  EXPECT_EQ(r.get("S", "isOver"), "FALSE");
  r.browser.pointer(0.02, 0.9, false); // x covers twice the angle
  EXPECT_EQ(r.get("S", "isOver"), "TRUE");
  r.browser.pointer(0.03, 0.9, false);
  EXPECT_EQ(r.get("S", "isOver"), "FALSE");
}

TEST(PointingSensors, APointerThatLeavesIsOverNothing) {
  Touch r("Group { children [ DEF S TouchSensor {} " + box + "] }");
  at(r, 0, 0, true);
  r.take();
  r.browser.pointerLeave();
  EXPECT_EQ(r.take(), (Log{"0 S.isActive FALSE", "0 S.isOver FALSE"}));
}

TEST(Anchor, AClickOnAChildBindsTheViewpointItNames) {
  Running r("DEF A Viewpoint {} DEF B Viewpoint { position 3 0 0 } Anchor { url \"#B\" children "
            "Group { children " +
            box + "} }");
  at(r, 0, 0, true);
  EXPECT_EQ(nameOf(r.browser.bound().viewpoint), "A");
  at(r, 0, 0, false);
  EXPECT_EQ(nameOf(r.browser.bound().viewpoint), "B");
}

TEST(Anchor, OtherPlacesAreHandedOn) {
  Running r("DEF A Anchor { url \"other.wrl\" children " + box + "}");
  std::string asked;
  r.browser.onAnchor([&](Node& anchor) { asked += anchor.defName; });
  at(r, 0, 0, true);
  at(r, 5, 0, true);
  at(r, 5, 0, false);
  EXPECT_EQ(asked, "");
  at(r, 0, 0, true);
  at(r, 0, 0, false);
  EXPECT_EQ(asked, "A");
}

TEST(Anchor, ALowerSensorTakesTheClick) {
  Running r("DEF A Anchor { url \"other.wrl\" children Group { children [ DEF S TouchSensor {} " +
            box + "] } }");
  std::string asked;
  r.browser.onAnchor([&](Node& anchor) { asked += anchor.defName; });
  at(r, 0, 0, true);
  at(r, 0, 0, false);
  EXPECT_EQ(asked, "");
  EXPECT_EQ(r.get("S", "isOver"), "TRUE");
}

} // namespace
} // namespace xvrml
