// xvrml_geometry_figure.cpp: skins of figures: blended joints, displacers, and what hostile ones
// do. The places of vertices follow from the formula of linear blend skinning by hand.
#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "geometry/builders.h"
#include "geometry/figure.h"
#include "xvrml/browser.h"
#include "xvrml/deformed.h"
#include "xvrml/nodes.h"
#include "xvrml/world.h"

namespace {

using namespace xvrml;

std::unique_ptr<World> load(const std::string& text) {
  return loadWorldFromMemory("#X3D V4.0 utf8\n" + text, "test.x3dv", {});
}

template <class T> T& named(const World& world, const char* name) {
  return *nodeCast<T>(world.scope.names.at(name));
}

void expectNear(const Vec3f& got, const Vec3f& expected) {
  EXPECT_NEAR(got.x, expected.x, 1e-6);
  EXPECT_NEAR(got.y, expected.y, 1e-6);
  EXPECT_NEAR(got.z, expected.z, 1e-6);
}

// A bar along x, whose half beyond 1 0 0 is turned by a quarter about z.
const std::string bar = R"(
DEF F HAnimHumanoid {
  skinCoord DEF C Coordinate { point [ 0 0 0, 1.5 0 0, 2 0 0, 3 1 0 ] }
  skinNormal DEF N Normal { vector [ 0 1 0, 0 1 0, 0 1 0, 0 0 1 ] }
  skeleton DEF A HAnimJoint {
    skinCoordIndex [ 0 1 ] skinCoordWeight [ 1 0.5 ]
    children Transform { children DEF B HAnimJoint {
      center 1 0 0 rotation 0 0 1 1.57079633
      skinCoordIndex [ 1 2 3 ] skinCoordWeight [ 0.5 1 ] } } }
  skin Shape { geometry IndexedFaceSet { coord USE C normal USE N coordIndex [ 0 1 3 -1 ] } }
}
)";

TEST(Figure, ABarBendsByTheWeightsOfItsVertices) {
  const auto world = load(bar);
  EXPECT_EQ(world->diagnostics.list().size(), 0u);
  auto& coord = named<nodes::Coordinate>(*world, "C");
  auto& normal = named<nodes::Normal>(*world, "N");
  Diagnostics diagnostics;
  const Node& figure = *world->scope.names.at("F");
  EXPECT_EQ(deform(figure, &diagnostics), (std::vector<Node*>{&coord, &normal}));
  const auto points = drawnPoints(coord), normals = drawnNormals(normal);
  ASSERT_EQ(points.size(), 4u);
  expectNear(points[0], {0, 0, 0});
  expectNear(points[1], {1.25f, 0.25f, 0}); // between 1.5 0 0 and 1 0.5 0
  expectNear(points[2], {1, 1, 0});
  expectNear(points[3], {0, 2, 0}); // its weight is missing: 1
  expectNear(normals[0], {0, 1, 0});
  // The blend of both turns by an eighth.
  expectNear(normals[1], {-std::sqrt(0.5f), std::sqrt(0.5f), 0});
  expectNear(normals[2], {-1, 0, 0});
  expectNear(normals[3], {0, 0, 1});
  expectNear(coord.point[2], {2, 0, 0});             // the field stays as it is at rest
  EXPECT_TRUE(deform(figure, &diagnostics).empty()); // nothing has changed since
  EXPECT_TRUE(diagnostics.list().empty());
}

TEST(Figure, AWeightThatIsMissingToOneStaysAtRest) {
  const auto world =
      load("DEF F HAnimHumanoid { skinCoord DEF C Coordinate { point 1 2 3 } "
           "skeleton "
           "HAnimJoint { translation 4 0 0 skinCoordIndex 0 skinCoordWeight 0.25 } }");
  EXPECT_EQ(deform(*world->scope.names.at("F"), nullptr).size(), 1u);
  expectNear(drawnPoints(named<nodes::Coordinate>(*world, "C"))[0], {2, 2, 3});
}

TEST(Figure, AtRestTheFieldItselfIsDrawn) {
  const auto world = load(bar);
  auto& coord = named<nodes::Coordinate>(*world, "C");
  const Node& figure = *world->scope.names.at("F");
  deform(figure, nullptr);
  named<nodes::HAnimJoint>(*world, "B").rotation.angle = 0;
  EXPECT_EQ(deform(figure, nullptr).size(), 2u);
  EXPECT_EQ(drawnPoints(coord).data(), coord.point.data());
}

