// What is meant by a world that breaks a rule: as much of it as can be is kept, and one message says so.
#include "conformance/events/scripted.h"

namespace xvrml {
namespace {

Node& drawn(Running& r, std::string_view name) { return *renderedNode(r.browser.node(name).get()); }
std::string fieldOf(Node& node, const char* field) { return textOf(node.get(*node.type().find(field))); }
uint64_t errors(Running& r) { return r.browser.world().diagnostics.errors(); }

TEST(Recovery, ANodeMayBeUsedWithinAFieldOfItsOwnThatIsNotDrawn) { // key frames of Cosmo Worlds
  const std::string text = "PROTO Keys [ field MFNode actors [] ] { Group {} } "
                           "DEF K Keys { actors [ DEF T Transform { children [ Group {} USE K ] } ] } USE T";
  Running r(text);
  EXPECT_EQ(r.browser.world().diagnostics.list().size(), 0u);
  EXPECT_EQ(r.get("T", "children"), "[Group, K]");
  EXPECT_EQ(r.get("K", "actors"), "[T]");
  const auto again = loadWorldFromMemory(writeWorld(r.browser.world()), "again.wrl");
  std::string difference;
  EXPECT_TRUE(equalScopes(r.browser.world().scope, again->scope, &difference)) << difference;
}

TEST(Recovery, InACopyOfAPrototypesBodyToo) {
  Running r("PROTO Keys [ field MFNode actors [] ] { Group {} } "
            "PROTO Film [] { Group { children DEF K Keys { actors DEF T Transform { children USE K } } } } DEF A Film {} DEF B "
            "Film {}");
  EXPECT_EQ(r.browser.world().diagnostics.list().size(), 0u);
}

TEST(Recovery, WhatAPrototypeDrawsCannotHoldIt) {
  const std::string p = "PROTO P [ field MFNode c [] ] { Group { children IS c } } ";
  for (const char* world : {"DEF K P { c [ USE K ] }", "DEF K P { c [ Group { children [ Group {} USE K ] } ] }",
                            "DEF K P { c DEF T Transform { children P { c USE K } } }", "DEF K Group { children P { c USE K } }",
                            "DEF K Group { children P { c Group { children USE K } } }"}) {
    Running r(p + world);
    EXPECT_EQ(errors(r), 1u) << world;
    r.browser.tick(1);
  }
}

TEST(Recovery, AGroupCannotHoldItselfWhateverIsBetween) {
  Running r("DEF K Group { children Transform { children USE K } }");
  EXPECT_EQ(errors(r), 1u);
}

TEST(Recovery, AFieldThatIsAnExposedFieldTakesTheGivenValue) {
  Running r("PROTO Plane [ exposedField SFVec3f size 10 10 .1 ] { Box { size IS size } } "
            "Shape { geometry DEF A Plane { size 1 2 3 } } Shape { geometry DEF B Plane {} }");
  EXPECT_EQ(errors(r), 1u);
  EXPECT_EQ(fieldOf(drawn(r, "A"), "size"), "1 2 3");
  EXPECT_EQ(fieldOf(drawn(r, "B"), "size"), "10 10 0.1");
  r.log("A", "size");
  r.set("A", "size", Vec3f{4, 4, 4}); // the instance's own
  EXPECT_EQ(r.take(), Log{"0 A.size 4 4 4"});
  EXPECT_EQ(fieldOf(drawn(r, "A"), "size"), "1 2 3");
}

TEST(Recovery, AnEventOutThatIsAnExposedFieldSends) {
  Running r("PROTO P [ exposedField SFTime beat 0 ] { TimeSensor { loop TRUE time IS beat } } DEF A P {}");
  EXPECT_EQ(errors(r), 1u);
  r.log("A", "beat");
  r.browser.tick(2);
  EXPECT_EQ(r.take(), Log{"2 A.beat 2"});
}

TEST(Recovery, AScriptWithAnExposedFieldRunsAndHasItAsAField) {
  Scripted r("DEF T TimeSensor {} DEF S Script { exposedField SFInt32 n 20 eventIn SFInt32 a eventOut SFInt32 b url \"test:a: "
             "add n b\" } "
             "DEF W Switch {} ROUTE S.b TO W.whichChoice");
  EXPECT_EQ(errors(r), 1u);
  r.set("S", "a", 2);
  EXPECT_EQ(r.get("W", "whichChoice"), "22");
}

TEST(Recovery, AScriptWithADeclarationOfAnUnknownTypeRunsWithoutIt) {
  Scripted r(
      "DEF S Script { field SFVec4f v 1 2 3 4 field MFDouble d [ 1 2 ] eventOut SFDouble o field SFInt32 n 20 eventIn SFInt32 a "
      "eventOut SFInt32 b url \"test:a: add n b\" } DEF W Switch {} ROUTE S.b TO W.whichChoice");
  EXPECT_EQ(errors(r), 3u);
  r.set("S", "a", 2);
  EXPECT_EQ(r.get("W", "whichChoice"), "22");
}

TEST(Recovery, AMisplacedNodeKeepsItsName) {
  Running r("DEF RED Material { diffuseColor 1 0 0 } DEF S Shape { appearance DEF A Appearance { material USE RED } "
            "geometry Group { children DEF IN Group {} } } Group { children USE IN }");
  EXPECT_EQ(errors(r), 2u); // the Material at the root, the Group as geometry
  EXPECT_EQ(r.browser.world().diagnostics.warnings(), 0u);
  EXPECT_EQ(r.get("A", "material"), "RED");
  EXPECT_EQ(r.get("S", "geometry"), "NULL");
  EXPECT_EQ(r.browser.world().scope.roots.size(), 2u);
  const auto again = loadWorldFromMemory(writeWorld(r.browser.world()), "again.wrl");
  EXPECT_EQ(again->diagnostics.list().size(), 0u); // the Material is DEFined where it is USEd first
}

TEST(Recovery, ScriptsSendToNodesWhereOldWorldsMay) {
  const std::string world = "DEF S Script { field SFNode g USE G eventIn SFInt32 go url \"test:go: post g set_whichChoice\" }";
  for (const bool old : {false, true}) {
    Scripted r("DEF G Switch {} " + world, {}, {.epoch = 0, .directOutputAlways = old});
    r.set("S", "go", 3);
    EXPECT_EQ(r.get("G", "whichChoice"), old ? "3" : "-1");
    EXPECT_EQ(r.messages().size(), old ? 0u : 1u);
  }
}

} // namespace
} // namespace xvrml
