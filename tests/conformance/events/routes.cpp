// routes.cpp: routes and cascades: clauses 4.7, 4.10.2 to 4.10.4 and 4.8.2.
#include "conformance/events/support.h"

namespace xvrml {
namespace {

TEST(Routes, ExposedFieldSendsWhatItWasSetTo) {
  Running r(
      "DEF A Transform {} DEF B Transform {} ROUTE A.translation_changed TO B.set_translation");
  r.log("B", "translation_changed");
  r.set("A", "set_translation", Vec3f{1, 2, 3});
  EXPECT_EQ(r.take(), Log{"0 B.translation_changed 1 2 3"});
  EXPECT_EQ(r.get("B", "translation"), "1 2 3");
}

TEST(Routes, ALoopEndsBecauseAnEventOutSendsOncePerTimestamp) {
  Running r("DEF A Transform {} DEF B Transform {} ROUTE A.translation TO B.translation ROUTE "
            "B.translation TO A.translation");
  r.log("A", "translation");
  r.log("B", "translation");
  r.set("A", "translation", Vec3f{1, 0, 0});
  EXPECT_EQ(r.take(), (Log{"0 A.translation 1 0 0", "0 B.translation 1 0 0"}));
  r.set("A", "translation", Vec3f{2, 0, 0}); // another cascade, though with the same timestamp
  EXPECT_EQ(r.take().size(), 2u);
}

TEST(Routes, FanOutReachesAllInTheOrderOfTheRoutes) {
  Running r("DEF A Transform {} DEF B Transform {} DEF C Transform {} ROUTE A.translation TO "
            "C.translation ROUTE A.translation TO B.translation");
  r.log("B", "translation");
  r.log("C", "translation");
  r.set("A", "translation", Vec3f{1, 0, 0});
  EXPECT_EQ(r.take(), (Log{"0 C.translation 1 0 0", "0 B.translation 1 0 0"}));
}

TEST(Routes, FanInDeliversAllAndSendsOne) {
  Running r(
      "DEF A Transform {} DEF B Transform { scale 2 2 2 } DEF C Transform {} DEF D Transform {}"
      "ROUTE A.translation TO B.translation ROUTE A.translation TO C.translation ROUTE "
      "B.translation TO D.translation ROUTE C.translation TO D.translation");
  r.log("D", "translation");
  r.set("A", "translation", Vec3f{1, 0, 0});
  EXPECT_EQ(r.take().size(), 1u);
}

TEST(Routes, DuplicateRoutesCountOnce) {
  Running r("DEF A Transform {} DEF B Transform {} ROUTE A.translation TO B.translation ROUTE "
            "A.translation_changed TO B.set_translation");
  EXPECT_FALSE(r.browser.deleteRoute(r.node("B"), "translation", r.node("A"), "translation"));
  EXPECT_TRUE(r.browser.deleteRoute(r.node("A"), "translation", r.node("B"), "translation"));
  r.set("A", "translation", Vec3f{1, 0, 0});
  EXPECT_EQ(r.get("B", "translation"), "0 0 0");
}

TEST(Routes, AWideFanOutCountsDuplicatesOnceAndForgetsDeletedOnes) {
  std::string world = "DEF A Transform {}";
  for (int i = 0; i < 200; ++i)
    world += fmt::format("DEF B{} Transform {{}} ROUTE A.translation TO B{}.translation ", i, i);
  Running r(world + "ROUTE A.translation TO B7.translation");
  EXPECT_TRUE(r.browser.deleteRoute(r.node("A"), "translation", r.node("B7"), "translation"));
  EXPECT_FALSE(r.browser.deleteRoute(r.node("A"), "translation", r.node("B7"), "translation"));
  r.set("A", "translation", Vec3f{1, 0, 0});
  EXPECT_EQ(r.get("B7", "translation"), "0 0 0");
  EXPECT_TRUE(r.browser.addRoute(r.node("A"), "translation", r.node("B7"), "translation"));
  r.set("A", "translation", Vec3f{2, 0, 0});
  EXPECT_EQ(r.get("B7", "translation"), "2 0 0");
}

TEST(Routes, EventsCrossTheBordersOfPrototypes) {
  Running r("PROTO P [ eventIn SFVec3f in eventOut SFVec3f out ] { DEF T Transform { translation "
            "IS in translation_changed IS out } }"
            "DEF I P {} DEF A Transform {} DEF B Transform {}"
            "ROUTE A.translation TO I.in ROUTE I.out TO B.translation");
  r.set("A", "translation", Vec3f{1, 2, 3});
  EXPECT_EQ(r.get("B", "translation"), "1 2 3");
}

TEST(Routes, AnExposedFieldOfAPrototypeFollowsTheNodeInItsBody) {
  Running r("PROTO P [ exposedField SFVec3f at 1 1 1 ] { DEF T Transform { translation IS at } DEF "
            "U Transform {} ROUTE T.translation TO U.translation }"
            "DEF I P { at 5 5 5 } DEF B Transform {} ROUTE I.at_changed TO B.translation");
  EXPECT_EQ(r.get("I", "at"), "5 5 5");
  r.set("I", "set_at", Vec3f{7, 0, 0});
  EXPECT_EQ(r.get("I", "at"), "7 0 0");
  EXPECT_EQ(r.get("B", "translation"), "7 0 0");
}

TEST(Routes, AddChildrenIgnoresThoseThereAndRemoveChildrenThoseNot) {
  Running r("DEF G Group { children DEF A Group {} } DEF B Group {}");
  r.set("G", "addChildren", MFNode{r.browser.node("A"), r.browser.node("B")});
  EXPECT_EQ(r.get("G", "children"), "[A, B]");
  r.set("G", "removeChildren", MFNode{r.browser.node("A")});
  r.set("G", "removeChildren", MFNode{r.browser.node("A")});
  EXPECT_EQ(r.get("G", "children"), "[B]");
}

TEST(Routes, ANodeCannotBecomeItsOwnDescendant) {
  Running r("DEF G Group { children DEF A Group {} }");
  r.set("A", "addChildren", MFNode{r.browser.node("G")});
  EXPECT_EQ(r.get("A", "children"), "[]");
  EXPECT_EQ(r.browser.world().diagnostics.warnings(), 1u);
}

TEST(Changes, EachFieldIsReportedOnceBetweenTwoReadings) {
  Running r("DEF A Transform {} Shape { appearance Appearance { material DEF M Material {} } }");
  r.browser.takeChanges();
  r.set("A", "translation", Vec3f{1, 0, 0});
  r.set("A", "translation", Vec3f{2, 0, 0});
  r.set("M", "transparency", 0.5f);
  const FieldChanges changes = r.browser.takeChanges();
  ASSERT_EQ(changes.size(), 2u);
  EXPECT_EQ(changes[0].field->name, "translation");
  EXPECT_EQ(changes[1].field->change, Change::appearance);
  EXPECT_TRUE(r.browser.takeChanges().empty());
}

TEST(Changes, RoutesTellWhatTheyCanReach) {
  Running r("PROTO P [ eventIn SFVec3f in ] { DEF T Transform { translation IS in } } DEF I P {} "
            "DEF A Transform {} DEF B Transform {} ROUTE A.translation TO I.in");
  EXPECT_TRUE(reaches(*renderedNode(&r.node("I")), Change::transform));
  EXPECT_EQ(reachReason(*renderedNode(&r.node("I")), Change::transform),
            "ROUTE from A.translation");
  EXPECT_FALSE(reaches(r.node("B"), Change::transform));
}

} // namespace
} // namespace xvrml