TEST(Figure, SkinsMayBeNurbs) {
  const auto world = load(
      "DEF F HAnimHumanoid { skinCoord DEF C Coordinate { point [ 0 0 0, 1 0 0, 0 1 0, 1 1 0 ] "
      "} skeleton HAnimJoint { skinCoordIndex [ 0 1 2 3 ] translation 0 0 7 } skin DEF S Shape "
      "{ geometry NurbsPatchSurface { uOrder 2 vOrder 2 uDimension 2 vDimension 2 "
      "controlPoint USE C } } }");
  deform(*world->scope.names.at("F"), nullptr);
  const Mesh mesh = buildMesh(*named<nodes::Shape>(*world, "S").geometry, {});
  ASSERT_FALSE(mesh.points.empty());
  for (const Vec3f& point : mesh.points) EXPECT_EQ(point.z, 7);
}

// Geospatial places need more digits than floats have.
TEST(Figure, CoordinatesInDoublePrecisionKeepTheirDigits) {
  const auto world = load(
      "DEF F HAnimHumanoid { skinCoord DEF C CoordinateDouble { point [ 4000000.001 0 0, 1 0 0 ] "
      "} skeleton HAnimJoint { skinCoordIndex [ 0 1 ] translation 0 0.125 0 } }\n"
      "DEF S HAnimSegment { coord DEF D CoordinateDouble { point 4000000.001 0 0 } displacers "
      "HAnimDisplacer { coordIndex 0 displacements 0.125 0 0 weight 1 } }\n"
      "Shape { geometry DEF P PointSet { coord USE C } }");
  for (const char* name : {"F", "S"})
    EXPECT_EQ(deform(*world->scope.names.at(name), nullptr).size(), 1u);
  const auto skin = drawnPoints(named<nodes::CoordinateDouble>(*world, "C"));
  EXPECT_EQ(skin[0], (Vec3d{4000000.001, 0.125, 0}));
  EXPECT_EQ(drawnPoints(named<nodes::CoordinateDouble>(*world, "D"))[0],
            (Vec3d{4000000.126, 0, 0}));
  EXPECT_EQ(coordinates(named<nodes::PointSet>(*world, "P").coord).points[1],
            (Vec3f{1, 0.125f, 0}));
}

// A displacer moves vertices before the joints turn them; it belongs to a joint or to a segment.
TEST(Figure, DisplacersMoveVertices) {
  const auto world =
      load("DEF F HAnimHumanoid { skinCoord DEF C Coordinate { point [ 1 0 0, 1 0 0 ] } skeleton "
           "HAnimJoint { rotation 0 0 1 1.57079633 skinCoordIndex 0 displacers HAnimDisplacer { "
           "coordIndex [ 0 1 ] displacements [ 1 0 0, 0 2 0 ] weight 0.5 } } }\n"
           "DEF S HAnimSegment { coord DEF D Coordinate { point [ 0 0 0, 1 1 1 ] } displacers [ "
           "HAnimDisplacer { coordIndex 1 displacements 0 0 4 weight 0.25 } "
           "HAnimDisplacer { coordIndex 1 displacements 8 0 0 weight 0.5 } ] }");
  EXPECT_EQ(world->diagnostics.list().size(), 0u);
  deform(*world->scope.names.at("F"), nullptr);
  deform(*world->scope.names.at("S"), nullptr);
  const auto skin = drawnPoints(named<nodes::Coordinate>(*world, "C"));
  expectNear(skin[0], {0, 1.5f, 0});
  expectNear(skin[1], {1, 1, 0});
  expectNear(drawnPoints(named<nodes::Coordinate>(*world, "D"))[1], {5, 1, 2});
}

