// particles.cpp: where particles are: their births, ways and forms (ISO/IEC 19775-1 40),
// against closed forms by hand, and what hostile systems do.
#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "behaviour/particles/drawn.h"
#include "behaviour/particles/life.h"
#include "conformance/events/support.h"
#include "geometry/mesh.h"
#include "xvrml/build.h"
#include "xvrml/set_field.h"

namespace xvrml {
namespace {

using Messages = std::vector<std::string>;

constexpr double never = std::numeric_limits<double>::infinity();

size_t countAt(double now, std::vector<Emission> emissions, bool explodes = false) {
  ParticleClock clock;
  clock.now = now;
  clock.emissions = std::move(emissions);
  return livingParticles({10, 5, 0, explodes, 1}, clock).size();
}

TEST(ParticleLife, TenPlacesFillWithinALife) {
  const std::vector<Emission> always{{0, never, 1}};
  EXPECT_EQ(countAt(-1, always), 0u);
  EXPECT_EQ(countAt(0, always), 1u);
  EXPECT_EQ(countAt(2.1, always), 5u) << "one in half a second";
  EXPECT_EQ(countAt(4.6, always), 10u);
  EXPECT_EQ(countAt(1e9, always), 10u);
  EXPECT_EQ(countAt(0, {{}}), 10u) << "since before the beginning";
}

TEST(ParticleLife, ThoseThatAreThereLiveOnWhenNoMoreAreBorn) {
  const std::vector<Emission> once{{0, 3.1, 1}};
  EXPECT_EQ(countAt(3.2, once), 7u);
  EXPECT_EQ(countAt(4.9, once), 7u);
  EXPECT_EQ(countAt(5.1, once), 6u) << "the first one has ended, and has no successor";
  EXPECT_EQ(countAt(8.1, once), 0u);
  const std::vector<Emission> twice{{0, 3.1, 1}, {4, never, 2}};
  EXPECT_EQ(countAt(5.1, twice), 7u) << "a place is free when its particle ends";
  EXPECT_EQ(countAt(9, twice), 10u);
}

TEST(ParticleLife, AnExplosionHappensOnce) {
  EXPECT_EQ(countAt(0, {{}}, true), 10u);
  EXPECT_EQ(countAt(4.9, {{}}, true), 10u);
  EXPECT_EQ(countAt(5.1, {{}}, true), 0u);
  EXPECT_EQ(countAt(7, {{}, {6, never, 1}}, true), 10u);
}

TEST(ParticleLife, AnExplosionHasOnlyThePlacesThatAreFree) {
  const std::vector<Emission> early{{0, 1, 1}, {2, 2.5, 2}};
  EXPECT_EQ(countAt(4.9, early, true), 10u);
  EXPECT_EQ(countAt(5.1, early, true), 0u) << "it does not burst later";
  EXPECT_EQ(countAt(6, {{0, 1, 1}, {2, 2.5, 2}, {5.5, never, 3}}, true), 10u);
}

TEST(ParticleLife, BirthsThatGoOnBeginWhereTheyHaveEnded) {
  EXPECT_DOUBLE_EQ(phaseAfter({1, 2, 1, 0.5}, 4), 0.75);
  EXPECT_DOUBLE_EQ(phaseAfter({1, 6, 1, 0.5}, 4), 0.75);
  EXPECT_DOUBLE_EQ(phaseAfter({-never, 1, 0}, 4), 0.25);
  for (const double seconds : {0.0, -1.0, never, 1e-320, std::nan("")}) {
    const double phase = phaseAfter({1, 2, 1, 0.5}, seconds);
    EXPECT_TRUE(phase >= 0 && phase < 1) << seconds;
  }
}

TEST(ParticleLife, LivesDifferByTheVariation) {
  ParticleClock clock;
  double shortest = never, longest = 0;
  for (const LivingParticle& one : livingParticles({1000, 5, 0.2, false, 7}, clock)) {
    EXPECT_GE(one.age, 0);
    EXPECT_LT(one.age, one.life);
    shortest = std::min(shortest, one.life);
    longest = std::max(longest, one.life);
  }
  EXPECT_GE(shortest, 4);
  EXPECT_LE(longest, 6);
  EXPECT_NEAR(shortest, 4, 0.02);
  EXPECT_NEAR(longest, 6, 0.02);
}

// A running world with one ParticleSystem.
struct Particles : Running {
  explicit Particles(const std::string& nodes) : Running("#X3D V4.0 utf8\n" + nodes) {
    browser.tick(0);
  }
  GeometryArrays at(double time) {
    browser.tick(time);
    return now();
  }
  GeometryArrays now() {
    for (const PlacedShape& shape : placedShapes(browser.world()))
      return geometryArrays(*shape.geometry, 0);
    return {};
  }
  Messages messages() {
    Messages all;
    for (const Diagnostic& one : browser.world().diagnostics.list()) all.push_back(one.message);
    return all;
  }
};

std::string system(const std::string& fields) {
  return "DEF P ParticleSystem { geometryType \"POINT\" lifetimeVariation 0 " + fields + " }";
}
// One particle, whose lives begin at 0, 4, 8 ...
std::string one(const std::string& fields) {
  return system("maxParticles 1 particleLifetime 4 " + fields);
}

void expectNear(const Vec3f& got, const Vec3f& expected, float within = 1e-5f) {
  EXPECT_NEAR(got.x, expected.x, within);
  EXPECT_NEAR(got.y, expected.y, within);
  EXPECT_NEAR(got.z, expected.z, within);
}

TEST(ParticleWay, AForceMakesAParabola) {
  Particles r(one("emitter PointEmitter { position 0 1 0 direction 3 0 0 speed 2 variation 0 mass "
                  "2 } physics ForcePhysicsModel { }"));
  ASSERT_EQ(r.now().points.size(), 1u);
  expectNear(r.at(0).points[0], {0, 1, 0});
  expectNear(r.at(1).points[0], {2, 1 - 4.9f / 2, 0});
  expectNear(r.at(3).points[0], {6, 1 - 9 * 4.9f / 2, 0});
  expectNear(r.at(5).points[0], {2, 1 - 4.9f / 2, 0}, 1e-4f); // its second life
}

TEST(ParticleWay, ForcesDoNotMoveWhatHasNoMass) {
  Particles r(one("emitter PointEmitter { speed 1 variation 0 } physics [ ForcePhysicsModel { }, "
                  "WindPhysicsModel { speed 9 } ]"));
  expectNear(r.at(2).points[0], {0, 2, 0});
}

TEST(ParticleWay, WindPressesOnTheSurfaceOfAParticle) {
  Particles r(one("emitter PointEmitter { variation 0 mass 0.5 surfaceArea 0.1 } physics "
                  "WindPhysicsModel { direction 0 0 1 speed 3 gustiness 0 }"));
  expectNear(r.at(2).points[0], {0, 0, float(0.64615 * 9 * 0.1 / 0.5 * 2)});
  r.set("P", "enabled", false);
  EXPECT_EQ(r.at(3).points.size(), 0u);
}

TEST(ParticleWay, GustsAndTurbulenceDifferBetweenParticles) {
  Particles r(system("maxParticles 300 particleLifetime 1 emitter ExplosionEmitter { variation 0 "
                     "mass 1 surfaceArea 1 } physics WindPhysicsModel { direction 1 0 0 speed 2 "
                     "gustiness 0.5 turbulence 0.25 }"));
  const GeometryArrays arrays = r.at(0.5);
  ASSERT_EQ(arrays.points.size(), 300u);
  const double least = 0.64615 / 8, most = 0.64615 * 9 / 8;
  for (const Vec3f& p : arrays.points) {
    const double length = std::hypot(p.x, p.y, p.z);
    EXPECT_GE(length, least - 1e-6);
    EXPECT_LE(length, most + 1e-6);
    EXPECT_GE(p.x / length, std::cos(std::numbers::pi / 4) - 1e-5);
  }
}

const std::string floorOfTwoTriangles =
    "physics [ ForcePhysicsModel { force 0 -2 0 }, BoundedPhysicsModel { geometry IndexedFaceSet { "
    "coordIndex [ 0 1 2 -1 0 2 3 -1 ] coord Coordinate { point [ -9 0 9, 9 0 9, 9 0 -9, -9 0 -9 ] "
    "} } } ]";

TEST(ParticleWay, ABallBouncesOffTheFloorWithoutALoss) {
  Particles r(
      one("emitter PointEmitter { position 0 1 0 mass 1 variation 0 } " + floorOfTwoTriangles));
  expectNear(r.at(0.5).points[0], {0, 0.75f, 0});
  expectNear(r.at(1.5).points[0], {0, 0.75f, 0});
  expectNear(r.at(2).points[0], {0, 1, 0});
  expectNear(r.at(3.5).points[0], {0, 0.75f, 0});
}

TEST(ParticleWay, NothingLeavesAClosedBox) {
  Particles r(
      system("maxParticles 500 particleLifetime 9 emitter ExplosionEmitter { position .1 .2 "
             ".3 speed 3 mass 1 } physics [ ForcePhysicsModel { force 1 -3 .5 }, "
             "BoundedPhysicsModel { geometry Box { } } ]"));
  for (const double time : {0.3, 2.0, 8.0})
    for (const Vec3f& p : r.at(time).points)
      EXPECT_LE(std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}), 1.00001f) << time;
}

