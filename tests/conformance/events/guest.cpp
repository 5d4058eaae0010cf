// guest.cpp: guests, the further viewers of a running world (xvrml/guest.h): they move as the
// world's viewer does, and the world does not notice.
#include "xvrml/guest.h"
#include "conformance/events/viewing.h"

namespace xvrml {
namespace {

const std::string floor20 =
    "Transform { translation 0 -0.5 0 children Shape { geometry Box { size 40 1 40 } } } ";
const std::string walks =
    "NavigationInfo { type [ \"WALK\" \"FLY\" ] avatarSize [ 0.25 1.6 0.75 ] speed 2 } ";

std::string eyeOf(const Guest& guest) {
  const CameraSettings c = guest.camera(1);
  return fmt::format("{:g} {:g} {:g}", tidy(c.matrix[12]), tidy(c.matrix[13]), tidy(c.matrix[14]));
}

std::string lookOf(const Guest& guest) {
  const CameraSettings c = guest.camera(1);
  return fmt::format("{:g} {:g} {:g}", tidy(-c.matrix[8]), tidy(-c.matrix[9]), tidy(-c.matrix[10]));
}

TEST(Guest, BeginsWhereTheViewerIs) {
  Running r(walks + "Viewpoint { position 0 1.6 10 fieldOfView 1 } " + floor20);
  r.browser.navigate({.ahead = 1}, 1);
  const Guest guest(r.browser);
  EXPECT_EQ(eyeOf(guest), "0 1.6 8");
  EXPECT_EQ(guest.camera(1).fovy, r.browser.camera(1).fovy);
  EXPECT_EQ(guest.navigation(), Navigation::walk);
}

TEST(Guest, WalksAsTheViewerDoesAndTheViewerStays) {
  Running r(walks + "Viewpoint { position 0 1.6 10 } " + floor20);
  Guest guest(r.browser);
  guest.navigate({.ahead = 1}, 1.5);
  guest.navigate({.turn = 1}, 1);
  EXPECT_EQ(eyeOf(guest), "0 1.6 7");
  EXPECT_EQ(lookOf(guest), "-1 0 0");
  EXPECT_EQ(eyeOf(r.browser), "0 1.6 10");
  EXPECT_EQ(lookOf(r.browser), "0 0 -1");
}

TEST(Guest, IsStoppedByWallsWithoutEvents) {
  Running r(walks + "Viewpoint { position 0 1.6 10 } " + floor20 +
            "DEF Wall Collision { children Transform { translation 0 2 0 "
            "children Shape { geometry Box { size 40 4 2 } } } }");
  uint64_t collisions = 0;
  r.browser.listen(*r.browser.node("Wall"), "collideTime",
                   [&](Node&, const FieldInfo&, const Value&) { ++collisions; });
  Guest guest(r.browser);
  guest.navigate({.ahead = 1}, 20);
  EXPECT_NEAR(guest.camera(1).matrix[14], 1.25, 1e-6);
  EXPECT_EQ(collisions, 0u);
  r.browser.navigate({.ahead = 1}, 20); // the world's viewer is noticed
  EXPECT_GT(collisions, 0u);
}

TEST(Guest, FliesThroughNoSensor) {
  Running r(walks + "Viewpoint { position 0 1.6 10 } DEF Near ProximitySensor { size 4 8 4 } ");
  uint64_t events = 0;
  r.browser.listen(*r.browser.node("Near"), "isActive",
                   [&](Node&, const FieldInfo&, const Value&) { ++events; });
  Guest guest(r.browser);
  ASSERT_TRUE(guest.setNavigation(Navigation::fly));
  guest.navigate({.ahead = 1}, 5);
  r.browser.tick(1);
  EXPECT_EQ(eyeOf(guest), "0 1.6 0");
  EXPECT_EQ(events, 0u);
  EXPECT_FALSE(guest.setNavigation(Navigation::examine));
  EXPECT_EQ(r.browser.navigation(), Navigation::walk);
}

TEST(Guest, ExamineTurnsAroundTheWorld) {
  Running r("NavigationInfo { type \"EXAMINE\" } Viewpoint { position 0 0 10 } "
            "Shape { geometry Box {} }");
  Guest guest(r.browser);
  guest.navigate({.turn = 1}, 1);
  EXPECT_EQ(eyeOf(guest), "10 0 0");
  EXPECT_EQ(lookOf(guest), "-1 0 0");
}

TEST(Guest, IsCarriedByItsViewpointUntilThatLeaves) {
  Running r(
      "Viewpoint {} DEF Lift Transform { children [ DEF Cabin Viewpoint { position 0 0 3 } ] }");
  Guest guest(r.browser);
  Node& cabin = *r.browser.node("Cabin");
  guest.goTo(cabin);
  EXPECT_EQ(guest.viewpoint(), &cabin);
  EXPECT_EQ(eyeOf(guest), "0 0 3");
  r.browser.set(*r.browser.node("Lift"), "translation", SFVec3f{0, 5, 0});
  EXPECT_EQ(eyeOf(guest), "0 5 3");
  r.browser.set(*r.browser.node("Lift"), "removeChildren", MFNode{NodeRef(&cabin)});
  EXPECT_EQ(guest.viewpoint(), nullptr);
  EXPECT_EQ(eyeOf(guest), "0 5 3");
  EXPECT_NE(r.browser.bound().viewpoint, &cabin);
}

TEST(Guest, IgnoresPlacesThatAreNoNumbers) {
  Running r("Viewpoint { position 0 0 7 }");
  Guest guest(r.browser);
  double view[16] = {};
  view[12] = std::nan("");
  guest.place(view);
  guest.navigate({.ahead = std::nan("")}, 1);
  EXPECT_EQ(eyeOf(guest), "0 0 7");
}

} // namespace
} // namespace xvrml
