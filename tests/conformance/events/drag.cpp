// drag.cpp: PlaneSensor, SphereSensor and CylinderSensor: clauses 6.34, 6.44, 6.15 and 4.6.7.4. The
// expected values are closed forms.
#include <numbers>

#include "conformance/events/viewing.h"

namespace xvrml {
namespace {

constexpr double pi = std::numbers::pi;

// Moves the pressed pointer to (x, y), looking along -z.
void to(Running& r, double x, double y, bool button = true) {
  const double origin[3] = {x, y, 10}, direction[3] = {0, 0, -1};
  r.browser.pointerRay(origin, direction, button);
}

void ray(Running& r, double ox, double oy, double oz, double dx, double dy, double dz,
         bool button = true) {
  const double origin[3] = {ox, oy, oz}, direction[3] = {dx, dy, dz};
  r.browser.pointerRay(origin, direction, button);
}

Rotation turn(Running& r, const char* out = "rotation_changed") {
  return std::get<Rotation>(r.browser.get(r.node("S"), out));
}

void expectTurn(const Rotation& r, double x, double y, double z, double angle) {
  EXPECT_NEAR(r.angle, angle, 1e-5);
  EXPECT_NEAR(r.x, x, 1e-5);
  EXPECT_NEAR(r.y, y, 1e-5);
  EXPECT_NEAR(r.z, z, 1e-5);
}

std::string with(const std::string& sensor,
                 const std::string& shape = "Shape { geometry Box { size 20 20 2 } }") {
  return "DEF G Group { children [ DEF S " + sensor + " " + shape + " ] }";
}

TEST(PlaneSensor, MotionInThePlaneOfTheFirstPointIsTranslation) {
  Running r(with("PlaneSensor {}"));
  r.log("S", "translation_changed");
  r.log("S", "trackPoint_changed");
  r.log("S", "isActive");
  to(r, 1, 2);
  EXPECT_EQ(r.take(), Log{"0 S.isActive TRUE"});
  to(r, 3, 1.5);
  EXPECT_EQ(r.take(), (Log{"0 S.trackPoint_changed 3 1.5 1", "0 S.translation_changed 2 -0.5 0"}));
  to(r, 3, 1.5, false);
  EXPECT_EQ(r.take(), Log{"0 S.isActive FALSE"});
}

TEST(PlaneSensor, TheNextDragGoesOnWhereTheLastOneEnded) {
  Running r(with("PlaneSensor { offset 0.5 0 7 }"));
  r.log("S", "offset_changed");
  to(r, 0, 0);
  to(r, 1, 0);
  EXPECT_EQ(r.take(), Log{});
  to(r, 1, 0, false);
  EXPECT_EQ(r.take(), Log{"0 S.offset_changed 1.5 0 7"});
  to(r, 4, 4);
  to(r, 4, 5);
  EXPECT_EQ(r.get("S", "translation_changed"), "1.5 1 7");
}

TEST(PlaneSensor, WithoutAutoOffsetEachDragBeginsAtTheOffset) {
  Running r(with("PlaneSensor { autoOffset FALSE offset 1 1 0 }"));
  to(r, 0, 0);
  to(r, 5, 0);
  to(r, 5, 0, false);
  EXPECT_EQ(r.get("S", "offset"), "1 1 0");
  to(r, 0, 0);
  to(r, 0, 1);
  EXPECT_EQ(r.get("S", "translation_changed"), "1 2 0");
}

TEST(PlaneSensor, LimitsHoldTheTranslationAndNotTheTrackPoint) {
  Running r(with("PlaneSensor { minPosition -1 0 maxPosition 2 0 }"));
  to(r, 0, 0);
  to(r, 5, 3);
  EXPECT_EQ(r.get("S", "translation_changed"), "2 0 0");
  EXPECT_EQ(r.get("S", "trackPoint_changed"), "5 3 1");
  to(r, -5, 3);
  EXPECT_EQ(r.get("S", "translation_changed"), "-1 0 0");
  to(r, -5, 3, false);
  EXPECT_EQ(r.get("S", "offset"), "-1 0 0");
}

TEST(PlaneSensor, ALowerLimitAboveTheUpperIsNone) {
  Running r(with("PlaneSensor { minPosition 1 0 maxPosition -1 1 }"));
  to(r, 0, 0);
  to(r, 8, 8);
  EXPECT_EQ(r.get("S", "translation_changed"), "8 1 0");
}

TEST(PlaneSensor, WorksInItsOwnCoordinates) {
  Running r("Transform { translation 3 0 0 rotation 0 0 1 1.5707963 scale 2 2 2 children [ DEF S "
            "PlaneSensor {}"
            " Shape { geometry Box { size 20 20 2 } } ] }");
  to(r, 3, 0);
  to(r, 5, 0);
  const Vec3f moved = std::get<Vec3f>(r.browser.get(r.node("S"), "translation_changed"));
  EXPECT_NEAR(moved.x, 0, 1e-6);
  EXPECT_NEAR(moved.y, -1, 1e-6);
}

TEST(PlaneSensor, MovingItsOwnGroupDoesNotFeedBack) {
  Running r("DEF T Transform { children [ DEF S PlaneSensor {} Shape { geometry Box { size 20 20 2 "
            "} } ] } ROUTE S.translation_changed TO T.translation");
  to(r, 0, 0);
  to(r, 1, 0);
  to(r, 2, 0);
  EXPECT_EQ(r.get("T", "translation"), "2 0 0");
}

TEST(PlaneSensor, RaysAlongThePlaneAndAwayFromItSayNothing) {
  Running r(with("PlaneSensor {}"));
  to(r, 0, 0);
  r.log("S", "translation_changed");
  ray(r, 0, 0, 10, 1, 0, 0);
  ray(r, 0, 0, 10, 0, 0, 1);
  ray(r, 0, 0, 1, 1, 0, 0);
  ray(r, 0, 0, 10, 1, 0, -1e-40);
  EXPECT_EQ(r.take(), Log{});
  to(r, 1, 0);
  EXPECT_EQ(r.take(), Log{"0 S.translation_changed 1 0 0"});
}

TEST(PlaneSensor, DisabledDuringADragItLetsGo) {
  Running r(with("PlaneSensor {}"));
  to(r, 0, 0);
  to(r, 1, 0);
  r.log("S", "isActive");
  r.log("S", "translation_changed");
  r.log("S", "offset_changed");
  r.set("S", "enabled", false);
  EXPECT_EQ(r.take(), (Log{"0 S.isActive FALSE", "0 S.offset_changed 1 0 0"}));
  to(r, 2, 0);
  r.set("S", "enabled", true);
  to(r, 3, 0);
  EXPECT_EQ(r.take(), Log{}); // a new drag needs a new press
  to(r, 3, 0, false);
  to(r, 3, 0);
  to(r, 4, 0);
  EXPECT_EQ(r.take(), (Log{"0 S.isActive TRUE", "0 S.translation_changed 2 0 0"}));
}

TEST(PlaneSensor, AClickWithoutMotionChangesNothing) {
  Running r(with("PlaneSensor { offset 1 0 0 }"));
  r.log("S", "translation_changed");
  r.log("S", "offset_changed");
  to(r, 0, 0);
  to(r, 0, 0, false);
  EXPECT_EQ(r.take(), Log{});
}

TEST(SphereSensor, TurnsByTheAngleBetweenThePoints) {
  Running r(with("SphereSensor {}", "Shape { geometry Sphere { radius 2 } }"));
  to(r, 0, 0);
  to(r, 2 * std::sin(0.5), 0);
  expectTurn(turn(r), 0, 1, 0, 0.5);
  to(r, 0, 2 * std::sin(0.3));
  expectTurn(turn(r), -1, 0, 0, 0.3);
  const Vec3f track = std::get<Vec3f>(r.browser.get(r.node("S"), "trackPoint_changed"));
  EXPECT_NEAR(track.y, 2 * std::sin(0.3), 1e-6);
  EXPECT_NEAR(track.z, 2 * std::cos(0.3), 1e-6);
}

TEST(SphereSensor, TheRadiusIsThatOfThePointPressed) {
  Running r(with("SphereSensor {}", "Shape { geometry Box { size 20 20 6 } }"));
  to(r, 4, 0); // at (4, 0, 3)
  to(r, 3, 0); // at (3, 0, 4)
  expectTurn(turn(r), 0, -1, 0, std::atan2(4, 3) - std::atan2(3, 4));
}

TEST(SphereSensor, OffsetComesFirstAndIsSetWhenTheDragEnds) {
  Running r(
      with("SphereSensor { offset 1 0 0 1.5707963 }", "Shape { geometry Sphere { radius 1 } }"));
  r.log("S", "offset_changed");
  to(r, 0, 0);
  to(r, std::sin(0.5), 0);
  const Rotation both = turn(r); // by 0.5 about y, after a right angle about x
  EXPECT_NEAR(std::cos(both.angle / 2), std::cos(0.25) * std::cos(pi / 4), 1e-6);
  to(r, std::sin(0.5), 0, false);
  EXPECT_EQ(r.take().size(), 1u);
  expectTurn(turn(r, "offset"), both.x, both.y, both.z, both.angle);
  to(r, 0, 0);
  to(r, -std::sin(0.5), 0);
  expectTurn(turn(r), 1, 0, 0, pi / 2); // back again
}

TEST(SphereSensor, BesideTheSphereTheDragGoesOnAtItsEdge) {
  Running r(with("SphereSensor {}", "Shape { geometry Sphere { radius 1 } }"));
  to(r, 0, 0);
  to(r, 1, 0);
  expectTurn(turn(r), 0, 1, 0, pi / 2);
  to(r, 7, 0);
  expectTurn(turn(r), 0, 1, 0, pi / 2);
  to(r, 0, -3);
  expectTurn(turn(r), 1, 0, 0, pi / 2);
}

TEST(SphereSensor, APressAtItsOriginIsStable) {
  Running r(with("SphereSensor {}",
                 "Transform { translation 0 0 -1 children Shape { geometry Box {} } }"));
  r.log("S", "rotation_changed");
  to(r, 0, 0);
  to(r, 1, 0);
  to(r, 1, 0, false);
  EXPECT_EQ(r.take(), Log{});
}

TEST(CylinderSensor, FromTheSideItTurnsAboutItsAxis) {
  Running r(with("CylinderSensor {}", "Shape { geometry Cylinder { radius 2 height 20 } }"));
  to(r, 0, 0);
  const double z0 = 2; // the mesh is faceted, so the first point may lie slightly inside
  to(r, 1, 3);
  const Rotation t = turn(r);
  EXPECT_NEAR(t.y, 1, 0);
  EXPECT_NEAR(t.angle, std::asin(1 / z0), 0.01);
  const Vec3f track = std::get<Vec3f>(r.browser.get(r.node("S"), "trackPoint_changed"));
  EXPECT_NEAR(track.y, 3, 1e-6);
}

TEST(CylinderSensor, TheRadiusIsThatOfThePointPressed) {
  Running r(with("CylinderSensor {}", "Shape { geometry Box { size 20 20 6 } }"));
  to(r, 4, 0);
  to(r, 3, 0);
  expectTurn(turn(r), 0, 1, 0, std::atan2(3, 4) - std::atan2(4, 3));
}

TEST(CylinderSensor, AlongItsAxisItIsADisk) {
  Running r(with("CylinderSensor {}", "Shape { geometry Box { size 20 2 20 } }"));
  ray(r, 3, 10, 0, 0, -1, 0);
  ray(r, 0, 10, -4, 0, -1, 0); // from +x to -z: a quarter turn about +y
  expectTurn(turn(r), 0, 1, 0, pi / 2);
  EXPECT_EQ(r.get("S", "trackPoint_changed"), "0 1 -4");
  ray(r, -1, 10, 0, 0, -1, 0);
  ray(r, 0, 10, 1, 0, -1, 0);
  ray(r, 1, 10, 0, 0, -1, 0);
  ray(r, 0, 10, -1, 0, -1, 0);
  expectTurn(turn(r), 0, 1, 0, 2.5 * pi); // full turns are counted
}

TEST(CylinderSensor, DiskAngleDecidesWhichOfTheTwo) {
  // The ray is at 45 degrees to the axis and hits the top of the box at (0, 1, 4).
  for (const bool disk : {false, true}) {
    Running r(with(disk ? "CylinderSensor { diskAngle 0.8 }" : "CylinderSensor { diskAngle 0.7 }",
                   "Shape { geometry Box { size 20 2 20 } }"));
    ray(r, 0, 2, 5, 0, -1, -1);
    ray(r, 1, 2, 5, 0, -1, -1);
    expectTurn(turn(r), 0, 1, 0, disk ? std::atan2(1, 4) : std::asin(1.0 / 4));
  }
}

TEST(CylinderSensor, OffsetAndLimitsAreAngles) {
  Running r(with("CylinderSensor { offset 0.5 minAngle 0 maxAngle 1 }",
                 "Shape { geometry Box { size 20 2 20 } }"));
  r.log("S", "offset_changed");
  ray(r, 0, 10, 5, 0, -1, 0);
  ray(r, 5 * std::sin(0.25), 10, 5 * std::cos(0.25), 0, -1, 0);
  expectTurn(turn(r), 0, 1, 0, 0.75);
  ray(r, 5, 10, 0, 0, -1, 0);
  expectTurn(turn(r), 0, 1, 0, 1);
  ray(r, 5, 10, 0, 0, -1, 0, false);
  EXPECT_EQ(r.take(), Log{"0 S.offset_changed 1"});
  ray(r, 0, 10, 5, 0, -1, 0);
  ray(r, -5, 10, 0, 0, -1, 0);
  expectTurn(turn(r), 0, 1, 0, 0);
}

TEST(CylinderSensor, WithoutAutoOffsetTheOffsetStays) {
  Running r(with("CylinderSensor { offset 0.5 autoOffset FALSE }",
                 "Shape { geometry Box { size 20 2 20 } }"));
  ray(r, 0, 10, 5, 0, -1, 0);
  ray(r, 5, 10, 0, 0, -1, 0);
  ray(r, 5, 10, 0, 0, -1, 0, false);
  EXPECT_EQ(r.get("S", "offset"), "0.5");
}

TEST(CylinderSensor, RaysAlongItsAxisDuringACylinderDragSayNothing) {
  Running r(with("CylinderSensor {}", "Shape { geometry Box { size 20 20 6 } }"));
  to(r, 4, 0);
  r.log("S", "rotation_changed");
  ray(r, 0, 20, 0, 0, -1, 0);
  EXPECT_EQ(r.take(), Log{});
}

// ISO/IEC 19775-1 20.3.2: in X3D isOver belongs to all sensors of the pointing device.
TEST(DragSensors, TellWhetherThePointerIsOverThem) {
  for (const char* sensor : {"PlaneSensor {}", "SphereSensor {}", "CylinderSensor {}"}) {
    Running r(with(sensor));
    r.log("S", "isOver");
    to(r, 0, 0, false);
    to(r, 1, 0, false);
    EXPECT_EQ(r.take(), Log{"0 S.isOver TRUE"}) << sensor;
    to(r, 100, 0, false);
    EXPECT_EQ(r.take(), Log{"0 S.isOver FALSE"}) << sensor;
  }
}

TEST(DragSensors, TwoSiblingsDragAtOnce) {
  Running r("Group { children [ DEF S SphereSensor {} DEF P PlaneSensor {} Shape { geometry Sphere "
            "{ radius 2 } } ] }");
  to(r, 0, 0);
  to(r, 2 * std::sin(0.5), 0);
  expectTurn(turn(r), 0, 1, 0, 0.5);
  EXPECT_NEAR(std::get<Vec3f>(r.browser.get(r.node("P"), "translation_changed")).x,
              2 * std::sin(0.5), 1e-6);
}

TEST(DragSensors, OfNestedOnesTheLowestDrags) {
  Running r("Group { children [ DEF S SphereSensor {} Group { children [ DEF P PlaneSensor {} "
            "Shape { geometry Sphere { radius 2 } } ] } ] }");
  to(r, 0, 0);
  to(r, 1, 0);
  EXPECT_EQ(r.get("P", "translation_changed"), "1 0 0");
  EXPECT_EQ(r.get("S", "isActive"), "FALSE");
}

TEST(DragSensors, ADragGoesOnBesideItsGeometryAndOverOther) {
  Running r(with("PlaneSensor {}", "Shape { geometry Box {} }") +
            "Group { children [ DEF O TouchSensor {} Transform { translation 5 0 3 children Shape "
            "{ geometry Box {} } } ] }");
  to(r, 0, 0);
  to(r, 5, 0);
  EXPECT_EQ(r.get("S", "translation_changed"), "5 0 0");
  EXPECT_EQ(r.get("O", "isOver"), "FALSE");
}

} // namespace
} // namespace xvrml