TEST(ParticleStart, AConeKeepsItsAngle) {
  Particles r(system("maxParticles 200 particleLifetime 1 emitter ConeEmitter { position 1 0 0 "
                     "direction 0 0 -2 angle 0.3 speed 1 variation 0 }"));
  double widest = 0;
  for (const Vec3f& p : r.now().points) {
    const double length = std::hypot(p.x - 1, p.y, p.z);
    if (length > 1e-3) widest = std::max(widest, std::acos(std::min(1.0, -p.z / length)));
  }
  EXPECT_LE(widest, 0.3001);
  EXPECT_GE(widest, 0.28);
}

TEST(ParticleStart, LinesSurfacesAndVolumes) {
  const std::string cube =
      "coordIndex [ 0 1 3 2 -1 4 6 7 5 -1 0 4 5 1 -1 2 3 7 6 -1 0 2 6 4 -1 1 5 7 3 -1 ] coord "
      "Coordinate { point [ 1 1 1, 3 1 1, 1 3 1, 3 3 1, 1 1 3, 3 1 3, 1 3 3, 3 3 3 ] }";
  const auto born = [](const std::string& emitter) {
    return Particles(system("maxParticles 400 emitter " + emitter)).now().points;
  };
  for (const Vec3f& p :
       born("PolylineEmitter { coordIndex [ 0 1 2 -1 9 0 ] coord Coordinate { point "
            "[ 0 0 0, 4 0 0, 4 1 0 ] } }"))
    EXPECT_TRUE(p.y == 0 || std::abs(p.x - 4) < 1e-6) << p.x << " " << p.y;
  const auto surface = born("SurfaceEmitter { surface Sphere { radius 2 } }");
  ASSERT_EQ(surface.size(), 400u);
  for (const Vec3f& p : surface) EXPECT_NEAR(std::hypot(p.x, p.y, p.z), 2, 0.02);
  double sum = 0;
  for (const Vec3f& p : born("VolumeEmitter { " + cube + " }")) {
    EXPECT_GT(std::min({p.x, p.y, p.z}), 1);
    EXPECT_LT(std::max({p.x, p.y, p.z}), 3);
    sum += p.x + p.y + p.z;
  }
  EXPECT_NEAR(sum / 400, 6, 0.2);
  for (const Vec3f& p : born("VolumeEmitter { internal FALSE " + cube + " }"))
    EXPECT_NEAR(std::max({std::abs(p.x - 2), std::abs(p.y - 2), std::abs(p.z - 2)}), 1, 1e-5);
}