TEST(Figure, HostileIndicesAndWeightsMoveNothingAndAreReportedOnce) {
  const auto world =
      load("DEF F HAnimHumanoid { skinCoord DEF C Coordinate { point [ 1 0 0, 2 0 0 ] } "
           "skinNormal Normal { vector [ 0 0 1, 0 0 1, 0 0 1 ] } skeleton [ DEF J HAnimJoint { "
           "translation 0 1 0 "
           "skinCoordIndex [ 0 -1 5 2147483647 -2147483648 0 ] displacers HAnimDisplacer { "
           "coordIndex [ 7 8 ] displacements 1 1 1 weight 1 } children HAnimJoint { scale 1e38 "
           "1e38 1e38 "
           "skinCoordIndex 1 } } USE J ] }");
  EXPECT_EQ(world->diagnostics.list().size(), 0u);
  named<nodes::HAnimJoint>(*world, "J").skinCoordWeight = {1, 1, 1, 1, 1, std::nanf("")};
  Diagnostics diagnostics;
  deform(*world->scope.names.at("F"), &diagnostics);
  const auto points = drawnPoints(named<nodes::Coordinate>(*world, "C"));
  expectNear(points[0], {1, 1, 0});
  ASSERT_EQ(diagnostics.list().size(), 2u);
  EXPECT_NE(diagnostics.list()[0].text().find("5 indices of its joints or displacers are no vertex "
                                              "of the 2 that it has"),
            std::string::npos)
      << diagnostics.list()[0].text();
  EXPECT_NE(diagnostics.list()[1].text().find("skinNormal has 3 normals and skinCoord 2 vertices"),
            std::string::npos);
}

// Vertices of the binding pose would be bent twice: skinCoord has the same skin at rest.
TEST(Figure, ABindingPoseIsSaidToHaveNoEffect) {
  for (const char* binding :
       {"skinBindingCoords Coordinate { point 9 9 9 }",
        "skinBindingNormals Normal { vector 1 0 0 }", "jointBindingPositions 0 5 0",
        "jointBindingRotations 1 0 0 1", "jointBindingScales 2 2 2"}) {
    const auto world = load(std::string("DEF F HAnimHumanoid { skinCoord DEF C Coordinate { point "
                                        "2 0 0 } skeleton HAnimJoint { translation 0 1 0 "
                                        "skinCoordIndex 0 } ") +
                            binding + " }");
    Diagnostics diagnostics;
    deform(*world->scope.names.at("F"), &diagnostics);
    expectNear(drawnPoints(named<nodes::Coordinate>(*world, "C"))[0], {2, 1, 0});
    ASSERT_EQ(diagnostics.list().size(), 1u) << binding;
    EXPECT_NE(diagnostics.list()[0].text().find("its binding pose"), std::string::npos);
  }
  const auto atRest = load("DEF F HAnimHumanoid { skinCoord DEF C Coordinate { point 2 0 0 } "
                           "skinBindingCoords USE C jointBindingPositions 0 0 0 "
                           "jointBindingRotations 0 0 1 0 jointBindingScales 1 1 1 }");
  Diagnostics diagnostics;
  deform(*atRest->scope.names.at("F"), &diagnostics);
  EXPECT_EQ(diagnostics.list().size(), 0u);
}

// A vertex that no float can hold stays at rest.
TEST(Figure, NumbersStayFinite) {
  const auto world = load("DEF F HAnimHumanoid { skinCoord DEF C Coordinate { point 2 0 0 } "
                          "skeleton "
                          "HAnimJoint { scale 3e38 1 1 skinCoordIndex 0 } }");
  deform(*world->scope.names.at("F"), nullptr);
  expectNear(drawnPoints(named<nodes::Coordinate>(*world, "C"))[0], {2, 0, 0});
}

// Nodes of a prototype's body that nothing changes are shared by its instances, but no skins.
TEST(Figure, InstancesOfAPrototypeHaveSkinsOfTheirOwn) {
  auto world =
      load("PROTO P [ inputOutput SFVec3f t 0 0 0 ] { HAnimHumanoid { skinCoord Coordinate "
           "{ point 0 0 0 } skeleton HAnimJoint { translation IS t skinCoordIndex 0 } } }\n"
           "DEF A P { t 1 0 0 } DEF B P { t 2 0 0 }");
  Browser browser(std::move(world));
  for (const auto& [name, place] : {std::pair("A", 1.0f), std::pair("B", 2.0f)}) {
    auto* figure = nodeCast<nodes::HAnimHumanoid>(renderedNode(browser.node(name).get()));
    ASSERT_TRUE(figure);
    expectNear(drawnPoints(*nodeCast<nodes::Coordinate>(figure->skinCoord))[0], {place, 0, 0});
  }
}

