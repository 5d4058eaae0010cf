// xvrml_cut.cpp: meshes cut at planes, against closed forms: areas, interpolated values, and
// edges that stay shared.
#include <cmath>
#include <map>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "geometry/half_space.h"
#include "xvrml/world.h"

using namespace xvrml;

namespace {

constexpr uint64_t many = 1'000'000;

Mesh meshOf(const std::string& geometry, std::unique_ptr<World>& world) {
  world = loadWorldFromMemory("#X3D V3.3 utf8\nPROFILE Full\nShape { geometry " + geometry + " }\n",
                              "test.x3dv");
  EXPECT_EQ(world->diagnostics.list().size(), 0u);
  auto& shape = static_cast<nodes::Shape&>(*world->scope.roots.at(0));
  return buildMesh(*shape.geometry, {.needTexCoords = true});
}

// Returns what is left of a mesh that is cut.
Mesh left(const std::string& geometry, const HalfSpaces& halfSpaces) {
  std::unique_ptr<World> world;
  const Mesh whole = meshOf(geometry, world);
  Mesh rest;
  const Cut result = cut(whole, halfSpaces, many, rest);
  EXPECT_NE(result, Cut::tooLarge);
  EXPECT_EQ(result == Cut::part, rest.kind != Mesh::Kind::empty);
  return result == Cut::part ? std::move(rest) : Mesh();
}

double areaOf(const Mesh& mesh) {
  double area = 0;
  for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const Vector a = vector(mesh.points[mesh.indices[i]]),
                 b = vector(mesh.points[mesh.indices[i + 1]]),
                 c = vector(mesh.points[mesh.indices[i + 2]]);
    area += (b - a).cross(c - a).length() / 2;
  }
  return area;
}

HalfSpace along(double x, double y, double z, double offset) { return {Vector(x, y, z), offset}; }

TEST(Cut, AreasOfACube) {
  const std::string cube = "Box { size 2 2 2 }";
  EXPECT_NEAR(areaOf(left(cube, {along(1, 0, 0, 0)})), 4 + 4 * 2, 1e-6);
  // A corner: three right triangles with legs of 1.
  EXPECT_NEAR(areaOf(left(cube, {along(1, 1, 1, -2)})), 1.5, 1e-6);
  // Half of the cube by a diagonal plane has half of its surface.
  EXPECT_NEAR(areaOf(left(cube, {along(1, 1, 1, 0)})), 12, 1e-6);
  EXPECT_NEAR(areaOf(left(cube, {along(1, 0, 0, 0), along(0, 1, 0, 0), along(0, 0, 1, 0)})), 3,
              1e-6);
  std::unique_ptr<World> world;
  const Mesh whole = meshOf(cube, world);
  Mesh rest;
  const HalfSpaces touching = {along(1, 0, 0, 1)};
  EXPECT_EQ(cut(whole, touching, many, rest), Cut::whole) << "what lies on the plane remains";
  EXPECT_EQ(left(cube, {along(1, 0, 0, -1.001)}).kind, Mesh::Kind::empty);
}

// Archimedes: the area between two parallel planes is 2 pi r h. The facets
// lack at most 0.05 % of the whole sphere.
TEST(Cut, AreasOfASphere) {
  const double facets = 5e-4 * 16 * std::numbers::pi;
  for (const double height : {-1.5, -0.3, 0.0, 0.77, 1.9}) {
    const double area = 2 * std::numbers::pi * 2 * (2 - height);
    EXPECT_NEAR(areaOf(left("Sphere { radius 2 }", {along(0, 1, 0, -height)})), area, facets);
    EXPECT_NEAR(areaOf(left("Sphere { radius 2 }", {along(0.6, 0, 0.8, -height)})), area, facets);
  }
}

TEST(Cut, FacetsOfASphereHaveItsNormalsAndTextureCoordinates) {
  const Mesh half = left("Sphere { radius 2 }", {along(0, 1, 0, 0)});
  ASSERT_EQ(half.normals.size(), half.points.size());
  ASSERT_EQ(half.texCoords.size(), half.points.size());
  for (size_t i = 0; i < half.points.size(); i++) {
    const Vector p = vector(half.points[i]), n = vector(half.normals[i]);
    EXPECT_NEAR((n - p.normalized()).length(), 0, 1e-6);
    EXPECT_NEAR(half.texCoords[i].y, 1 - std::acos(std::min(1.0, p.y / 2)) / std::numbers::pi,
                1e-3);
    if (half.texCoords[i].x > 0.24 && half.texCoords[i].x < 0.26) { // a quarter from the back: -x
      EXPECT_LE(p.x, 1e-6);
    }
  }
  // Triangles face outwards.
  for (size_t i = 0; i + 2 < half.indices.size(); i += 3) {
    const Vector a = vector(half.points[half.indices[i]]),
                 b = vector(half.points[half.indices[i + 1]]),
                 c = vector(half.points[half.indices[i + 2]]);
    EXPECT_GT((b - a).cross(c - a).dot(a + b + c), 0);
  }
}