TEST(ParticleStart, ParticlesLeaveBothSidesOfASphereThatIsNotSolid) {
  const auto outwards = [](const std::string& solid) {
    Particles r(system("maxParticles 200 emitter SurfaceEmitter { speed 0.1 variation 0 surface "
                       "Sphere { solid " +
                       solid + " } }"));
    size_t count = 0;
    for (const Vec3f& p : r.now().points) count += std::hypot(p.x, p.y, p.z) > 0.99;
    return count;
  };
  EXPECT_EQ(outwards("TRUE"), 200u);
  EXPECT_NEAR(double(outwards("FALSE")), 100, 30);
}

TEST(ParticleStart, ParticlesOfASurfaceLeaveItAlongItsNormals) {
  const auto shares = [](const std::string& solid) {
    Particles r(system("maxParticles 200 emitter SurfaceEmitter { speed 1 variation 0 surface "
                       "Rectangle2D { size 2 2 solid " +
                       solid + " } }"));
    size_t front = 0;
    for (const Vec3f& p : r.now().points) front += p.z >= 0;
    return front;
  };
  EXPECT_EQ(shares("TRUE"), 200u);
  EXPECT_NEAR(double(shares("FALSE")), 100, 30);
}

TEST(ParticleForm, AQuadLiesInThePlaneOfTheSystem) {
  Particles r("DEF P ParticleSystem { maxParticles 3 particleSize 2 4 emitter PointEmitter { "
              "position 5 0 0 } }");
  const GeometryArrays arrays = r.now();
  ASSERT_EQ(arrays.kind, GeometryArrays::Kind::triangles);
  ASSERT_EQ(arrays.points.size(), 12u);
  ASSERT_EQ(arrays.indices.size(), 18u);
  expectNear(arrays.points[0], {4, -2, 0});
  expectNear(arrays.points[2], {6, 2, 0});
  EXPECT_EQ(arrays.texCoords[2], (Vec2f{1, 1}));
  EXPECT_FALSE(arrays.solid);
}