// In a running world the skin follows every event, also between ticks, and is reported as changed.
TEST(Figure, ASkinFollowsItsJointsInARunningWorld) {
  auto loaded = load(bar);
  auto& coord = named<nodes::Coordinate>(*loaded, "C");
  Browser browser(std::move(loaded));
  browser.tick(0);
  expectNear(drawnPoints(coord)[2], {1, 1, 0});
  browser.takeChanges();
  ASSERT_TRUE(browser.set(*browser.node("B"), "rotation", Rotation{0, 0, 1, -1.57079633f}));
  expectNear(drawnPoints(coord)[2], {1, -1, 0});
  bool reported = false;
  for (const FieldChange& change : browser.takeChanges())
    reported = reported || (change.node.get() == &coord && change.field->name == "point");
  EXPECT_TRUE(reported);
  ASSERT_TRUE(browser.set(coord, "point", MFVec3f{{0, 0, 0}, {1, 0, 0}, {4, 0, 0}, {3, 1, 0}}));
  expectNear(drawnPoints(coord)[2], {1, -3, 0}); // another rest
}

bool isReported(Browser& browser, const Node& node) {
  const FieldChanges changes = browser.takeChanges();
  return std::any_of(changes.begin(), changes.end(),
                     [&node](const FieldChange& change) { return change.node.get() == &node; });
}

TEST(Figure, WhatIsTakenOutGoesBackToRest) {
  auto loaded = load(bar + "DEF G HAnimHumanoid { }");
  auto& coord = named<nodes::Coordinate>(*loaded, "C");
  auto& normal = named<nodes::Normal>(*loaded, "N");
  Browser browser(std::move(loaded));
  browser.takeChanges();
  ASSERT_TRUE(browser.set(*browser.node("F"), "skinCoord", NodeRef())); // the first event at all
  expectNear(drawnPoints(coord)[2], {2, 0, 0});
  EXPECT_EQ(drawnNormals(normal).data(), normal.vector.data()) << "without vertices";
  EXPECT_TRUE(isReported(browser, coord));
  ASSERT_TRUE(browser.set(coord, "point", MFVec3f{{5, 0, 0}}));
  EXPECT_EQ(drawnPoints(coord).size(), 1u) << "its own points are drawn again";
  ASSERT_TRUE(browser.set(coord, "point", MFVec3f{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 1, 0}}));
  ASSERT_TRUE(browser.set(*browser.node("F"), "skinCoord", NodeRef(&coord)));
  expectNear(drawnPoints(coord)[2], {1, 1, 0});
  // Another figure takes it over within one event, and has no joints.
  ASSERT_TRUE(browser.set(*browser.node("G"), "skinCoord", NodeRef(&coord)));
  ASSERT_TRUE(browser.set(*browser.node("F"), "skinCoord", NodeRef()));
  expectNear(drawnPoints(coord)[2], {2, 0, 0});
}

TEST(Figure, ASegmentWithoutDisplacersIsAtRest) {
  auto loaded = load("DEF S HAnimSegment { coord DEF C Coordinate { point 1 0 0 } displacers "
                     "HAnimDisplacer { coordIndex 0 displacements 0 4 0 weight 0.5 } }");
  auto& coord = named<nodes::Coordinate>(*loaded, "C");
  Browser browser(std::move(loaded));
  expectNear(drawnPoints(coord)[0], {1, 2, 0});
  ASSERT_TRUE(browser.set(*browser.node("S"), "displacers", MFNode()));
  expectNear(drawnPoints(coord)[0], {1, 0, 0});
}

TEST(Figure, AFigureThatGoesLeavesItsSkinAtRest) {
  auto loaded =
      load(bar + "Shape { geometry IndexedFaceSet { coord USE C coordIndex [ 0 1 2 ] } }");
  auto& coord = named<nodes::Coordinate>(*loaded, "C");
  Browser browser(std::move(loaded));
  browser.tick(0);
  expectNear(drawnPoints(coord)[2], {1, 1, 0});
  browser.world().scope.names.erase("F");
  browser.removeRoot(*browser.world().scope.roots[0]);
  browser.tick(1);
  browser.takeChanges();
  expectNear(drawnPoints(coord)[2], {2, 0, 0});
}

} // namespace