// Values that are linear in the position stay so.
TEST(Cut, InterpolatesColoursOpacitiesAndTextureCoordinates) {
  const Mesh rest = left(
      "IndexedTriangleSet { index [ 0 1 2 ] coord Coordinate { point [ 0 0 0, 4 0 0, 0 4 0 ] } "
      "texCoord TextureCoordinate { point [ 0 0, 4 0, 0 4 ] } color ColorRGBA { color [ 0 0 0 0, 1 "
      "0 "
      "0 .5, 0 1 0 1 ] } }",
      {along(1, 0.3, 0, -1), along(-0.2, -1, 0, 3)});
  ASSERT_GE(rest.points.size(), 4u);
  for (size_t i = 0; i < rest.points.size(); i++) {
    const Vec3f p = rest.points[i];
    EXPECT_NEAR(rest.texCoords[i].x, p.x, 1e-6);
    EXPECT_NEAR(rest.texCoords[i].y, p.y, 1e-6);
    EXPECT_NEAR(rest.colors[i].r, p.x / 4, 1e-6);
    EXPECT_NEAR(rest.colors[i].g, p.y / 4, 1e-6);
    EXPECT_NEAR(rest.alphas[i], p.x / 8 + p.y / 4, 1e-6);
  }
}

// A closed surface that is cut has open edges on the plane alone.
TEST(Cut, LeavesEdgesSharedThatThePlaneCrosses) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> number(-1, 1);
  for (int run = 0; run < 20; run++) {
    const HalfSpaces planes = {
        along(number(random), number(random), number(random), number(random)),
        along(number(random), number(random), number(random), number(random))};
    const Mesh rest = left("Sphere { radius 1.7 }", planes);
    using Place = std::array<float, 3>;
    std::map<std::pair<Place, Place>, int> edges;
    for (size_t i = 0; i + 2 < rest.indices.size(); i += 3)
      for (size_t k = 0; k < 3; k++) {
        const Vec3f a = rest.points[rest.indices[i + k]],
                    b = rest.points[rest.indices[i + (k + 1) % 3]];
        Place from{a.x, a.y, a.z}, to{b.x, b.y, b.z};
        edges[{std::min(from, to), std::max(from, to)}]++;
      }
    for (const auto& [edge, count] : edges) {
      if (count != 1 || edge.first == edge.second) continue;
      const Vector a(edge.first[0], edge.first[1], edge.first[2]),
          b(edge.second[0], edge.second[1], edge.second[2]);
      bool onPlane = false;
      for (const HalfSpace& plane : planes)
        onPlane |= std::abs(plane.distance(a)) < 1e-6 && std::abs(plane.distance(b)) < 1e-6;
      EXPECT_TRUE(onPlane) << run;
    }
  }
}

TEST(Cut, RefusesWhatWouldBeTooLarge) {
  std::unique_ptr<World> world;
  const Mesh whole = meshOf("Sphere { }", world);
  Mesh rest;
  const HalfSpaces half = {along(0, 1, 0, 0)}, inside = {along(0, 1, 0, 1)},
                   outside = {along(0, 1, 0, -1.001)};
  EXPECT_EQ(cut(whole, inside, 100, rest), Cut::whole) << "a sphere that is not cut has no facets";
  EXPECT_EQ(cut(whole, outside, 100, rest), Cut::nothing);
  EXPECT_EQ(cut(whole, half, 100, rest), Cut::tooLarge);
  EXPECT_EQ(rest.kind, Mesh::Kind::empty);
}

// The plane in the coordinates of a child: the same points remain.
TEST(Cut, HalfSpacesOfOtherCoordinates) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> number(-2, 2);
  for (int run = 0; run < 100; run++) {
    Matrix m = compose(translation({number(random), number(random), number(random)}),
                       rotation(Vector(number(random), number(random), 1), number(random)));
    m = compose(m, scaling({3, number(random), 0.5}));
    const HalfSpace outside = along(number(random), number(random), number(random), number(random));
    const Vector p(number(random), number(random), number(random));
    EXPECT_NEAR(inside(outside, m).distance(p), outside.distance(transformPoint(m, p)), 1e-12);
  }
}

} // namespace