TEST(ParticleForm, ASpriteFacesTheViewer) {
  Particles r(
      "Viewpoint { position 9 0 0 orientation 0 1 0 1.5707963 }\nTransform { rotation 0 0 1 "
      "1.5707963 children ParticleSystem { geometryType \"SPRITE\" maxParticles 1 particleSize "
      "2 4 emitter PointEmitter { } } }");
  const GeometryArrays arrays = r.now();
  ASSERT_EQ(arrays.points.size(), 4u);
  expectNear(arrays.normals[0], {0, -1, 0}); // 1 0 0 in the world
  for (const Vec3f& p : arrays.points) EXPECT_NEAR(p.y, 0, 1e-5);
  EXPECT_NEAR(std::abs(arrays.points[0].x), 2, 1e-5) << "the height is up for the viewer";
}

TEST(ParticleForm, ALineLiesAlongItsWay) {
  Particles r("ParticleSystem { geometryType \"LINE\" maxParticles 1 lifetimeVariation 0 "
              "particleSize 1 3 emitter PointEmitter { direction 1 0 0 speed 2 variation 0 } }");
  const GeometryArrays arrays = r.at(1);
  ASSERT_EQ(arrays.kind, GeometryArrays::Kind::lines);
  ASSERT_EQ(arrays.points.size(), 2u);
  expectNear(arrays.points[0], {0.5f, 0, 0});
  expectNear(arrays.points[1], {3.5f, 0, 0});
}

TEST(ParticleForm, GeometryIsDrawnForEachParticle) {
  Particles r("DEF P ParticleSystem { geometryType \"GEOMETRY\" maxParticles 5 geometry Box { } "
              "emitter PointEmitter { } }");
  const size_t corners = r.now().indices.size();
  EXPECT_EQ(corners, 5u * 36);
  r.set("P", "geometry", NodeRef());
  EXPECT_EQ(r.at(1).points.size(), 0u);
}

// Some arrays of the mesh that a system draws.
struct DrawnArrays {
  std::vector<Vec3f> normals;
  std::vector<Vec4f> texPlaces;
  std::vector<float> fogCoords;
};

// Returns those of a system with two particles of this GEOMETRY.
DrawnArrays drawn(const std::string& geometry) {
  Particles r("ParticleSystem { geometryType \"GEOMETRY\" maxParticles 2 emitter PointEmitter { } "
              "geometry " +
              geometry + " }");
  const std::vector<PlacedShape> shapes = placedShapes(r.browser.world());
  if (shapes.empty()) return {};
  const Mesh mesh = buildMesh(*shapes[0].geometry, {});
  return {{mesh.normals.begin(), mesh.normals.end()},
          {mesh.texPlaces.begin(), mesh.texPlaces.end()},
          {mesh.fogCoords.begin(), mesh.fogCoords.end()}};
}

