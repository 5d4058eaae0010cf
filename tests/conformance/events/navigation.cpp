// navigation.cpp: movement of the viewer: clauses 6.29 (NavigationInfo), 6.8 (Collision), 6.53 (up
// and down).
#include "behaviour/viewer/interaction.h"
#include "conformance/events/viewing.h"

namespace xvrml {
namespace {

const std::string floor20 =
    "Transform { translation 0 -0.5 0 children Shape { geometry Box { size 40 1 40 } } } ";
const std::string walks = "NavigationInfo { type \"WALK\" avatarSize [ 0.25 1.6 0.75 ] speed 2 } ";

double eye(Running& r, int i) { return r.browser.camera(1).matrix[12 + i]; }

TEST(Walk, GoesAtTheSpeedOfNavigationInfo) {
  Running r(walks + "Viewpoint { position 0 1.6 10 } " + floor20);
  r.browser.navigate({.ahead = 1}, 1.5);
  EXPECT_EQ(eyeOf(r.browser), "0 1.6 7");
  r.browser.navigate({.ahead = -0.5}, 1);
  EXPECT_EQ(eyeOf(r.browser), "0 1.6 8");
  r.browser.navigate({.right = 1}, 1);
  EXPECT_EQ(eyeOf(r.browser), "2 1.6 8");
}

TEST(Walk, TurningKeepsThePlace) {
  Running r(walks + "Viewpoint { position 0 1.6 10 } " + floor20);
  r.browser.navigate({.turn = 1}, 1);
  EXPECT_EQ(eyeOf(r.browser), "0 1.6 10");
  EXPECT_EQ(lookOf(r.browser), "-1 0 0");
}

TEST(Walk, LookingUpDoesNotLeadUp) {
  Running r(walks + "Viewpoint { position 0 1.6 10 } " + floor20);
  r.browser.navigate({.tilt = 0.5}, 1);
  r.browser.navigate({.ahead = 1}, 1);
  EXPECT_EQ(eyeOf(r.browser), "0 1.6 8");
  r.browser.navigate({.tilt = 1}, 5); // not beyond the zenith
  EXPECT_GT(r.browser.camera(1).matrix[5], 0);
}

TEST(Walk, GravityBringsTheFeetToTheGround) {
  Running r(walks + "Viewpoint { position 0 21.6 10 } " + floor20);
  r.browser.navigate({}, 0.5);
  EXPECT_NEAR(eye(r, 1), 21.6 - 9.81 * 0.25 / 2, 0.1); // half g t squared
  r.browser.navigate({}, 5);
  EXPECT_NEAR(eye(r, 1), 1.6, 1e-6);
}

TEST(Walk, WithoutGroundNobodyFalls) {
  Running r(walks + "Viewpoint { position 0 5 100 } " + floor20);
  r.browser.navigate({}, 3);
  EXPECT_EQ(eyeOf(r.browser), "0 5 100");
}

TEST(Walk, WallsStopTheViewerAtHisDistance) {
  Running r(walks + "Viewpoint { position 0 1.6 10 } " + floor20 +
            "Transform { translation 0 2 0 children Shape { geometry Box { size 40 4 2 } } }");
  r.browser.navigate({.ahead = 1}, 20);
  EXPECT_NEAR(eye(r, 2), 1.25, 1e-6);
  EXPECT_NEAR(eye(r, 1), 1.6, 1e-6);
}

TEST(Walk, AlongAWallTheViewerSlides) {
  Running r(walks + "Viewpoint { position 0 1.6 3 orientation 0 1 0 0.7853982 } " + floor20 +
            "Transform { translation 0 2 0 children Shape { geometry Box { size 40 4 2 } } }");
  r.browser.navigate({.ahead = 1}, 4);
  EXPECT_LT(eye(r, 0), -3);
  EXPECT_GT(eye(r, 2), 1);
}

// avatarSize[0] is the distance to geometry (6.29), from whatever direction it is approached.
TEST(Walk, AslantTheViewerKeepsItsDistance) {
  for (const double degrees : {20.0, 45.0, 65.0, 75.0}) {
    Running r(walks +
              fmt::format("Viewpoint {{ position 0 1.6 3 orientation 0 1 0 {} }} ",
                          degrees * std::numbers::pi / 180) +
              floor20 +
              "Transform { translation 0 2 0 children Shape { geometry Box { size 400 4 2 } } }");
    for (int i = 0; i < 200; ++i) r.browser.navigate({.ahead = 1}, 1. / 30);
    EXPECT_GE(eye(r, 2), 1.25 - 1e-6) << degrees;
    EXPECT_LT(eye(r, 2), 3) << degrees;
    EXPECT_LT(eye(r, 0), -1) << degrees;
  }
}

TEST(Walk, TheBackOfAWallIsAWall) {
  Running r(
      walks + "Viewpoint { position 0 1.6 -3 orientation 0 1 0 3.1415927 } " + floor20 +
      "Shape { geometry IndexedFaceSet {"
      " coord Coordinate { point [ -9 0 0, 9 0 0, 9 9 0, -9 9 0 ] } coordIndex [ 0 1 2 3 ] } }");
  r.browser.navigate({.ahead = 1}, 20);
  EXPECT_NEAR(eye(r, 2), -0.25, 1e-6);
}

TEST(Walk, AStepIsClimbedAndAHigherOneIsAWall) {
  for (const double height : {0.7, 0.8}) {
    Running r(walks + "Viewpoint { position 0 1.6 10 } " + floor20 +
              fmt::format("Transform {{ translation 0 {} 0 children Shape {{ geometry Box {{ size "
                          "40 {} 8 }} }} }}",
                          height / 2, height));
    r.browser.navigate({.ahead = 1}, 4);
    if (height < 0.75) {
      EXPECT_NEAR(eye(r, 2), 2, 1e-6);
      EXPECT_NEAR(eye(r, 1), 1.6 + height, 1e-6);
    } else {
      EXPECT_NEAR(eye(r, 2), 4.25, 1e-6);
      EXPECT_NEAR(eye(r, 1), 1.6, 1e-6);
    }
  }
}

TEST(Walk, DownAStepTheGroundIsFollowedAndOverAnEdgeOneFalls) {
  Running r(walks + "Viewpoint { position 0 6.6 5 } " + floor20 +
            "Transform { translation 0 2.5 5 children Shape { geometry Box { size 4 5 4 } } }");
  r.browser.navigate({.ahead = 1}, 1.2);
  const double falling = eye(r, 1);
  EXPECT_LT(falling, 6.6);
  EXPECT_GT(falling, 5); // the fall takes time
  r.browser.navigate({}, 3);
  EXPECT_NEAR(eye(r, 1), 1.6, 1e-6);
}

TEST(Walk, ARampIsFollowed) {
  Running r(walks + "Viewpoint { position 0 1.6 10 } Shape { geometry IndexedFaceSet { coord "
                    "Coordinate { point [ -9 0 10, 9 0 10, 9 5 0,"
                    " -9 5 0 ] } coordIndex [ 0 1 2 3 ] } }");
  r.browser.navigate({.ahead = 1}, 2);
  EXPECT_NEAR(eye(r, 2), 6, 1e-6);
  EXPECT_NEAR(eye(r, 1), 3.6, 1e-4);
}

// avatarSize[2] bounds objects that one steps over, not the slope of the ground.
TEST(Walk, ARampIsFollowedAlsoWithLowSteps) {
  for (const char* step : {"0", "0.01", "0.1"}) {
    Running r(fmt::format("NavigationInfo {{ type \"WALK\" speed 2 avatarSize [ .25 1.6 {} ] }} "
                          "Viewpoint {{ position 0 1.6 10 }} ",
                          step) +
              "Shape { geometry IndexedFaceSet { coord Coordinate { point [ -9 0 10, 9 0 10, 9 6 0,"
              " -9 6 0 ] } coordIndex [ 0 1 2 3 ] } }");
    for (int i = 0; i < 60; ++i) r.browser.navigate({.ahead = 1}, 1. / 30);
    EXPECT_NEAR(eye(r, 2), 6, 1e-4) << step;
    EXPECT_NEAR(eye(r, 1), 4, 1e-3) << step;
  }
}

TEST(Walk, ARampSteeperThanTheGroundIsAWallForLowSteps) {
  Running r(
      "NavigationInfo { type \"WALK\" speed 2 avatarSize [ .25 1.6 .1 ] } Viewpoint { position 0 "
      "1.6 15 } " +
      floor20 +
      "Shape { geometry IndexedFaceSet { coord Coordinate { point [ -9 0 10, 9 0 10, 9 30 0,"
      " -9 30 0 ] } coordIndex [ 0 1 2 3 ] } }");
  r.browser.navigate({.ahead = 1}, 10);
  EXPECT_GT(eye(r, 2), 9.9);
  EXPECT_NEAR(eye(r, 1), 1.6, 0.2);
}

// With speed 0 the position stays and the orientation may change (6.29).
TEST(Walk, WithSpeedZeroOnlyTheOrientationChanges) {
  Running r("NavigationInfo { type \"WALK\" speed 0 } Viewpoint { position 0 21.6 10 } " + floor20);
  r.browser.navigate({.ahead = 1, .right = 1, .turn = 1}, 1);
  EXPECT_EQ(eyeOf(r.browser), "0 21.6 10");
  EXPECT_EQ(lookOf(r.browser), "-1 0 0");
}

TEST(Walk, ATunnelLowerThanTheEyeIsAWall) {
  Running r(walks + "Viewpoint { position 0 1.6 10 } " + floor20 +
            "Transform { translation 0 2 0 children Shape { geometry Box { size 40 2 2 } } }");
  r.browser.navigate({.ahead = 1}, 20);
  EXPECT_NEAR(eye(r, 2), 1.25, 1e-6);
}

TEST(Walk, LengthsAreThoseOfTheViewpointsCoordinates) {
  Running r(walks + "Transform { scale 0.1 0.1 0.1 children Viewpoint { position 0 1.6 10 } } " +
            floor20);
  EXPECT_EQ(eyeOf(r.browser), "0 0.16 1");
  r.browser.navigate({.ahead = 1}, 1);
  EXPECT_EQ(eyeOf(r.browser), "0 0.16 0.8");
}

TEST(Walk, DownIsMinusYOfTheViewpointsCoordinates) {
  Running r(walks +
            "Transform { rotation 0 0 1 1.5707963 children [ Viewpoint { position 0 3 10 "
            "orientation 0 0 1 0.3 } " +
            floor20 + "] }");
  r.browser.navigate({}, 4);
  EXPECT_NEAR(eye(r, 0), -1.6, 1e-5);
}

TEST(Walk, ManySmallStepsAreAsGoodAsOneLongOne) {
  Running one(walks + "Viewpoint { position 0 1.6 10 } " + floor20),
      many(walks + "Viewpoint { position 0 1.6 10 } " + floor20);
  one.browser.navigate({.ahead = 1, .turn = 0.5}, 2);
  for (int i = 0; i < 60; ++i) many.browser.navigate({.ahead = 1, .turn = 0.5}, 1.0 / 30);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(eye(one, i), eye(many, i), 1e-6);
}

TEST(Walk, NonsenseMovesNobody) {
  Running r(walks + "Viewpoint { position 0 1.6 10 } " + floor20);
  r.browser.navigate({.ahead = NAN, .right = INFINITY}, 1);
  r.browser.navigate({.ahead = 1}, -1);
  r.browser.navigate({.ahead = 1}, NAN);
  EXPECT_EQ(eyeOf(r.browser), "0 1.6 10");
}

TEST(Fly, GoesWhereTheViewPointsAndDoesNotFall) {
  Running r(
      "NavigationInfo { type \"FLY\" } Viewpoint { position 0 5 10 orientation 1 0 0 1.5707963 } " +
      floor20);
  r.browser.navigate({.ahead = 1}, 3);
  EXPECT_EQ(eyeOf(r.browser), "0 8 10");
  r.browser.navigate({.ahead = -1}, 30);
  EXPECT_EQ(eyeOf(r.browser), "0 0.25 10"); // the ground stops the viewer
}

TEST(Examine, GoesRoundTheMiddleOfTheWorld) {
  Running r("NavigationInfo { type \"EXAMINE\" } Viewpoint { position 3 0 10 } Transform { "
            "translation 3 0 0 children Shape { geometry Box {} } }");
  r.browser.navigate({.turn = 1}, 1);
  EXPECT_EQ(eyeOf(r.browser), "13 0 0");
  EXPECT_EQ(lookOf(r.browser), "-1 0 0");
  r.browser.navigate({.ahead = 1}, 1);
  EXPECT_NEAR(eye(r, 0), 3 + 10 / std::exp(1), 1e-6);
  r.browser.navigate({.tilt = 1}, 9); // not beyond the pole
  EXPECT_GT(r.browser.camera(1).matrix[5], 0);
}

TEST(Examine, KeepsInTheMiddleWhatIsSeenThere) {
  Running r(
      "NavigationInfo { type \"EXAMINE\" } Viewpoint { position 0 0 10 } Shape { geometry Box {} } "
      "Transform { translation 50 0 -80 children Shape { geometry Box { size 4 4 4 } } }");
  r.browser.navigate({.turn = 1}, 1);
  EXPECT_EQ(eyeOf(r.browser), "10 0 0");
  EXPECT_EQ(lookOf(r.browser), "-1 0 0");
}

TEST(Navigation, NoneStaysWhereItIs) {
  for (const char* type : {"\"NONE\"", "[]"}) {
    Running r(std::string("NavigationInfo { type ") + type + " } Viewpoint {} " + floor20);
    EXPECT_EQ(r.browser.navigation(), Navigation::none);
    r.browser.navigate({.ahead = 1}, 1);
    EXPECT_EQ(eyeOf(r.browser), "0 0 10");
    EXPECT_FALSE(r.browser.setNavigation(Navigation::fly));
  }
}

TEST(Navigation, TheFirstKnownTypeHoldsAndOthersCanBeChosenIfListed) {
  Running r("NavigationInfo { type [ \"HELICOPTER\" \"EXAMINE\" \"FLY\" ] }"), any("Viewpoint {}");
  EXPECT_EQ(r.browser.navigation(), Navigation::examine);
  EXPECT_TRUE(r.browser.setNavigation(Navigation::fly));
  EXPECT_EQ(r.browser.navigation(), Navigation::fly);
  EXPECT_FALSE(r.browser.setNavigation(Navigation::walk));
  EXPECT_EQ(r.browser.navigation(), Navigation::examine);
  EXPECT_EQ(any.browser.navigation(), Navigation::walk);
  EXPECT_TRUE(any.browser.setNavigation(Navigation::examine));
}

TEST(Navigation, TheOffsetStaysWithTheViewpointAndComesBackWithIt) {
  Running r(walks +
            "DEF T Transform { children DEF A Viewpoint { position 0 1.6 10 } } DEF B Viewpoint { "
            "position 9 9 9 } " +
            floor20);
  r.browser.navigate({.ahead = 1}, 1);
  r.set("T", "translation", Vec3f{5, 0, 0});
  EXPECT_EQ(eyeOf(r.browser), "5 1.6 8");
  r.set("B", "set_bind", true);
  EXPECT_EQ(eyeOf(r.browser), "9 9 9");
  r.set("B", "set_bind", false); // restored without a jump: 6.53 rule c
  EXPECT_EQ(eyeOf(r.browser), "5 1.6 8");
  r.set("B", "set_bind", true);
  r.set("A", "set_bind", true); // bound again: at its own position
  EXPECT_EQ(eyeOf(r.browser), "5 1.6 10");
}

// Clause 4.12.10.3: the speed is in the coordinate system of the bound Viewpoint.
TEST(Navigation, TheCurrentSpeedIsThatSinceTheLastTick) {
  Running r("NavigationInfo { type \"FLY\" speed 3 } Transform { scale 10 10 10 children DEF V "
            "Viewpoint {} }");
  const Viewer& viewer = interactionOf(r.browser.events()).viewer;
  r.browser.tick(1);
  EXPECT_EQ(viewer.speed(), 0);
  r.browser.navigate({.ahead = 1}, 2);
  r.browser.tick(3);
  EXPECT_NEAR(viewer.speed(), 3, 1e-9);
  r.browser.tick(4);
  EXPECT_EQ(viewer.speed(), 0);
  r.set("V", "position", Vec3f{9, 9, 9}); // the Viewpoint moves, not the viewer
  r.browser.tick(5);
  EXPECT_EQ(viewer.speed(), 0);
  r.browser.navigate({.ahead = 1}, 2);
  r.browser.key(Key::home, true); // a jump does not count as motion
  r.browser.tick(6);
  EXPECT_EQ(viewer.speed(), 0);
}

TEST(Collision, SendsCollideTimeWhenItsChildrenStopTheViewer) {
  Running r(walks + "Viewpoint { position 0 1.6 10 } " + floor20 +
            "DEF C Collision { children Transform { translation 0 2 0 children Shape { geometry "
            "Box { size 40 4 2 } } } }");
  r.log("C", "collideTime");
  r.browser.tick(7);
  r.browser.navigate({.ahead = 1}, 1);
  EXPECT_EQ(r.take(), Log{});
  r.browser.navigate({.ahead = 1}, 10);
  EXPECT_EQ(r.take(), Log{"7 C.collideTime 7"});
  EXPECT_NEAR(eye(r, 2), 1.25, 1e-6);
}

// X3D's Collision is a sensor (ISO/IEC 19775-1 23.4.2).
TEST(Collision, IsActiveWhileTheViewerIsAtItsChildren) {
  Running r(walks + "Viewpoint { position 0 1.6 10 } DEF FAR Viewpoint { position 0 1.6 15 } " +
            floor20 +
            "DEF C Collision { children Transform { translation 0 2 0 children Shape { geometry "
            "Box { size 40 4 2 } } } }");
  r.log("C", "isActive");
  r.browser.tick(7);
  r.browser.navigate({.ahead = 1}, 10);
  EXPECT_EQ(r.take(), Log{"7 C.isActive TRUE"});
  r.browser.tick(8);
  r.browser.navigate({.ahead = 1}, 1);
  EXPECT_EQ(r.take(), Log{});
  r.browser.navigate({.ahead = -1}, 1);
  EXPECT_EQ(r.take(), Log{"8 C.isActive FALSE"});
  r.browser.tick(9);
  r.browser.navigate({.ahead = 1}, 10);
  r.take();
  r.browser.tick(10);
  r.set("FAR", "set_bind", true); // a jump takes the viewer away
  EXPECT_EQ(r.take(), Log{"10 C.isActive FALSE"});
}

// A wall that is seen ahead but not reached is no collision (6.8).
TEST(Collision, SendsNothingBeforeTheViewerIsAtItsDistance) {
  Running r(
      "NavigationInfo { type \"WALK\" speed 1 } Viewpoint { position 0 1.6 10 } " + floor20 +
      "DEF C Collision { children Transform { translation 0 2 0 children Shape { geometry Box { "
      "size 40 4 2 } } } }");
  r.log("C", "collideTime");
  for (int i = 0; i < 260; ++i) r.browser.navigate({.ahead = 1}, 1. / 30); // as far as z = 1.33
  EXPECT_EQ(r.take(), Log{});
  for (int i = 0; i < 10; ++i) r.browser.navigate({.ahead = 1}, 1. / 30);
  EXPECT_FALSE(r.take().empty());
}

TEST(Collision, WithCollideFalseTheViewerPasses) {
  Running r(walks + "Viewpoint { position 0 1.6 10 } " + floor20 +
            "DEF C Collision { collide FALSE children Transform { translation 0 2 0 children Shape "
            "{ geometry Box { size 40 4 2 } } } }");
  r.log("C", "collideTime");
  r.browser.navigate({.ahead = 1}, 10);
  EXPECT_EQ(eyeOf(r.browser), "0 1.6 -10");
  r.set("C", "collide", true);
  r.browser.navigate({.ahead = -1}, 10);
  EXPECT_NEAR(eye(r, 2), -1.25, 1e-6);
  EXPECT_EQ(r.take().size(), 1u);
}

TEST(Collision, AProxyStandsForTheChildrenAndIsNotSeen) {
  Running r(walks + "Viewpoint { position 0 1.6 10 } " + floor20 +
            "DEF C Collision { proxy Transform { translation 0 2 4 children Shape { geometry Box { "
            "size 40 4 2 } } }"
            " children Transform { translation 0 2 8 children DEF CHILD Shape { geometry Box { "
            "size 40 4 0.1 } } } }");
  r.log("C", "collideTime");
  r.browser.navigate({.ahead = 1}, 10);
  EXPECT_NEAR(eye(r, 2), 5.25, 1e-6);
  EXPECT_EQ(r.take().size(), 1u);
  const double origin[3] = {0, 2, 6}, direction[3] = {0, 0, -1};
  PickHit hit;
  EXPECT_FALSE(r.browser.pick(origin, direction, {}, hit));
  EXPECT_TRUE(r.browser.pick(origin, direction, {.collision = true}, hit));
}

TEST(Collision, AnEmptyOneWithAProxyIsAnInvisibleWall) {
  Running r(walks + "Viewpoint { position 0 1.6 10 } " + floor20 +
            "Collision { proxy Transform { translation 0 2 0 children Shape { geometry Box { size "
            "40 4 2 } } } }");
  r.browser.navigate({.ahead = 1}, 20);
  EXPECT_NEAR(eye(r, 2), 1.25, 1e-6);
}

TEST(Keys, HeldArrowsWalkAndTurnAsTimeGoesBy) {
  Running r(walks + "Viewpoint { position 0 1.6 10 } " + floor20);
  r.browser.tick(1);
  r.browser.key(Key::up, true);
  r.browser.tick(2);
  EXPECT_EQ(eyeOf(r.browser), "0 1.6 8");
  r.browser.key(Key::up, false);
  r.browser.key(Key::right, true);
  r.browser.tick(3);
  EXPECT_EQ(eyeOf(r.browser), "0 1.6 8");
  EXPECT_EQ(lookOf(r.browser), "1 0 0");
  r.browser.key(Key::right, false);
  r.browser.tick(4);
  EXPECT_EQ(lookOf(r.browser), "1 0 0");
}

TEST(Keys, PagesLeadThroughTheViewpointsWithADescriptionAndHomeBack) {
  Running r(walks + "DEF A Viewpoint { description \"a\" } DEF X Viewpoint {} Group { children DEF "
                    "B Viewpoint { description \"b\" position 0 3 0 } }");
  r.browser.key(Key::pageDown, true);
  EXPECT_EQ(nameOf(r.browser.bound().viewpoint), "B");
  r.browser.key(Key::pageDown, true);
  EXPECT_EQ(nameOf(r.browser.bound().viewpoint), "A");
  r.browser.key(Key::pageUp, true);
  EXPECT_EQ(nameOf(r.browser.bound().viewpoint), "B");
  r.browser.navigate({.ahead = 1}, 1);
  EXPECT_EQ(eyeOf(r.browser), "0 3 -2");
  r.browser.key(Key::home, true);
  EXPECT_EQ(eyeOf(r.browser), "0 3 0");
  EXPECT_EQ(r.browser.viewpoints().size(), 3u);
  EXPECT_TRUE(r.browser.bindViewpoint("a"));
  EXPECT_EQ(nameOf(r.browser.bound().viewpoint), "A");
  EXPECT_FALSE(r.browser.bindViewpoint("nowhere"));
}

TEST(Viewer, AProgramMayPutItAnywhere) {
  Running r("DEF V Viewpoint { position 0 0 10 } DEF W Viewpoint { position 1 0 0 } DEF T "
            "Transform { translation 0 2 0 }");
  double place[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 3, 4, 5, 1};
  r.browser.placeViewer(place);
  EXPECT_EQ(eyeOf(r.browser), "3 4 5");
  place[12] = NAN;
  r.browser.placeViewer(place);
  EXPECT_EQ(eyeOf(r.browser), "3 4 5");
  r.browser.key(Key::home, true);
  EXPECT_EQ(eyeOf(r.browser), "0 0 10");
}

TEST(Viewer, WhatHasChangedCanBeAskedWithoutTakingIt) {
  Running r("DEF T Transform { translation 0 2 0 }");
  r.browser.takeChanges();
  EXPECT_FALSE(r.browser.hasChanges());
  r.set("T", "translation", Vec3f{1, 2, 3});
  EXPECT_TRUE(r.browser.hasChanges());
  EXPECT_EQ(r.browser.takeChanges().size(), 1u);
  EXPECT_FALSE(r.browser.hasChanges());
}

} // namespace
} // namespace xvrml
