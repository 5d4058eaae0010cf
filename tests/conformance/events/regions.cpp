// regions.cpp: ProximitySensor and VisibilitySensor: clauses 6.38, 6.54 and 4.6.7.2.
#include "conformance/events/viewing.h"

namespace xvrml {
namespace {

struct Region : Running {
  explicit Region(const std::string& vrml) : Running(vrml) {
    for (const char* out : {"isActive", "enterTime", "exitTime"}) log("S", out);
  }
  void viewer(float x, float y, float z) { set("V", "position", Vec3f{x, y, z}); }
};

TEST(ProximitySensor, SendsWhenTheViewerEntersAndLeaves) {
  Region r(
      "DEF V Viewpoint { position 0 0 20 } DEF S ProximitySensor { size 10 10 10 center 0 0 2 }");
  r.browser.tick(1);
  EXPECT_EQ(r.take(), Log{});
  r.viewer(1, 0, 6);
  r.browser.tick(2);
  EXPECT_EQ(r.take(), (Log{"2 S.isActive TRUE", "2 S.enterTime 2"}));
  r.browser.tick(3);
  EXPECT_EQ(r.take(), Log{});
  r.viewer(0, 0, 7.5f);
  r.browser.tick(4);
  EXPECT_EQ(r.take(), (Log{"4 S.isActive FALSE", "4 S.exitTime 4"}));
}

TEST(ProximitySensor, AViewerWhoIsInsideFromTheStartEntersAtTheFirstTick) {
  Region r("DEF S ProximitySensor { size 30 30 30 }");
  r.browser.tick(1);
  EXPECT_EQ(r.take(), (Log{"1 S.isActive TRUE", "1 S.enterTime 1"}));
  EXPECT_EQ(r.get("S", "position_changed"), "0 0 10");
  EXPECT_EQ(r.get("S", "orientation_changed"), "0 0 1 0");
}

TEST(ProximitySensor, PlaceAndOrientationAreInItsOwnCoordinatesAndComeWhenTheyChange) {
  Running r("DEF V Viewpoint { position 5 0 0 } Transform { translation 5 0 0 rotation 0 1 0 "
            "1.5707963 scale 2 2 2 children"
            " DEF S ProximitySensor { size 10 10 10 } }");
  r.log("S", "position_changed");
  r.log("S", "orientation_changed");
  r.browser.tick(1);
  EXPECT_EQ(r.take().size(), 2u);
  const auto turned = std::get<Rotation>(r.browser.get(r.node("S"), "orientation_changed"));
  EXPECT_NEAR(turned.y * turned.angle, -1.5707963, 1e-6);
  r.browser.tick(2);
  EXPECT_EQ(r.take(), Log{});
  r.set("V", "position", Vec3f{5, 0, 3});
  r.browser.tick(3);
  ASSERT_EQ(r.take().size(), 1u);
  const auto place = std::get<Vec3f>(r.browser.get(r.node("S"), "position_changed"));
  EXPECT_NEAR(place.x, -1.5, 1e-6);
  EXPECT_NEAR(place.z, 0, 1e-6);
  r.set("V", "orientation", Rotation{0, 1, 0, 0.5f});
  r.browser.tick(4);
  EXPECT_EQ(r.take().size(), 1u);
}

TEST(ProximitySensor, ItSensesWhenItIsItselfThatMoves) {
  Region r("DEF T Transform { children DEF S ProximitySensor { size 2 2 2 } }");
  r.log("S", "position_changed");
  r.browser.tick(1);
  EXPECT_EQ(r.take(), Log{});
  r.set("T", "translation", Vec3f{0, 0, 10});
  r.browser.tick(2);
  EXPECT_EQ(r.take(), (Log{"2 S.isActive TRUE", "2 S.enterTime 2", "2 S.position_changed 0 0 0"}));
  r.set("T", "translation", Vec3f{0, 0, 9.5f});
  r.browser.tick(3);
  EXPECT_EQ(r.take(), Log{"3 S.position_changed 0 0 0.5"});
  r.set("T", "translation", Vec3f{});
  r.browser.tick(4);
  EXPECT_EQ(r.take(), (Log{"4 S.isActive FALSE", "4 S.exitTime 4"}));
}

TEST(ProximitySensor, ABoxWithoutSizeSensesNothing) {
  Region r("DEF V Viewpoint { position 0 0 0 } DEF S ProximitySensor {}");
  r.browser.tick(1);
  EXPECT_EQ(r.take(), Log{});
}

TEST(ProximitySensor, DisabledItLeavesAtOnceAndSensesNothing) {
  Region r("DEF S ProximitySensor { size 30 30 30 }");
  r.browser.tick(1);
  r.take();
  r.set("S", "enabled", false);
  EXPECT_EQ(r.take(), (Log{"1 S.isActive FALSE", "1 S.exitTime 1"}));
  r.browser.tick(2);
  EXPECT_EQ(r.take(), Log{});
  r.set("S", "enabled", true);
  r.browser.tick(3);
  EXPECT_EQ(r.take(), (Log{"3 S.isActive TRUE", "3 S.enterTime 3"}));
}

TEST(ProximitySensor, OfOneThatIsUsedSeveralTimesTheBoxesAreOne) {
  Region r("DEF V Viewpoint { position 0 0 0 } DEF S ProximitySensor { size 2 2 2 } Transform { "
           "translation 1.5 0 0 children USE S }"
           "Transform { translation 9 0 0 children USE S }");
  r.browser.tick(1);
  EXPECT_EQ(r.take(), (Log{"1 S.isActive TRUE", "1 S.enterTime 1"}));
  r.viewer(2, 0, 0); // in the second box
  r.browser.tick(2);
  EXPECT_EQ(r.take(), Log{});
  EXPECT_EQ(r.get("S", "position_changed"), "0.5 0 0");
  r.viewer(5, 0, 0);
  r.browser.tick(3);
  EXPECT_EQ(r.take(), (Log{"3 S.isActive FALSE", "3 S.exitTime 3"}));
  r.viewer(9, 0, 0);
  r.browser.tick(4);
  EXPECT_EQ(r.take(), (Log{"4 S.isActive TRUE", "4 S.enterTime 4"}));
}

TEST(ProximitySensor, AJumpLeavesAndEntersAtTheTimeOfTheBinding) {
  Region r("DEF A Viewpoint {} DEF B Viewpoint { position 50 0 0 } DEF S ProximitySensor { center "
           "50 0 0 size 2 2 2 }"
           "DEF O ProximitySensor { center 0 0 10 size 2 2 2 }");
  r.log("O", "exitTime");
  r.browser.tick(1);
  r.take();
  r.set("B", "set_bind", true);
  EXPECT_EQ(r.take(), (Log{"1 S.isActive TRUE", "1 S.enterTime 1", "1 O.exitTime 1"}));
}

TEST(ProximitySensor, WhatItSendsIsRoutedInTheSameTick) {
  Running r("DEF S ProximitySensor { size 30 30 30 } DEF HUD Transform {} ROUTE S.position_changed "
            "TO HUD.translation"
            " ROUTE S.orientation_changed TO HUD.rotation");
  r.browser.tick(1);
  EXPECT_EQ(r.get("HUD", "translation"), "0 0 10");
}

TEST(ProximitySensor, TwoInstancesOfAPrototypeSenseByThemselves) {
  Running r("PROTO P [ exposedField SFVec3f at 0 0 0 eventOut SFBool in ] { Transform { "
            "translation IS at children"
            " ProximitySensor { size 4 4 4 isActive IS in } } } DEF A P { at 0 0 10 } DEF B P { at "
            "9 0 0 }");
  r.log("A", "in");
  r.log("B", "in");
  r.browser.tick(1);
  EXPECT_EQ(r.take(), Log{"1 A.in TRUE"});
}

TEST(VisibilitySensor, SendsWhenItsBoxComesIntoViewAndLeavesIt) {
  Region r("DEF V Viewpoint {} DEF S VisibilitySensor { size 1 1 1 }");
  r.browser.tick(1);
  EXPECT_EQ(r.take(), (Log{"1 S.isActive TRUE", "1 S.enterTime 1"}));
  r.set("V", "orientation", Rotation{0, 1, 0, 3});
  r.browser.tick(2);
  EXPECT_EQ(r.take(), (Log{"2 S.isActive FALSE", "2 S.exitTime 2"}));
}

TEST(VisibilitySensor, ThePictureEndsAtItsEdges) {
  // Half the picture is 10 tan(fieldOfView / 2) = 5 high at the origin and, with an aspect of 2, 10
  // wide.
  Region r("Viewpoint { fieldOfView 0.9272952 } DEF T Transform { children DEF S VisibilitySensor "
           "{ size 2 2 0.0001 } }");
  r.browser.setAspect(2);
  const auto seen = [&](float x, float y) {
    r.set("T", "translation", Vec3f{x, y, 0});
    r.browser.tick(r.browser.now() + 1);
    return r.get("S", "isActive");
  };
  EXPECT_EQ(seen(0, 5.9f), "TRUE");
  EXPECT_EQ(seen(0, 6.1f), "FALSE");
  EXPECT_EQ(seen(10.9f, 0), "TRUE");
  EXPECT_EQ(seen(11.1f, 0), "FALSE");
  EXPECT_EQ(seen(-10.9f, -5.9f), "TRUE");
}

TEST(VisibilitySensor, ABoxBeyondAllEdgesAndOneAroundTheEyeAreSeen) {
  Region r("DEF V Viewpoint {} DEF S VisibilitySensor { size 1000 1000 0.1 }");
  r.browser.tick(1);
  EXPECT_EQ(r.get("S", "isActive"), "TRUE");
  r.set("S", "size", Vec3f{100, 100, 100});
  r.browser.tick(2);
  EXPECT_EQ(r.get("S", "isActive"), "TRUE");
  r.set("S", "center", Vec3f{0, 0, 70});
  r.browser.tick(3);
  EXPECT_EQ(r.get("S", "isActive"), "FALSE");
}

TEST(VisibilitySensor, ABoxThatNoCornerPutsBesideThePictureIsNotSeenFromOutside) {
  // A long thin box beside the picture. Its corners are in front of and behind the viewer, so no
  // single edge excludes all of them.
  Region r("Viewpoint { position 0 0 0 } Transform { translation 9 0 0 rotation 0 1 0 -0.7853982 "
           "children"
           " DEF S VisibilitySensor { size 0.1 0.1 60 } }");
  r.browser.tick(1);
  EXPECT_EQ(r.get("S", "isActive"), "FALSE");
}

TEST(VisibilitySensor, DisabledItSensesNothing) {
  Region r("DEF S VisibilitySensor { enabled FALSE size 1 1 1 }");
  r.log("S", "isActive");
  r.browser.tick(1);
  EXPECT_EQ(r.take(), Log{});
}

TEST(VisibilitySensor, WithoutSizeItIsAPoint) {
  Region r("DEF S VisibilitySensor {} DEF B VisibilitySensor { center 0 0 100 }");
  r.browser.tick(1);
  EXPECT_EQ(r.get("S", "isActive"), "TRUE");
  EXPECT_EQ(r.get("B", "isActive"), "FALSE");
}

} // namespace
} // namespace xvrml