const std::string twoTriangles =
    "coordIndex [ 0 1 2 -1 0 3 1 -1 ] coord Coordinate { point [ 0 0 0, 1 0 0, 0 1 0, 0 0 1 ] } ";

TEST(ParticleForm, AFlatGeometryStaysFlat) {
  const std::string flat = "IndexedFaceSet { " + twoTriangles;
  EXPECT_TRUE(drawn(flat + "}").normals.empty());
  EXPECT_FALSE(drawn(flat + "creaseAngle 3 }").normals.empty());
}

TEST(ParticleForm, AGeometryKeepsFogCoordinatesAndTextureCoordinatesInSpace) {
  const std::string fog = "fogCoord FogCoordinate { depth 0.5 } ";
  const DrawnArrays faces =
      drawn("IndexedFaceSet { " + twoTriangles + fog +
            "texCoord TextureCoordinate3D { point [ 1 2 3, 1 2 3, 1 2 3, 1 2 3 ] } "
            "}");
  ASSERT_FALSE(faces.texPlaces.empty());
  for (const Vec4f& place : faces.texPlaces) EXPECT_EQ(place, (Vec4f{1, 2, 3, 1}));
  ASSERT_FALSE(faces.fogCoords.empty());
  for (const float depth : faces.fogCoords) EXPECT_EQ(depth, 0.5f);
  const std::string coord = "coord Coordinate { point [ 0 0 0, 1 0 0 ] } ";
  EXPECT_EQ(drawn("PointSet { " + coord + fog + "}").fogCoords, std::vector<float>(4, 0.5f));
  EXPECT_EQ(drawn("IndexedLineSet { coordIndex [ 0 1 -1 ] " + coord + fog + "}").fogCoords,
            std::vector<float>(4, 0.5f));
}

TEST(ParticleRamp, ColoursGoWithTheAge) {
  const std::string ramp = "colorRamp ColorRGBA { color [ 1 0 0 1, 1 0 0 0 ] } ";
  const auto alpha = [](const std::string& keys, const std::string& colors, double time) {
    return Particles(one(keys + colors + "emitter PointEmitter { }")).at(time).alphas.at(0);
  };
  EXPECT_NEAR(alpha("colorKey [ 0 1 ] ", ramp, 1), 0.75f, 1e-5) << "parts of a life of 4 s";
  EXPECT_NEAR(alpha("colorKey [ 0 2 ] ", ramp, 1), 0.5f, 1e-5) << "seconds";
  EXPECT_NEAR(alpha("colorKey [ 0 2 ] ", ramp, 3), 0, 1e-5);
  Particles plain(one("colorKey [ 0 2 ] colorRamp Color { color [ 1 0 0, 0 1 0 ] } emitter "
                      "PointEmitter { }"));
  const GeometryArrays arrays = plain.at(1);
  EXPECT_TRUE(arrays.alphas.empty());
  EXPECT_NEAR(arrays.colors.at(0).r, 1, 1e-5) << "in HSV";
  EXPECT_NEAR(arrays.colors.at(0).g, 1, 1e-5);
}

TEST(ParticleRamp, TextureCoordinatesStepWithoutAPassage) {
  Particles r(
      "ParticleSystem { maxParticles 1 lifetimeVariation 0 texCoordKey [ 0 2 ] texCoordRamp "
      "TextureCoordinate { point [ 0 0, .5 0, .5 1, 0 1, .5 0, 1 0, 1 1, .5 1 ] } emitter "
      "PointEmitter { } }");
  EXPECT_EQ(r.at(1.9).texCoords.at(0), (Vec2f{0, 0}));
  EXPECT_EQ(r.at(2.1).texCoords.at(0), (Vec2f{0.5f, 0}));
}

TEST(ParticleTime, AMomentDoesNotDependOnThoseBeforeIt) {
  const std::string text = "DEF P ParticleSystem { geometryType \"POINT\" maxParticles 300 "
                           "lifetimeVariation 0.5 colorKey "
                           "[ 0 1 ] colorRamp ColorRGBA { color [ 1 0 0 1, 0 0 1 0 ] } emitter "
                           "PointEmitter { direction 0 "
                           "0 0 speed 1 mass 1 surfaceArea 1 } " +
                           floorOfTwoTriangles + " }";
  Particles few(text), many(text);
  const GeometryArrays late = few.at(7.7);
  for (int i = 1; i < 77; ++i) many.browser.tick(i * 0.0991);
  const GeometryArrays same = many.at(7.7);
  ASSERT_EQ(late.points.size(), 300u);
  EXPECT_EQ(late.points, same.points);
  EXPECT_EQ(late.colors, same.colors);
  EXPECT_EQ(late.alphas, same.alphas);
  EXPECT_NE(few.at(7.8).points, same.points);
}

