// binding.cpp: stacks of bindable nodes: clause 4.6.10, and 6.53 for Viewpoints.
#include "conformance/events/viewing.h"

namespace xvrml {
namespace {

std::string view(Running& r) { return nameOf(r.browser.bound().viewpoint); }

TEST(Binding, TheFirstOfEachTypeIsBoundAtTheStart) {
  Running r("Group { children [ DEF V1 Viewpoint {} DEF V2 Viewpoint {} ] } DEF B1 Background {} "
            "DEF F1 Fog {} DEF B2 Background {}"
            "DEF N1 NavigationInfo {} DEF N2 NavigationInfo {} DEF F2 Fog {}",
            5);
  EXPECT_EQ(view(r), "V1");
  EXPECT_EQ(nameOf(r.browser.bound().background), "B1");
  EXPECT_EQ(nameOf(r.browser.bound().fog), "F1");
  EXPECT_EQ(nameOf(r.browser.bound().navigationInfo), "N1");
  EXPECT_EQ(r.get("V1", "isBound"), "TRUE");
  EXPECT_EQ(r.get("V1", "bindTime"), "5");
  EXPECT_EQ(r.get("V2", "isBound"), "FALSE");
  EXPECT_EQ(r.get("F1", "isBound"), "TRUE");
}

TEST(Binding, OneViewpointIsBoundAndLookedFrom) {
  Running r("Viewpoint { position 1 2 3 orientation 0 1 0 1.5707963 }");
  EXPECT_EQ(eyeOf(r.browser), "1 2 3");
  EXPECT_EQ(lookOf(r.browser), "-1 0 0");
}

TEST(Binding, WithoutAnyTheStandardsDefaultsHold) {
  Running r("Shape {}");
  EXPECT_EQ(r.browser.bound(), BoundNodes());
  EXPECT_EQ(eyeOf(r.browser), "0 0 10");
  EXPECT_EQ(lookOf(r.browser), "0 0 -1");
}

TEST(Binding, TheFirstInAPrototypeCounts) {
  Running r("PROTO P [] { Group { children DEF INNER Viewpoint { position 0 0 5 } } } P {} DEF V "
            "Viewpoint {}");
  EXPECT_EQ(view(r), "INNER");
  EXPECT_EQ(eyeOf(r.browser), "0 0 5");
}

TEST(Binding, TheOrderIsThatOfTheFileEvenWhereAPrototypesFieldsAreConnected) {
  Running r("PROTO P [ exposedField SFVec3f at 0 0 1 ] { Group { children [ DEF A Viewpoint {} DEF "
            "B Viewpoint { position IS at } ] } }"
            "P {}");
  EXPECT_EQ(view(r), "A");
}

TEST(Binding, BothEventsOfASwapHaveOneTimeAndTheOldNodesComesFirst) {
  Running r("DEF A Viewpoint {} DEF B Viewpoint {}");
  for (const char* name : {"A", "B"}) {
    r.log(name, "isBound");
    r.log(name, "bindTime");
  }
  r.browser.tick(3);
  r.set("B", "set_bind", true);
  EXPECT_EQ(r.take(),
            (Log{"3 A.isBound FALSE", "3 A.bindTime 3", "3 B.isBound TRUE", "3 B.bindTime 3"}));
  EXPECT_EQ(view(r), "B");
}

TEST(Binding, BindingTheBoundNodeDoesNothing) {
  Running r("DEF A Viewpoint {}");
  r.log("A", "isBound");
  r.log("A", "bindTime");
  r.set("A", "set_bind", true);
  EXPECT_EQ(r.take(), Log{});
}

TEST(Binding, UnbindingTheTopBindsTheNext) {
  Running r("DEF A Fog {} DEF B Fog {} DEF C Fog {}");
  r.set("B", "set_bind", true);
  r.set("C", "set_bind", true);
  for (const char* name : {"A", "B", "C"}) r.log(name, "isBound");
  r.set("C", "set_bind", false);
  EXPECT_EQ(r.take(), (Log{"0 C.isBound FALSE", "0 B.isBound TRUE"}));
  r.set("B", "set_bind", false);
  r.set("A", "set_bind", false);
  EXPECT_EQ(r.take(), (Log{"0 B.isBound FALSE", "0 A.isBound TRUE", "0 A.isBound FALSE"}));
  EXPECT_EQ(r.browser.bound().fog, nullptr);
}

TEST(Binding, UnbindingBelowTheTopRemovesSilently) {
  Running r("DEF A Background {} DEF B Background {} DEF C Background {}");
  r.set("B", "set_bind", true);
  r.set("C", "set_bind", true);
  for (const char* name : {"A", "B", "C"}) r.log(name, "isBound");
  r.set("B", "set_bind", false);
  EXPECT_EQ(r.take(), Log{});
  r.set("C", "set_bind", false);
  EXPECT_EQ(r.take(), (Log{"0 C.isBound FALSE", "0 A.isBound TRUE"}));
}

TEST(Binding, UnbindingANodeThatIsNotInTheStackIsIgnored) {
  Running r("DEF A Viewpoint {} DEF B Viewpoint {}");
  r.log("A", "isBound");
  r.log("B", "isBound");
  r.set("B", "set_bind", false);
  EXPECT_EQ(r.take(), Log{});
  EXPECT_EQ(view(r), "A");
}

TEST(Binding, BindingANodeInTheStackMovesItToTheTop) {
  Running r("DEF A Viewpoint {} DEF B Viewpoint {}");
  r.set("B", "set_bind", true);
  r.set("A", "set_bind", true);
  r.set("A", "set_bind", false);
  EXPECT_EQ(view(r), "B");
  r.set("B", "set_bind", false);
  EXPECT_EQ(view(r), "none"); // A was in the stack only once
}

TEST(Binding, ANodeThatLeavesTheSceneIsUnbound) {
  Running r("DEF A Viewpoint { position 1 0 0 } DEF G Group { children DEF T Transform { children "
            "DEF B Viewpoint {} } }");
  r.set("B", "set_bind", true);
  r.log("A", "isBound");
  r.log("B", "isBound");
  r.set("G", "removeChildren", MFNode{r.browser.node("T")});
  EXPECT_EQ(r.take(), (Log{"0 B.isBound FALSE", "0 A.isBound TRUE"}));
  EXPECT_EQ(eyeOf(r.browser), "1 0 0");
}

TEST(Binding, NodesThatLeaveTogetherAreNotBoundInBetween) {
  Running r(
      "DEF A Viewpoint {} DEF G Group { children [ DEF B Viewpoint {} DEF C Viewpoint {} ] }");
  r.set("B", "set_bind", true);
  r.set("C", "set_bind", true);
  for (const char* name : {"A", "B", "C"}) r.log(name, "isBound");
  r.set("G", "children", MFNode{});
  EXPECT_EQ(r.take(), (Log{"0 C.isBound FALSE", "0 A.isBound TRUE"}));
}

TEST(Binding, NodesAddedWhileRunningCanBeBound) {
  Running r("DEF A Viewpoint {} DEF T Transform { translation 0 5 0 }");
  const NodeRef added = r.browser.createNode("Viewpoint");
  r.set("T", "addChildren", MFNode{added});
  EXPECT_EQ(view(r), "A"); // a new Viewpoint is not bound automatically
  r.browser.set(*added, "set_bind", true);
  EXPECT_EQ(r.browser.bound().viewpoint, added.get());
  EXPECT_EQ(eyeOf(r.browser), "0 5 10");
}

TEST(Binding, ANodeMayBeBoundBeforeItIsAdded) {
  Running r("DEF A Viewpoint {} DEF T Transform {}");
  const NodeRef added = r.browser.createNode("Viewpoint");
  r.browser.set(*added, "set_bind", true);
  r.set("T", "addChildren", MFNode{added});
  EXPECT_EQ(r.browser.bound().viewpoint, added.get());
  r.set("T", "removeChildren", MFNode{added});
  EXPECT_EQ(view(r), "A");
}

TEST(Binding, NodesFromAStringAreNotBoundByThemselvesAndCanBe) {
  Running r("DEF T Transform { translation 0 5 0 }");
  const MFNode made = r.browser.createVrmlFromString("DEF S Viewpoint { position 0 0 1 } Fog {}");
  r.set("T", "addChildren", made);
  EXPECT_EQ(r.browser.bound(), BoundNodes());
  EXPECT_EQ(eyeOf(r.browser), "0 0 10");
  r.browser.set(*made[0], "set_bind", true);
  EXPECT_EQ(view(r), "S");
  EXPECT_EQ(eyeOf(r.browser), "0 5 1");
  r.set("T", "removeChildren", MFNode{made[0]});
  EXPECT_EQ(view(r), "none");
}

TEST(Binding, OfAWorldThatReplacesAnotherTheFirstAreBound) {
  Running r("DEF A Viewpoint { position 1 0 0 } DEF F Fog {}");
  r.browser.navigate({.ahead = 1}, 1);
  const MFNode made = r.browser.createVrmlFromString(
      "DEF S Viewpoint { jump FALSE position 0 0 1 } DEF U Viewpoint {}");
  r.browser.replaceWorld(made);
  EXPECT_EQ(view(r), "S");
  EXPECT_EQ(r.browser.bound().fog, nullptr);
  EXPECT_EQ(eyeOf(r.browser), "0 0 1"); // jump FALSE keeps no view of a world that was replaced
}

TEST(Binding, ChangesTellWhatWasBound) {
  Running r("DEF A Background {} DEF B Background {}");
  r.browser.takeChanges();
  r.set("B", "set_bind", true);
  const FieldChanges changes = r.browser.takeChanges();
  ASSERT_EQ(changes.size(), 2u);
  EXPECT_EQ(changes[0].field->name, "set_bind");
  EXPECT_EQ(changes[0].node->defName, "A");
  EXPECT_EQ(changes[1].node->defName, "B");
}

TEST(Viewpoints, JumpTrueMovesTheViewer) {
  Running r("DEF A Viewpoint {} DEF B Viewpoint { position 7 0 0 }");
  r.set("B", "set_bind", true);
  EXPECT_EQ(eyeOf(r.browser), "7 0 0");
}

TEST(Viewpoints, JumpFalseLeavesTheViewWhereItIsAndCarriesItFromThenOn) {
  Running r("DEF A Viewpoint { position 0 0 4 } DEF T Transform { translation 3 0 0 rotation 0 1 0 "
            "1 scale 2 3 4"
            " children DEF B Viewpoint { jump FALSE position 7 0 0 } }");
  r.set("B", "set_bind", true);
  EXPECT_EQ(eyeOf(r.browser), "0 0 4");
  EXPECT_EQ(lookOf(r.browser), "0 0 -1");
  r.set("T", "translation", Vec3f{4, 0, 0});
  EXPECT_EQ(eyeOf(r.browser), "1 0 4");
}

TEST(Viewpoints, PoppingAViewpointThatDidNotJumpLeavesTheView) {
  Running r("DEF A Viewpoint { position 0 0 4 } DEF T Transform { children DEF B Viewpoint { jump "
            "FALSE } }");
  r.set("B", "set_bind", true);
  r.set("T", "translation", Vec3f{1, 0, 0});
  r.set("B", "set_bind", false);
  EXPECT_EQ(view(r), "A");
  EXPECT_EQ(eyeOf(r.browser), "1 0 4");
}

TEST(Viewpoints, PoppingAViewpointThatIsGoneStillLeavesTheView) {
  Running r("DEF A Viewpoint {} DEF T Transform { translation 1 0 0 children DEF B Viewpoint { "
            "jump FALSE } }");
  r.set("B", "set_bind", true);
  r.set("T", "translation", Vec3f{3, 0, 0});
  r.set("T", "children", MFNode{});
  EXPECT_EQ(eyeOf(r.browser), "2 0 10");
}

TEST(Viewpoints, TransformationsAboveCarryTheViewer) {
  Running r(
      "DEF T Transform { children Transform { translation 0 1 0 children DEF A Viewpoint {} } }");
  r.set("T", "rotation", Rotation{0, 1, 0, 1.5707963f});
  EXPECT_EQ(eyeOf(r.browser), "10 1 0");
  EXPECT_EQ(lookOf(r.browser), "-1 0 0");
  r.set("A", "position", Vec3f{0, 0, 2});
  EXPECT_EQ(eyeOf(r.browser), "2 1 0");
}

TEST(Viewpoints, ScaleDoesNotDistortTheView) {
  Running r(
      "Transform { scale 2 1 5 children Viewpoint { position 1 1 1 orientation 0 1 0 0.5 } }");
  const CameraSettings c = r.browser.camera(1);
  EXPECT_EQ(eyeOf(r.browser), "2 1 5");
  for (int axis = 0; axis < 3; ++axis)
    EXPECT_NEAR(std::hypot(c.matrix[4 * axis], c.matrix[4 * axis + 1], c.matrix[4 * axis + 2]), 1,
                1e-12);
}

TEST(Viewpoints, TheFieldOfViewIsThatOfTheSmallerSide) {
  Running r("Viewpoint { fieldOfView 1 }");
  EXPECT_NEAR(r.browser.camera(2).fovy, 1, 1e-6);
  EXPECT_NEAR(r.browser.camera(0.5).fovy, 2 * std::atan(std::tan(0.5) * 2), 1e-6);
}

TEST(Viewpoints, ATransitionMovesTheEyeOverTimeAndEndsExactly) {
  Running r("DEF A Viewpoint { position 0 0 0 } DEF B Viewpoint { position 8 0 0 orientation 0 1 0 "
            "1.5707963 }");
  r.browser.setTransition(2);
  r.browser.tick(10);
  r.set("B", "set_bind", true);
  EXPECT_EQ(eyeOf(r.browser), "0 0 0");
  r.browser.tick(11);
  EXPECT_EQ(eyeOf(r.browser), "4 0 0");
  EXPECT_EQ(lookOf(r.browser), "-0.70711 0 -0.70711");
  r.browser.tick(12);
  EXPECT_EQ(eyeOf(r.browser), "8 0 0");
}

TEST(Viewpoints, ASquashedViewpointStillHasAView) {
  Running r("DEF A Viewpoint {} DEF T Transform { scale 1 1 0.00001 children DEF B Viewpoint { "
            "jump FALSE } }");
  r.set("T", "scale", Vec3f{0, 0, 0});
  r.set("B", "set_bind", true);
  EXPECT_EQ(eyeOf(r.browser), "0 0 10");
}

} // namespace
} // namespace xvrml
