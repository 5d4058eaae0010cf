// grouping.cpp: lists of children in a running world: addChildren, removeChildren and
// children_changed (4.6.5), through prototype instances (4.8.2), and how the result is written.
#include "conformance/events/support.h"

namespace xvrml {
namespace {

// Writes the current world and loads the result.
std::unique_ptr<World> again(Running& r) {
  return loadWorldFromMemory(writeWorld(r.browser.world()), "again.wrl");
}

// Returns the children of the node that a node stands for.
std::string childrenOf(const NodeRef& node, const char* field = "children") {
  Node* drawn = renderedNode(node.get());
  return textOf(drawn->get(*drawn->type().find(field)));
}

TEST(Grouping, AddedAndRemovedChildrenAreTold) {
  for (const char* type : {"Group", "Transform", "Anchor", "Billboard", "Collision"}) {
    Running r(std::string("DEF G ") + type + " { children DEF A Group {} } DEF B Group {}");
    r.log("G", "children");
    r.set("G", "addChildren", MFNode{r.browser.node("B")});
    EXPECT_EQ(r.take(), Log{"0 G.children [A, B]"}) << type;
    r.set("G", "removeChildren", MFNode{r.browser.node("A")});
    EXPECT_EQ(r.take(), Log{"0 G.children [B]"}) << type;
  }
}

TEST(Grouping, WhatChangesNothingIsNotTold) {
  Running r("DEF G Group { children DEF A Group {} } DEF B Group {} DEF M Material {}");
  r.log("G", "children");
  r.set("G", "addChildren", MFNode{r.browser.node("A")});    // already present
  r.set("G", "removeChildren", MFNode{r.browser.node("B")}); // not present
  r.set("G", "addChildren", MFNode{r.browser.node("M")});    // not allowed there
  r.set("G", "addChildren", MFNode{r.browser.node("G")});    // a node cannot contain itself
  r.set("G", "addChildren", MFNode{});
  EXPECT_EQ(r.take(), Log{});
}

TEST(Grouping, ChildrenChangedGoesAlongRoutes) {
  Running r(
      "DEF G Group {} DEF H Group {} DEF B Group {} ROUTE G.children_changed TO H.set_children");
  r.set("G", "addChildren", MFNode{r.browser.node("B")});
  EXPECT_EQ(r.get("H", "children"), "[B]");
}

const std::string interface =
    "PROTO P [ exposedField MFNode c [] eventIn MFNode add eventIn MFNode rem ] { Group { children "
    "IS c addChildren IS add removeChildren IS rem } } ";

TEST(Grouping, AnInstanceHasTheChildrenOfTheNodeThatIsThem) {
  Running r(interface + "DEF A P { c DEF X Group {} } DEF Y Group {}");
  r.log("A", "c");
  r.set("A", "add", MFNode{r.browser.node("Y")});
  EXPECT_EQ(r.get("A", "c"), "[X, Y]");
  r.set("A", "rem", MFNode{r.browser.node("X")});
  EXPECT_EQ(r.get("A", "c"), "[Y]");
  EXPECT_EQ(r.take(), (Log{"0 A.c [X, Y]", "0 A.c [Y]"}));
}

TEST(Grouping, WhatAnInstanceWasGivenIsWritten) {
  Running r(interface + "DEF A P {} DEF Y Group {}");
  r.set("A", "add", MFNode{r.browser.node("Y")});
  const auto world = again(r);
  EXPECT_EQ(world->diagnostics.list().size(), 0u);
  EXPECT_EQ(childrenOf(world->scope.names.at("A")), "[Y]");
}

TEST(Grouping, InstancesOfInstancesHaveThemToo) {
  Running r(interface + "PROTO Q [ exposedField MFNode d [] eventIn MFNode more ] { P { c IS d add "
                        "IS more } } DEF A Q { d DEF X Group {} } DEF Y Group {}");
  r.set("A", "more", MFNode{r.browser.node("Y")});
  EXPECT_EQ(r.get("A", "d"), "[X, Y]");
  EXPECT_EQ(childrenOf(again(r)->scope.names.at("A")), "[X, Y]");
}

// Although children_changed reports only the first one (4.10.3).
TEST(Grouping, SeveralChangesAtOneTimeAreAllKept) {
  Running r(interface + "DEF A P {} DEF X Group {} DEF N Group {} ROUTE N.children TO A.add ROUTE "
                        "N.children TO A.rem");
  r.log("A", "c");
  r.set("N", "children", MFNode{r.browser.node("X")});
  EXPECT_EQ(r.take(), Log{"0 A.c [X]"});
  EXPECT_EQ(r.get("A", "c"), "[]");
  EXPECT_EQ(childrenOf(r.browser.node("A")), "[]");
}

// Not only an exposedField.
TEST(Grouping, AFieldOfAnInstanceIsWrittenAsItsNodeHasIt) {
  Running r("PROTO P [ field MFNode c [] field SFVec3f at 0 0 0 eventIn MFNode add eventIn SFVec3f "
            "move ] { Transform { children IS c addChildren IS add translation IS at "
            "set_translation IS move } } DEF A P { c DEF X Group {} } DEF Y Group {}");
  r.set("A", "add", MFNode{r.browser.node("Y")});
  r.set("A", "move", Vec3f{1, 2, 3});
  const auto world = again(r);
  EXPECT_EQ(world->diagnostics.list().size(), 0u);
  EXPECT_EQ(childrenOf(world->scope.names.at("A")), "[X, Y]");
  EXPECT_EQ(childrenOf(world->scope.names.at("A"), "translation"), "1 2 3");
}

// It cannot have the values of both nodes.
TEST(Grouping, AFieldThatTwoNodesShareIsWrittenAsItWasGiven) {
  Running r(
      "PROTO P [ field SFVec3f at 5 0 0 eventIn SFVec3f move ] { Transform { translation IS at "
      "set_translation IS move children DEF I Transform { translation IS at } } } DEF A P {}");
  r.set("A", "move", Vec3f{1, 2, 3});
  EXPECT_EQ(childrenOf(again(r)->scope.names.at("A"), "translation"), "5 0 0");
}

TEST(Grouping, OtherListsOfNodesCrossTheBorderToo) {
  Running r("PROTO S [ exposedField MFNode c [] exposedField SFInt32 which 0 ] { Switch { choice "
            "IS c whichChoice IS which } } PROTO L [ exposedField MFNode c [] ] { LOD { level IS c "
            "} } DEF A S {} DEF B L {} DEF X Group {} DEF Y Group {} DEF C S {} ROUTE A.c_changed "
            "TO C.set_c ROUTE A.which_changed TO C.set_which");
  const MFNode both{r.browser.node("X"), NodeRef(), r.browser.node("Y")};
  r.set("A", "c", both);
  r.set("B", "c", both);
  r.set("A", "which", 2);
  for (const char* name : {"A", "B", "C"}) EXPECT_EQ(r.get(name, "c"), "[X, NULL, Y]") << name;
  const auto world = again(r);
  for (const char* name : {"A", "C"})
    EXPECT_EQ(childrenOf(world->scope.names.at(name), "choice"), "[X, NULL, Y]") << name;
  EXPECT_EQ(childrenOf(world->scope.names.at("B"), "level"), "[X, NULL, Y]");
  EXPECT_EQ(childrenOf(world->scope.names.at("C"), "whichChoice"), "2");
}

TEST(Grouping, AnExposedFieldThatReachesEventInsAloneKeepsAndTellsItsValue) {
  Running r("PROTO P [ exposedField SFVec3f at 0 0 0 ] { Group { children DEF T Transform { "
            "set_translation IS at } } } DEF A P {}");
  EXPECT_EQ(r.browser.world().diagnostics.list().size(), 1u); // table 4.4
  r.log("A", "at");
  r.set("A", "at", Vec3f{1, 2, 3});
  EXPECT_EQ(r.take(), Log{"0 A.at 1 2 3"});
  EXPECT_EQ(r.get("A", "at"), "1 2 3");
}

} // namespace
} // namespace xvrml