TEST(ParticleEvents, EnabledBeginsAnewAndCreateParticlesEndsBirths) {
  Particles r(system("maxParticles 10 particleLifetime 5 emitter DEF E PointEmitter { }") +
              "\nDEF T BooleanToggle { }\nROUTE T.toggle TO P.createParticles");
  EXPECT_EQ(r.get("P", "isActive"), "TRUE");
  r.log("P", "isActive");
  EXPECT_EQ(r.now().points.size(), 10u) << "it has been running before the world began";
  r.set("P", "enabled", false);
  EXPECT_EQ(r.at(1).points.size(), 0u);
  r.set("P", "enabled", true);
  EXPECT_EQ(r.at(2.1).points.size(), 3u);
  EXPECT_EQ(r.take(), (Log{"0 P.isActive FALSE", "1 P.isActive TRUE"}));
  EXPECT_EQ(r.at(4.1).points.size(), 7u);
  r.set("T", "toggle", false);
  EXPECT_EQ(r.at(4.6).points.size(), 7u);
  EXPECT_EQ(r.at(5.9).points.size(), 7u);
  EXPECT_EQ(r.at(6.6).points.size(), 5u);
  EXPECT_EQ(r.take(), Log{}) << "it is still active";
  r.set("T", "toggle", true);
  r.at(8);
  r.set("E", "on", false);
  r.at(9);
  EXPECT_EQ(r.at(20).points.size(), 0u);
}

TEST(ParticleEvents, WhatIsBelowASystemMovesItsParticlesAtOnce) {
  Particles r(
      one("emitter DEF E PointEmitter { speed 1 variation 0 mass 1 } physics DEF F "
          "ForcePhysicsModel { force 0 0 0 } colorKey 0 colorRamp DEF C Color { color 1 0 0 }"));
  expectNear(r.at(1).points[0], {0, 1, 0});
  r.set("E", "direction", Vec3f{1, 0, 0});
  expectNear(r.now().points[0], {1, 0, 0});
  r.set("F", "force", Vec3f{0, 0, 2});
  expectNear(r.now().points[0], {1, 0, 1});
  r.set("C", "color", MFColor{{0, 1, 0}});
  EXPECT_EQ(r.now().colors[0], (Color{0, 1, 0}));
  r.browser.takeChanges();
  r.browser.tick(1);
  EXPECT_TRUE(r.browser.takeChanges().empty()) << "time stands, and nothing has changed";
}

TEST(ParticleEvents, AWorldThatDoesNotRunShowsTheBeginning) {
  const auto world = loadWorldFromMemory(
      "#X3D V4.0 utf8\n" + system("maxParticles 3 particleLifetime 3 emitter DEF E PointEmitter { "
                                  "position 1 0 0 speed 1 variation 0 }"),
      "test.x3dv");
  const auto points = [&] { return geometryArrays(*placedShapes(*world)[0].geometry, 0).points; };
  ASSERT_EQ(points().size(), 3u);
  expectNear(points()[1], {1, 2, 0});
  ASSERT_TRUE(setField(*world, *world->scope.names.at("E"), "position", Vec3f{5, 0, 0}));
  expectNear(points()[1], {5, 2, 0});
}

