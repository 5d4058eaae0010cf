// minimum_limits.cpp: clause 7.3.3, table 7.1: the sizes that every browser must support, written
// as files, loaded and run without messages.
#include <functional>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "geometry/mesh.h"
#include "xvrml/browser.h"
#include "xvrml/nodes.h"

namespace {

using namespace xvrml;

std::string times(int count, const std::function<std::string(int)>& text) {
  std::string all;
  for (int i = 0; i < count; ++i) all += text(i) + "\n";
  return all;
}

std::unique_ptr<World> load(const std::string& text) {
  auto world = loadWorldFromMemory("#VRML V2.0 utf8\n" + text, "limits.wrl");
  for (const Diagnostic& d : world->diagnostics.list()) ADD_FAILURE() << d.text();
  return world;
}

Mesh meshOf(World& world, std::string_view name) {
  return buildMesh(*world.scope.names.find(name)->second,
                   {false, &world.options.limits, &world.diagnostics});
}

TEST(MinimumLimits, FiveHundredChildrenOfAGroup) {
  const auto world = load("DEF G Group { children [" +
                          times(500, [](int) { return "Shape { geometry Box {} }"; }) + "] }");
  EXPECT_EQ(nodeCast<nodes::Group>(world->scope.roots[0])->children.size(), 500u);
}

TEST(MinimumLimits, AThousandKeysOfAnInterpolator) {
  Browser browser(load("DEF I ScalarInterpolator { key [" +
                       times(1000, [](int i) { return fmt::format("{}", i / 999.0); }) +
                       "] keyValue [" + times(1000, [](int i) { return fmt::format("{}", i); }) +
                       "] }"));
  const NodeRef node = browser.node("I");
  browser.set(*node, "set_fraction", 0.5f);
  EXPECT_NEAR(std::get<float>(browser.get(*node, "value_changed")), 499.5, 1e-3);
}

TEST(MinimumLimits, NamesOfFiftyBytes) {
  const std::string name(50, 'n');
  EXPECT_EQ(load("DEF " + name + " Group {}")->scope.names.count(name), 1u);
}

TEST(MinimumLimits, ThirtyOfEachKindInAPrototype) {
  std::string interface, body;
  for (const char* access : {"field", "exposedField"})
    interface +=
        times(30, [&](int i) { return fmt::format("{} SFFloat {}{} {}", access, access, i, i); });
  for (const char* access : {"eventIn", "eventOut"})
    interface +=
        times(30, [&](int i) { return fmt::format("{} SFFloat {}{}", access, access, i); });
  const auto world = load("PROTO P [ " + interface + " ] { Group {} } P {}");
  EXPECT_EQ(world->scope.roots[0]->type().fields.size(), 120u);
}

TEST(MinimumLimits, PrototypesNestedFiveDeepWithRoutesThroughAll) {
  std::string text =
      "PROTO P0 [ exposedField SFVec3f at 0 0 0 ] { Transform { translation IS at } }";
  for (int i = 1; i < 5; ++i)
    text += fmt::format("PROTO P{} [ exposedField SFVec3f at 0 0 0 ] {{ P{} {{ at IS at }} }}", i,
                        i - 1);
  Browser browser(load(text + "DEF A P4 {} DEF B P4 {} ROUTE A.at_changed TO B.set_at"));
  browser.set(*browser.node("A"), "set_at", Vec3f{1, 2, 3});
  EXPECT_EQ(std::get<Vec3f>(browser.get(*browser.node("B"), "at")), (Vec3f{1, 2, 3}));
  EXPECT_EQ(nodeCast<nodes::Transform>(renderedNode(browser.node("B").get()))->translation,
            (Vec3f{1, 2, 3}));
}

TEST(MinimumLimits, PrototypesDefinedWithinEachOtherFiveDeep) {
  std::string text = "PROTO P0 [] { Shape { geometry DEF IT Box { size 3 3 3 } } }";
  for (int i = 1; i < 5; ++i) text = fmt::format("PROTO P{} [] {{ {} P{} {{}} }}", i, text, i - 1);
  const auto world = load(text + "P4 {}");
  EXPECT_EQ(renderedNode(world->scope.roots[0].get())->type().name, "Shape");
}

TEST(MinimumLimits, AStringOfThirtyThousandBytes) {
  const auto world = load("WorldInfo { title \"" + std::string(30000, 'x') + "\" }");
  EXPECT_EQ(nodeCast<nodes::WorldInfo>(world->scope.roots[0])->title.size(), 30000u);
}

TEST(MinimumLimits, FifteenThousandColoursAndPoints) {
  const auto triple = [](int i) { return fmt::format("{} {} {}", i % 2, 0, 1); };
  const auto world =
      load("Shape { geometry DEF G PointSet { coord Coordinate { point [" + times(15000, triple) +
           "] } color Color { color [" + times(15000, triple) + "] } } }");
  EXPECT_EQ(meshOf(*world, "G").indices.size(), 15000u);
}

TEST(MinimumLimits, AnElevationGridOfSixteenThousandHeights) {
  const auto world =
      load("Shape { geometry DEF G ElevationGrid { xDimension 160 zDimension 100 height [" +
           times(16000, [](int i) { return fmt::format("{}", i % 7); }) + "] } }");
  EXPECT_EQ(meshOf(*world, "G").indices.size(), 3u * 2 * 159 * 99);
}

// 50 x 50 points: the sides, and two caps of 49 corners.
TEST(MinimumLimits, AnExtrusionOfTwoThousandFiveHundredPoints) {
  const auto corner = [](int i) {
    const double a = 6.283185307179586 * i / 49;
    return i == 49 ? std::string("1 0") : fmt::format("{:.6f} {:.6f}", std::cos(a), -std::sin(a));
  };
  const auto world =
      load("Shape { geometry DEF G Extrusion { crossSection [" + times(50, corner) + "] spine [" +
           times(50, [](int i) { return fmt::format("0 {} 0", i); }) + "] } }");
  EXPECT_EQ(meshOf(*world, "G").indices.size() / 3, 2u * 49 * 49 + 2 * 47);
}

TEST(MinimumLimits, FiveThousandFacesOfTenCorners) {
  std::string index;
  for (int f = 0; f < 5000; ++f) {
    for (int i = 0; i < 10; ++i) index += fmt::format("{} ", (i + f) % 10);
    index += "-1\n";
  }
  const auto world =
      load("Shape { geometry DEF G IndexedFaceSet { coordIndex [" + index +
           "] coord Coordinate { point [" +
           times(10,
                 [](int i) {
                   return fmt::format("{:.6f} {:.6f} 0", std::cos(i * 0.628318530718),
                                      std::sin(i * 0.628318530718));
                 }) +
           "] } } }");
  EXPECT_EQ(meshOf(*world, "G").indices.size() / 3, 5000u * 8);
}

TEST(MinimumLimits, FifteenThousandVerticesOfAnIndexedLineSet) {
  const auto world = load("Shape { geometry DEF G IndexedLineSet { coordIndex [" +
                          times(15000, [](int i) { return fmt::format("{}", i); }) +
                          "] coord Coordinate { point [" +
                          times(15000, [](int i) { return fmt::format("{} 0 0", i); }) + "] } } }");
  EXPECT_EQ(meshOf(*world, "G").indices.size() / 2, 14999u);
}

TEST(MinimumLimits, AHundredStringsOfAHundredCharacters) {
  const auto world =
      load("Shape { geometry DEF G Text { string [" +
           times(100, [](int) { return '"' + std::string(100, 'i') + '"'; }) + "] } }");
  EXPECT_GT(meshOf(*world, "G").indices.size(), 10000u * 3);
}

TEST(MinimumLimits, TwentyFiveOfEachKindInAScript) {
  std::string interface;
  for (const char* access : {"eventIn", "eventOut"})
    interface +=
        times(25, [&](int i) { return fmt::format("{} SFFloat {}{}", access, access, i); });
  interface += times(25, [](int i) { return fmt::format("field SFFloat f{} {}", i, i); });
  const auto world = load("DEF S Script { " + interface + " }");
  // url, directOutput, mustEvaluate and X3D's metadata are there, too.
  EXPECT_EQ(world->scope.names.find("S")->second->type().fields.size(), 79u);
}

TEST(MinimumLimits, FloatsOfTwelveDigitsExponent) {
  const auto world = load("Transform { translation 1e12 -1e-12 1e-12 }");
  EXPECT_EQ(nodeCast<nodes::Transform>(world->scope.roots[0])->translation,
            (Vec3f{1e12f, -1e-12f, 1e-12f}));
}

} // namespace
