// xvrml_globe.cpp: coordinates of X3D's geospatial nodes, and what they count from (ISO/IEC 19775-1
// 25.2).
#include <cmath>

#include <gtest/gtest.h>

#include "base/globe.h"
#include "geometry/mesh.h"
#include "geometry/node_matrix.h"
#include "xvrml/nodes.h"
#include "xvrml/world.h"

namespace {

using namespace xvrml;

double distance(const Vec3d& a, const Vec3d& b) {
  return std::hypot(a.x - b.x, a.y - b.y, a.z - b.z);
}
double dot(const Vec3d& a, const Vec3d& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

Vec3d center(const MFString& system, const Vec3d& coordinates) {
  const auto place = placeOnGlobe(system, coordinates);
  EXPECT_TRUE(place);
  return place ? place->center : Vec3d();
}

// WGS 84: half axes of 6378137 m and 6356752.3142 m.
TEST(Globe, DegreesAreOnTheEllipsoid) {
  EXPECT_LT(distance(center({"GD", "WE"}, {0, 0, 0}), {6378137, 0, 0}), 1e-6);
  EXPECT_LT(distance(center({"GDC"}, {0, 90, 5}), {0, 6378142, 0}), 1e-6);
  EXPECT_LT(distance(center({"GD"}, {90, 0, 0}), {0, 0, 6356752.3142}), 1e-3);
  EXPECT_LT(distance(center({"GD", "longitude_first"}, {90, 0, 0}), {0, 6378137, 0}), 1e-6);
  EXPECT_LT(distance(center({"GD", "CC"}, {0, 0, 0}), {6378206.4, 0, 0}), 1e-6);
}

// A place in Paris, as maps give it in both systems; a second one south of the equator.
TEST(Globe, UtmAndDegreesAgree) {
  EXPECT_LT(distance(center({"UTM", "Z31", "WE"}, {5411932.7, 448251.8, 33}),
                     center({"GD", "WE"}, {48.8582, 2.2945, 33})),
            0.5);
  EXPECT_LT(distance(center({"UTM", "Z31", "easting_first"}, {448251.8, 5411932.7, 0}),
                     center({"UTM", "Z31"}, {5411932.7, 448251.8, 0})),
            1e-6);
  // The middle of zone 56 is 153 degrees east; 10,000 km less the arc of 33.5 degrees.
  const Vec3d south = center({"UTM", "Z56", "S"}, {6293310, 500000, 0});
  EXPECT_NEAR(std::atan2(south.y, south.x) * 180 / M_PI, 153, 1e-9);
  EXPECT_NEAR(placeOnGlobe({"UTM", "Z56", "S"}, {6293310, 500000, 0})->up.z,
              std::sin(-33.5 * M_PI / 180), 1e-3);
}

TEST(Globe, AxesAreEastUpAndSouth) {
  for (const Vec3d& where : {Vec3d{47, 11, 20}, Vec3d{-33, 151, 0}, Vec3d{89.9, -120, 1e5}}) {
    const GlobePlace place = *placeOnGlobe({"GD"}, where);
    for (const auto& [a, b] : {std::pair(place.east, place.up), std::pair(place.up, place.south),
                               std::pair(place.south, place.east)}) {
      EXPECT_NEAR(dot(a, a), 1, 1e-12);
      EXPECT_NEAR(dot(a, b), 0, 1e-12);
    }
    const Vec3d higher = center({"GD"}, {where.x, where.y, where.z + 1}),
                eastern = center({"GD"}, {where.x, where.y + 1e-6, where.z}),
                southern = center({"GD"}, {where.x - 1e-6, where.y, where.z});
    const auto to = [&](const Vec3d& p) {
      return Vec3d{p.x - place.center.x, p.y - place.center.y, p.z - place.center.z};
    };
    EXPECT_NEAR(dot(to(higher), place.up), 1, 1e-8);
    EXPECT_GT(dot(to(eastern), place.east), 0);
    EXPECT_GT(dot(to(southern), place.south), 0.1);
    // Geocentric metres find the same axes.
    const GlobePlace again = *placeOnGlobe({"GC"}, place.center);
    EXPECT_LT(distance(again.up, place.up), 1e-9);
    EXPECT_LT(distance(again.east, place.east), 1e-9);
  }
}

TEST(Globe, OtherSystemsAndNumbersNameNoPlace) {
  EXPECT_FALSE(placeOnGlobe({}, {1, 2, 3}));
  EXPECT_FALSE(placeOnGlobe({"XY"}, {1, 2, 3}));
  EXPECT_FALSE(placeOnGlobe({"UTM"}, {1, 2, 3}));
  EXPECT_FALSE(placeOnGlobe({"UTM", "Z61"}, {1, 2, 3}));
  EXPECT_FALSE(placeOnGlobe({"GD"}, {std::nan(""), 2, 3}));
  EXPECT_FALSE(placeOnGlobe({"GC"}, {1e300, 0, 0}));
  EXPECT_TRUE(placeOnGlobe({"GC"}, {0, 0, 0}));
}

// A world counts from its first place, so the numbers that are drawn are small; or from its
// GeoOrigin.
TEST(Globe, AWorldCountsFromItsFirstPlace) {
  const std::string two = "GeoLocation { geoCoords 47 11 0 } GeoLocation { geoCoords 47.001 11 0 }";
  const auto world = loadWorldFromMemory("#X3D V3.3 utf8\n" + two, "a.x3dv");
  EXPECT_EQ(world->diagnostics.list().size(), 0u);
  const Matrix first = matrixOf(*world->scope.roots[0]), second = matrixOf(*world->scope.roots[1]);
  EXPECT_LT(std::hypot(first.x[3][0], first.x[3][1], first.x[3][2]), 1e-6);
  // A thousandth of a degree of latitude is 111.17 m there.
  EXPECT_NEAR(std::hypot(second.x[3][0], second.x[3][1], second.x[3][2]), 111.17, 0.05);
  const auto turned = loadWorldFromMemory(
      "#X3D V3.3 utf8\nGeoLocation { geoOrigin GeoOrigin { geoCoords 47 11 0 rotateYUp TRUE } "
      "geoCoords 47.001 11 5 }",
      "a.x3dv");
  const Matrix north = matrixOf(*turned->scope.roots[0]);
  EXPECT_NEAR(north.x[3][0], 0, 1e-3);
  EXPECT_NEAR(north.x[3][1], 5, 0.01);
  EXPECT_NEAR(north.x[3][2], -111.17, 0.05); // north is -z
}

// A grid of 3 x 2 points faces away from the globe, with rows to the north (25.3.2).
TEST(Globe, AGridLiesOnTheGlobe) {
  const auto world = loadWorldFromMemory(
      "#X3D V3.3 utf8\nShape { geometry GeoElevationGrid { geoGridOrigin 47 11 100 xDimension 3 "
      "zDimension 2 xSpacing 0.001 zSpacing 0.001 yScale 2 height [ 0 0 0 10 10 10 ] } }",
      "a.x3dv");
  EXPECT_EQ(world->diagnostics.list().size(), 0u);
  const auto& shape = *nodeCast<nodes::Shape>(world->scope.roots[0]);
  const Mesh mesh = buildMesh(*shape.geometry, {});
  ASSERT_EQ(mesh.indices.size(), 12u);
  const GlobePlace corner = *placeOnGlobe({"GD"}, {47, 11, 100});
  double up = 0, north = 0;
  for (const Vec3f& p : mesh.points) { // the corner is the origin of the world
    up = std::max(up, dot({p.x, p.y, p.z}, corner.up));
    north = std::max(north, -dot({p.x, p.y, p.z}, corner.south));
  }
  EXPECT_NEAR(up, 20, 0.01);
  EXPECT_NEAR(north, 111.17, 0.05);
  const auto at = [&](size_t i) { return mesh.points[mesh.indices[i]]; };
  const Vec3f a = at(0), b = at(1), c = at(2);
  const Vec3d u{b.x - a.x, b.y - a.y, b.z - a.z}, v{c.x - a.x, c.y - a.y, c.z - a.z};
  const Vec3d normal{u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
  EXPECT_EQ(dot(normal, corner.up) > 0, mesh.ccw);
}

TEST(Globe, AnUnknownSystemIsSaid) {
  const auto world =
      loadWorldFromMemory("#X3D V3.3 utf8\nGeoLocation { geoSystem \"XY\" }", "a.x3dv");
  ASSERT_EQ(world->diagnostics.warnings(), 1u);
  EXPECT_NE(world->diagnostics.list()[0].message.find("names no place"), std::string::npos);
}

} // namespace