TEST(ParticleEvents, AWorldThatDoesNotRunFollowsAllThatIsBelowASystem) {
  const auto world = loadWorldFromMemory(
      "#X3D V4.0 utf8\n" +
          system("geometryType \"GEOMETRY\" maxParticles 1 particleLifetime 3 emitter "
                 "PointEmitter { speed 0 variation 0 } colorKey 0 colorRamp DEF R Color { color 1 "
                 "0 0 } geometry TriangleSet { coord DEF C Coordinate { point [ 0 0 0, 1 0 0, 0 1 "
                 "0 ] } }"),
      "test.x3dv");
  const auto arrays = [&] { return geometryArrays(*placedShapes(*world)[0].geometry, 0); };
  const auto set = [&](const char* name, const char* field, Value value) {
    return setField(*world, *world->scope.names.at(name), field, std::move(value));
  };
  EXPECT_EQ(arrays().colors[0], (Color{1, 0, 0}));
  ASSERT_TRUE(set("R", "color", MFColor{{0, 1, 0}}));
  EXPECT_EQ(arrays().colors[0], (Color{0, 1, 0}));
  ASSERT_TRUE(set("C", "point", MFVec3f{{0, 0, 0}, {7, 0, 0}, {0, 7, 0}}));
  expectNear(arrays().points[1], {7, 0, 0});
}

TEST(ParticleEvents, PulsesOfBirthsLoseNone) {
  Particles r(system("createParticles FALSE maxParticles 40 particleLifetime 2 emitter "
                     "PointEmitter { }"));
  for (int k = 1; k <= 6; ++k) { // 10 births in each half of a second
    r.browser.tick(k);
    r.set("P", "createParticles", true);
    r.browser.tick(k + 0.5);
    r.set("P", "createParticles", false);
    EXPECT_NEAR(double(r.at(k + 0.6).points.size()), k == 1 ? 10 : 20, 1) << k;
  }
}

TEST(ParticleEvents, WithoutAnEmitterItIsNeverActive) {
  Particles r("DEF P ParticleSystem { }");
  EXPECT_EQ(r.get("P", "isActive"), "FALSE");
  EXPECT_EQ(r.now().points.size(), 0u);
  EXPECT_EQ(r.messages(), Messages{});
}

TEST(ParticleHostile, AHugeNumberIsBoundedWithAMessage) {
  Particles r(system("maxParticles 2000000000 particleLifetime 1e30 emitter PointEmitter { }"));
  EXPECT_EQ(r.now().points.size(), 1'000'000u);
  r.set("P", "maxParticles", 1'900'000'000); // is not said again
  EXPECT_EQ(
      r.messages(),
      Messages{"ParticleSystem: maxParticles is 2000000000, and 1000000 are drawn: a system has "
               "at most 1000000 particles"});
}

TEST(ParticleHostile, ValuesThatMakeNoSenseDrawNothingOrLess) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = float(never);
  for (const float bad : {nan, inf, -inf, 0.0f, -1.0f, 1e38f}) {
    Particles r(
        "DEF P ParticleSystem { emitter DEF E ConeEmitter { mass 1 } physics [ DEF F "
        "ForcePhysicsModel { }, DEF W WindPhysicsModel { }, BoundedPhysicsModel { geometry Box "
        "{ } } ] }");
    for (const char* field : {"speed", "variation", "angle", "mass", "surfaceArea"})
      r.set("E", field, bad);
    r.set("E", "position", Vec3f{bad, 0, 0});
    r.set("E", "direction", Vec3f{bad, bad, 0});
    r.set("F", "force", Vec3f{bad, bad, bad});
    for (const char* field : {"speed", "gustiness", "turbulence"}) r.set("W", field, bad);
    for (const GeometryArrays& arrays : {r.at(1), r.at(1e9)})
      for (const Vec3f& p : arrays.points) EXPECT_TRUE(std::isfinite(p.x + p.y + p.z)) << bad;
    r.set("P", "particleSize", Vec2f{bad, bad});
    r.set("P", "lifetimeVariation", bad);
    r.at(2e9);
    r.set("P", "particleLifetime", bad);
    EXPECT_LE(r.at(3e9).points.size(), 800u);
    r.set("P", "maxParticles", -5);
    EXPECT_EQ(r.at(4e9).points.size(), 0u);
  }
}

TEST(ParticleHostile, AMistakenFormIsSaid) {
  Particles r("ParticleSystem { geometryType \"BALL\" emitter PointEmitter { } }");
  EXPECT_EQ(r.now().points.size(), 800u);
  ASSERT_EQ(r.messages().size(), 1u);
  EXPECT_NE(r.messages()[0].find("\"BALL\" is not known"), std::string::npos);
}

} // namespace
} // namespace xvrml
