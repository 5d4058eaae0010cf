// transform_sensor.cpp: TransformSensor (ISO/IEC 19775-1 22.4.2): expectations follow from the
// clause.
#include <numbers>

#include "conformance/events/viewing.h"

namespace xvrml {
namespace {

struct Sensing : Running {
  explicit Sensing(const std::string& nodes) : Running("#X3D V3.3 utf8\nPROFILE Full\n" + nodes) {
    for (const char* out : {"isActive", "enterTime", "exitTime"}) log("S", out);
  }
  // Moves the target, and returns whether the sensor is active then.
  std::string at(float x, float y = 0, float z = 0) {
    set("T", "translation", Vec3f{x, y, z});
    browser.tick(browser.now() + 1);
    return get("S", "isActive");
  }
};

const std::string target =
    "DEF T Transform { translation 9 0 0 children Shape { geometry Box { } } }\n";

TEST(TransformSensor, SendsWhenItsTargetEntersAndLeaves) {
  Sensing r(target + "DEF S TransformSensor { size 4 4 4 targetObject USE T }");
  r.browser.tick(1);
  EXPECT_EQ(r.take(), Log{});
  EXPECT_EQ(r.at(2.9f), "TRUE") << "the boxes meet, from -2 to 2 and from 1.9 to 3.9";
  EXPECT_EQ(r.take(), (Log{"2 S.isActive TRUE", "2 S.enterTime 2"}));
  EXPECT_EQ(r.at(0), "TRUE");
  EXPECT_EQ(r.take(), Log{});
  EXPECT_EQ(r.at(3.1f), "FALSE");
  EXPECT_EQ(r.take(), (Log{"4 S.isActive FALSE", "4 S.exitTime 4"}));
  r.set("S", "center", Vec3f{5, 0, 0});
  r.browser.tick(5);
  EXPECT_EQ(r.get("S", "isActive"), "TRUE");
}

TEST(TransformSensor, PlaceAndOrientationAreInItsOwnCoordinatesAndComeWhenTheyChange) {
  Sensing r(target + "Transform { translation 5 0 0 rotation 0 1 0 1.5707963 scale 2 2 2 children "
                     "DEF S TransformSensor { size 20 20 20 targetObject USE T } }");
  r.log("S", "position_changed");
  r.log("S", "orientation_changed");
  EXPECT_EQ(r.at(5, 0, 3), "TRUE");
  EXPECT_EQ(r.take().size(), 4u);
  const auto place = std::get<Vec3f>(r.browser.get(r.node("S"), "position_changed"));
  EXPECT_NEAR(place.x, -1.5, 1e-6);
  EXPECT_NEAR(place.z, 0, 1e-6);
  const auto turned = std::get<Rotation>(r.browser.get(r.node("S"), "orientation_changed"));
  EXPECT_NEAR(turned.y * turned.angle, -std::numbers::pi / 2, 1e-6);
  r.browser.tick(r.browser.now() + 1);
  EXPECT_EQ(r.take(), Log{});
  r.set("T", "rotation", Rotation{0, 1, 0, 0.5f});
  r.browser.tick(r.browser.now() + 1);
  EXPECT_EQ(r.take().size(), 1u) << "the orientation alone";
}

// The boxes stand at an angle: boxes along the axes around both would meet.
TEST(TransformSensor, BoxesAreComparedAsTheyAreTurned) {
  Sensing r("DEF T Transform { rotation 0 0 1 0.7853982 children Shape { geometry Box { size 4 4 4 "
            "} } }\nDEF S TransformSensor { size 2 2 2 targetObject USE T }");
  // The corner of the sensor's box at (1, 1) lies on the diagonal; the face of the target is 2 away
  // from its middle.
  const float touching = float((2 + std::numbers::sqrt2) / std::numbers::sqrt2);
  EXPECT_EQ(r.at(touching - 0.01f, touching - 0.01f), "TRUE");
  EXPECT_EQ(r.at(touching + 0.01f, touching + 0.01f), "FALSE");
}

TEST(TransformSensor, AnInstanceIsItsFirstNode) {
  Sensing r("PROTO P [ inputOutput SFVec3f translation 9 0 0 ] { Transform { translation IS "
            "translation children Shape { geometry Box { } } } }\nDEF T P { }\n"
            "DEF S TransformSensor { size 8 8 8 targetObject USE T }");
  r.log("S", "position_changed");
  for (const float x : {1.0f, 2.0f}) {
    EXPECT_EQ(r.at(x), "TRUE");
    EXPECT_EQ(std::get<Vec3f>(r.browser.get(r.node("S"), "position_changed")), (Vec3f{x, 0, 0}));
  }
}

TEST(TransformSensor, SensesNothingWithoutATargetOrAVolume) {
  for (const char* fields :
       {"size 4 4 4", "targetObject USE T", "size 4 0 4 targetObject USE T",
        "size 4 4 4 enabled FALSE targetObject USE T",
        "size 4 4 4 targetObject Group { children Shape { geometry Box { } } }"}) {
    Sensing r(target + "DEF S TransformSensor { " + fields + " }");
    EXPECT_EQ(r.at(0), "FALSE") << fields;
  }
}

TEST(TransformSensor, EndsWhenItIsDisabledAndWhenTheTargetIsNotShown) {
  Sensing r(
      "DEF W Switch { whichChoice 0 children DEF T Transform { children DEF B Shape { geometry "
      "Box { } } } }\nDEF S TransformSensor { size 4 4 4 targetObject USE B }");
  r.browser.tick(1);
  EXPECT_EQ(r.get("S", "isActive"), "TRUE") << "the target is a Shape";
  r.take();
  r.set("S", "enabled", false);
  EXPECT_EQ(r.take(), (Log{"1 S.isActive FALSE", "1 S.exitTime 1"}));
  r.set("S", "enabled", true);
  r.browser.tick(2);
  EXPECT_EQ(r.get("S", "isActive"), "TRUE");
  r.set("W", "whichChoice", -1);
  r.browser.tick(3);
  EXPECT_EQ(r.get("S", "isActive"), "FALSE");
}

TEST(TransformSensor, PlacesNothing) {
  Sensing r(
      "DEF T Transform { children Shape { geometry Box { } } }\n"
      "Transform { translation 50 0 0 children DEF S TransformSensor { size 4 4 4 targetObject "
      "USE T } }");
  r.browser.tick(1);
  EXPECT_EQ(r.get("S", "isActive"), "FALSE") << "the target stands at the origin alone";
}

} // namespace
} // namespace xvrml
