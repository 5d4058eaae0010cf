// editing.cpp: changes to a running world: nodes and routes are added and removed, also within a
// cascade; random routes. Clauses 4.7, 4.10.
#include <random>

#include "conformance/events/scripted.h"

namespace xvrml {
namespace {

TEST(Editing, ANodeMayEndDuringItsOwnEvent) {
  Running r("DEF G Group { children DEF A Transform {} } DEF B Transform {}");
  MFNode made = r.browser.createVrmlFromString(
      "DEF X Transform {} DEF Y Transform {} ROUTE X.translation TO Y.translation");
  NodeRef x = made[0];
  r.set("G", "children", std::move(made));
  r.browser.listen(*x, "translation", [&](Node&, const FieldInfo&, const Value&) {
    r.browser.set(r.node("G"), "children", MFNode{}); // removes everything that held it
    x = {};
  });
  r.browser.set(*x, "translation", Vec3f{1, 0, 0});
  EXPECT_FALSE(x);
  EXPECT_EQ(r.get("G", "children"), "[]");
}

TEST(Editing, AnInstanceMayEndDuringAnEventOfItsBody) {
  Running r("DEF G Group {}");
  MFNode made = r.browser.createVrmlFromString(
      "PROTO P [ eventOut SFVec3f out eventIn SFVec3f in ] { DEF T Transform { set_translation IS "
      "in translation_changed IS out } } P {}");
  NodeRef instance = made[0];
  const NodeRef body(renderedNode(instance.get()));
  r.set("G", "children", std::move(made));
  int heard = 0;
  r.browser.listen(*body, "translation", [&](Node&, const FieldInfo&, const Value&) {
    ++heard;
    r.browser.set(r.node("G"), "children", MFNode{});
    instance = {};
  });
  r.browser.set(*instance, "in", Vec3f{1, 0, 0});
  EXPECT_EQ(heard, 1);
  r.browser.set(*body, "translation", Vec3f{2, 0, 0}); // it outlives its instance
  EXPECT_EQ(heard, 2);
}

TEST(Editing, RoutesMadeWithinACascadeDoNotCarryItsEvent) {
  Running r("DEF A Transform {} DEF B Transform {} DEF C Transform {} ROUTE A.translation TO "
            "B.translation");
  r.browser.listen(r.node("B"), "translation", [&](Node&, const FieldInfo&, const Value&) {
    r.browser.addRoute(r.node("A"), "translation", r.node("C"), "translation");
    r.browser.deleteRoute(r.node("A"), "translation", r.node("B"), "translation");
  });
  r.set("A", "translation", Vec3f{1, 0, 0});
  EXPECT_EQ(r.get("C", "translation"), "0 0 0");
  r.set("A", "translation", Vec3f{2, 0, 0});
  EXPECT_EQ(r.get("B", "translation"), "1 0 0");
  EXPECT_EQ(r.get("C", "translation"), "2 0 0");
}

TEST(Editing, EventInsReplaceTheFieldsTheyAreNamedFor) {
  Running r("Shape { geometry DEF F IndexedFaceSet {} } Shape { geometry DEF E ElevationGrid { "
            "height [ 0 0 0 0 ] } } DEF K PositionInterpolator { key [ 0 1 ] }");
  r.set("F", "set_coordIndex", MFInt32{0, 1, 2, -1});
  r.set("E", "set_height", MFFloat{1, 2, 3, 4});
  r.set("K", "set_key", MFFloat{0, 0.5f});
  EXPECT_EQ(r.get("F", "coordIndex"), "[0, 1, 2, -1]");
  EXPECT_EQ(r.get("E", "height"), "[1, 2, 3, 4]");
  EXPECT_EQ(r.get("K", "key"), "[0, 0.5]");
}

TEST(Editing, AWideFanOutReachesEverybody) {
  std::string text = "DEF A Transform {} DEF All Group { children [";
  constexpr int n = 100'000;
  for (int i = 0; i < n; ++i) text += fmt::format("DEF T{} Transform {{}}\n", i);
  text += "] }";
  for (int i = 0; i < n; ++i) text += fmt::format("ROUTE A.translation TO T{}.translation\n", i);
  Running r(text);
  r.set("A", "translation", Vec3f{1, 0, 0});
  for (const int i : {0, n / 2, n - 1})
    EXPECT_EQ(r.get(fmt::format("T{}", i), "translation"), "1 0 0");
  EXPECT_EQ(r.browser.world().diagnostics.warnings(), 0u);
}

// Random routes among nodes of one type, with loops, and events into them while routes are added
// and removed.
Log randomRun(unsigned seed, uint64_t& warnings) {
  std::mt19937 random(seed);
  const auto pick = [&](int below) { return int(random() % unsigned(below)); };
  const int nodes = 2 + pick(30), routes = pick(90);
  std::string text = "PROTO P [ exposedField SFVec3f translation 0 0 0 ] { Transform { translation "
                     "IS translation } }";
  for (int i = 0; i < nodes; ++i)
    text += fmt::format(" DEF N{} {} {{}}", i, pick(4) ? "Transform" : "P");
  for (int i = 0; i < routes; ++i)
    text += fmt::format(" ROUTE N{}.translation TO N{}.translation", pick(nodes), pick(nodes));
  Running r(text);
  for (int i = 0; i < nodes; ++i) r.log(fmt::format("N{}", i), "translation");
  for (int step = 0; step < 30; ++step) {
    Node &a = r.node(fmt::format("N{}", pick(nodes))), &b = r.node(fmt::format("N{}", pick(nodes)));
    switch (pick(4)) {
    case 0: r.browser.addRoute(a, "translation_changed", b, "set_translation"); break;
    case 1: r.browser.deleteRoute(a, "translation", b, "translation"); break;
    default: r.browser.set(a, "translation", Vec3f{float(pick(100)), float(pick(100)), 0});
    }
    r.browser.tick(step * 0.1);
  }
  warnings = r.browser.world().diagnostics.warnings();
  return r.take();
}

TEST(Editing, RandomRoutesGiveTheSameEventsEachTime) {
  for (unsigned seed = 1; seed <= 200; ++seed) {
    uint64_t first = 0, second = 0;
    const Log log = randomRun(seed, first);
    EXPECT_EQ(log, randomRun(seed, second)) << seed;
    EXPECT_EQ(first + second, 0u) << seed;
    EXPECT_LT(log.size(), 30u * 32u + 1) << seed; // at most once per cascade each
  }
}

} // namespace
} // namespace xvrml
