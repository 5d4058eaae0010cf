// xvrml_geometry_primitives.cpp: Tests Box, Cone, Cylinder and Sphere against their closed forms
// (ISO/IEC 14772-1 clauses 6.7, 6.11, 6.14, 6.43), and ORTQuadric and ORTAsphere.
#include "geometry/bounds.h"
#include "unit/mesh_checks.h"

namespace xvrml::test {
namespace {

constexpr double pi = std::numbers::pi;

TEST(GeometryBox, IsClosedAndFacesOutwards) {
  Made<nodes::Box> box("Box");
  Built built = build(box);
  expectSound(built.mesh);
  EXPECT_EQ(openEdges(built.mesh), 0u);
  EXPECT_NEAR(signedVolume(built.mesh), 8, 1e-9);
  EXPECT_NEAR(area(built.mesh), 24, 1e-9);
  EXPECT_TRUE(built.mesh.normals.empty()) << "flat";
  EXPECT_EQ(built.mesh.points.size(), 8u) << "sides share corners where there is no texture";
  EXPECT_TRUE(built.mesh.solid);
  EXPECT_EQ(built.diagnostics.warnings(), 0u);
  box->size = {1, 2, 3};
  EXPECT_NEAR(signedVolume(build(box).mesh), 6, 1e-6);
}

TEST(GeometryBox, TexturesAreUprightOnEverySide) {
  Made<nodes::Box> box("Box");
  Mesh mesh = build(box, true).mesh;
  ASSERT_EQ(mesh.texCoords.size(), 24u);
  // The directions in which s and t grow on a side, by the side's outward normal (clause 6.7).
  struct Expected {
    D3 normal, s, t;
  };
  const Expected expected[] = {
      {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}},  {{0, 0, -1}, {-1, 0, 0}, {0, 1, 0}},
      {{1, 0, 0}, {0, 0, -1}, {0, 1, 0}}, {{-1, 0, 0}, {0, 0, 1}, {0, 1, 0}},
      {{0, 1, 0}, {1, 0, 0}, {0, 0, -1}}, {{0, -1, 0}, {1, 0, 0}, {0, 0, 1}}};
  for (const Expected& side : expected) {
    int corners = 0;
    for (size_t t = 0; t < mesh.indices.size() / 3; t++) {
      if (dotProduct(areaVector(mesh, t), side.normal) < 1) continue;
      for (size_t e = 0; e < 3; e++, corners++) {
        const Vec2f& st = mesh.texCoords[mesh.indices[3 * t + e]];
        EXPECT_NEAR(st.x, (dotProduct(at(mesh, 3 * t + e), side.s) + 1) / 2, 1e-6);
        EXPECT_NEAR(st.y, (dotProduct(at(mesh, 3 * t + e), side.t) + 1) / 2, 1e-6);
      }
    }
    EXPECT_EQ(corners, 6);
  }
}

TEST(GeometryBox, WithoutHeightKeepsTwoSides) {
  Made<nodes::Box> box("Box");
  box->size = {2, 0, 2};
  Built built = build(box);
  expectSound(built.mesh);
  EXPECT_NEAR(area(built.mesh), 8, 1e-9);
  EXPECT_EQ(built.diagnostics.warnings(), 1u);
  box->size = {NAN, 1, 1};
  EXPECT_EQ(build(box).mesh.kind, Mesh::Kind::empty);
  box->size = {0, 0, 2};
  EXPECT_EQ(build(box).mesh.kind, Mesh::Kind::empty);
}

// Returns the area of a regular polygon of 64 sides relative to its circle. The volume of a prism
// over it approaches pi r^2 h from below.
double polygonShare() { return 64 * std::sin(2 * pi / 64) / 2 / pi; }

TEST(GeometryCylinder, IsClosedAndHasTheVolumeOfItsPolygon) {
  Made<nodes::Cylinder> cylinder("Cylinder");
  cylinder->radius = 2;
  cylinder->height = 3;
  Built built = build(cylinder);
  expectSound(built.mesh);
  EXPECT_EQ(openEdges(built.mesh), 0u);
  EXPECT_NEAR(signedVolume(built.mesh), 12 * pi * polygonShare(), 1e-5);
  EXPECT_GT(signedVolume(built.mesh), 12 * pi * 0.998);
  EXPECT_TRUE(normalsFaceFront(built.mesh));
}

TEST(GeometryCylinder, SideNormalsAreExactAndPartsCanBeLeftOut) {
  Made<nodes::Cylinder> cylinder("Cylinder");
  cylinder->top = cylinder->bottom = false;
  Mesh side = build(cylinder).mesh;
  EXPECT_NEAR(area(side), 2 * 2 * 64 * std::sin(pi / 64), 1e-5);
  for (size_t i = 0; i < side.points.size(); i++) {
    EXPECT_NEAR(side.normals[i].x, side.points[i].x, 1e-6);
    EXPECT_EQ(side.normals[i].y, 0);
    EXPECT_NEAR(side.normals[i].z, side.points[i].z, 1e-6);
  }
  cylinder->top = true;
  cylinder->side = false;
  Mesh top = build(cylinder).mesh;
  EXPECT_NEAR(area(top), pi * polygonShare(), 1e-6);
  for (const Vec3f& n : top.normals) EXPECT_EQ(n, (Vec3f{0, 1, 0}));
  cylinder->top = false;
  EXPECT_EQ(build(cylinder).mesh.kind, Mesh::Kind::empty);
}

TEST(GeometryCylinder, TextureRunsFromTheBackAroundTheLeft) {
  Made<nodes::Cylinder> cylinder("Cylinder");
  cylinder->top = cylinder->bottom = false;
  Mesh mesh = build(cylinder, true).mesh;
  auto near = [&](float s, float t) { // returns the point with these texture coordinates
    for (size_t i = 0; i < mesh.points.size(); i++)
      if (mesh.texCoords[i] == Vec2f{s, t}) return mesh.points[i];
    ADD_FAILURE() << "no vertex at " << s << " " << t;
    return Vec3f();
  };
  EXPECT_EQ(near(0, 0), (Vec3f{0, -1, -1}));
  EXPECT_EQ(near(0.25, 0), (Vec3f{-1, -1, 0}));
  EXPECT_EQ(near(0.5, 1), (Vec3f{0, 1, 1}));
  EXPECT_EQ(near(0.75, 1), (Vec3f{1, 1, 0}));
  EXPECT_EQ(near(1, 1), (Vec3f{0, 1, -1}));
}

TEST(GeometryCone, IsClosedAndItsNormalsAreExact) {
  Made<nodes::Cone> cone("Cone");
  cone->bottomRadius = 3;
  cone->height = 4;
  Built built = build(cone);
  expectSound(built.mesh);
  EXPECT_EQ(openEdges(built.mesh), 0u);
  EXPECT_NEAR(signedVolume(built.mesh), 12 * pi * polygonShare(), 1e-4);
  EXPECT_TRUE(normalsFaceFront(built.mesh));
  cone->bottom = false;
  Mesh side = build(cone).mesh;
  for (size_t i = 0; i < side.points.size(); i++)
    EXPECT_NEAR(side.normals[i].y, 0.6, 1e-6); // a 3-4-5 triangle
}

TEST(GeometryRound, TextureOfDiscsLooksUprightWhenTiltedTowardsTheViewer) {
  Made<nodes::Cylinder> cylinder("Cylinder");
  cylinder->side = cylinder->bottom = false;
  Mesh top = build(cylinder, true).mesh;
  for (size_t i = 0; i < top.points.size(); i++) {
    EXPECT_NEAR(top.texCoords[i].x, (top.points[i].x + 1) / 2, 1e-6);
    EXPECT_NEAR(top.texCoords[i].y, (-top.points[i].z + 1) / 2, 1e-6);
  }
  Made<nodes::Cone> cone("Cone");
  cone->side = false;
  Mesh bottom = build(cone, true).mesh;
  for (size_t i = 0; i < bottom.points.size(); i++) {
    EXPECT_NEAR(bottom.texCoords[i].x, (bottom.points[i].x + 1) / 2, 1e-6);
    EXPECT_NEAR(bottom.texCoords[i].y, (bottom.points[i].z + 1) / 2, 1e-6);
  }
}

TEST(GeometryRound, DegenerateSizesDoNoHarm) {
  Made<nodes::Cylinder> cylinder("Cylinder");
  for (float value : {1e-9f, 1e-38f, 0.f, -1.f, 1e38f, INFINITY, NAN}) {
    cylinder->height = value;
    expectSound(build(cylinder).mesh);
    cylinder->height = 2;
    cylinder->radius = value;
    expectSound(build(cylinder).mesh);
    cylinder->radius = 1;
    Made<nodes::Cone> cone("Cone");
    cone->bottomRadius = value;
    expectSound(build(cone).mesh);
  }
  Made<nodes::Cone> spike("Cone");
  spike->bottomRadius = 0;
  Built built = build(spike);
  EXPECT_EQ(built.mesh.kind, Mesh::Kind::empty);
  EXPECT_EQ(built.diagnostics.warnings(), 1u);
}

TEST(GeometrySphere, IsExact) {
  Made<nodes::Sphere> sphere("Sphere");
  sphere->radius = 2.5f;
  Mesh mesh = build(sphere).mesh;
  EXPECT_EQ(mesh.kind, Mesh::Kind::sphere);
  EXPECT_EQ(mesh.radius, 2.5f);
  EXPECT_EQ(boundsOf(mesh).maximum, (Vec3f{2.5f, 2.5f, 2.5f}));
  for (float bad : {0.f, NAN, INFINITY}) {
    sphere->radius = bad;
    Built built = build(sphere);
    EXPECT_EQ(built.mesh.kind, Mesh::Kind::empty);
    EXPECT_EQ(built.diagnostics.warnings(), 1u);
  }
}

TEST(GeometryExact, CylinderAndConeHaveExactSurfacesIfAskedFor) {
  Made<nodes::Cylinder> cylinder("Cylinder");
  Made<nodes::Cone> cone("Cone");
  EXPECT_TRUE(build(cylinder).mesh.exact.empty());
  EXPECT_TRUE(build(cone).mesh.exact.empty());
  MeshOptions options;
  options.exactShapes = true;
  EXPECT_EQ(buildMesh(*cylinder, options).exact.size(), 3u);
  EXPECT_EQ(buildMesh(*cone, options).exact.size(), 2u);
  cylinder->top = cylinder->bottom = false;
  const Mesh side = buildMesh(*cylinder, options);
  ASSERT_EQ(side.exact.size(), 1u);
  EXPECT_EQ(side.kind, Mesh::Kind::triangles) << "for pointing devices";
  EXPECT_EQ(side.exact[0].numbers[9], -1) << "minus the square of the radius";
  for (const float size : {1e-20f, 1e13f}) { // rtQuadric would refuse them
    cylinder->radius = cone->height = size;
    for (const Mesh& facets : {buildMesh(*cylinder, options), buildMesh(*cone, options)}) {
      EXPECT_TRUE(facets.exact.empty()) << size;
      EXPECT_EQ(facets.kind, Mesh::Kind::triangles) << size;
    }
  }
}

TEST(GeometryQuadric, TheTrianglesFollowTheSurface) {
  Made<nodes::ORTQuadric> quadric("ORTQuadric"); // the unit sphere
  Built built = build(quadric);
  expectSound(built.mesh);
  EXPECT_EQ(built.diagnostics.warnings(), 0u);
  EXPECT_NEAR(signedVolume(built.mesh), 4 * pi / 3, .05);
  ASSERT_EQ(built.mesh.exact.size(), 1u);
  EXPECT_EQ(built.mesh.exact[0].numbers.size(), 16u);
  quadric->coefficients = {1, 2, 3};
  EXPECT_EQ(build(quadric).diagnostics.warnings(), 1u);
  quadric->coefficients = {1, 1, 1, 0, 0, 0, 0, 0, 0, NAN};
  EXPECT_EQ(build(quadric).mesh.kind, Mesh::Kind::empty);
  quadric->coefficients = {1, 1, 1, 0, 0, 0, 0, 0, 0, -1};
  quadric->high = {-2, 1, 1};
  EXPECT_EQ(build(quadric).mesh.kind, Mesh::Kind::empty);
  EXPECT_EQ(build(quadric).diagnostics.warnings(), 1u);
}

TEST(GeometryAsphere, TheTrianglesFollowTheSurface) {
  Made<nodes::ORTAsphere> asphere("ORTAsphere");
  asphere->radius = 2;
  asphere->conic = -1;
  Built built = build(asphere);
  expectSound(built.mesh);
  EXPECT_EQ(built.diagnostics.warnings(), 0u);
  // A paraboloid of height h = .25 and radius 1 has the area pi / 6 / h^2 ((1 + 4 h^2)^1.5 - 1).
  EXPECT_NEAR(area(built.mesh), pi / 6 / .0625 * (std::pow(1.25, 1.5) - 1), 1e-2);
  for (const Vec3f& n : built.mesh.normals) EXPECT_GT(n.z, 0);
  for (size_t t = 0; t < built.mesh.indices.size() / 3; t++)
    EXPECT_GT(areaVector(built.mesh, t)[2], 0);
  ASSERT_EQ(built.mesh.exact.size(), 1u);
  EXPECT_EQ(built.mesh.exact[0].numbers, (std::vector<double>{.5, -1, 0, 1}));
  for (const float bad : {0.f, -1.f, NAN, INFINITY}) {
    asphere->semiAperture = bad;
    EXPECT_EQ(build(asphere).mesh.kind, Mesh::Kind::empty);
    EXPECT_EQ(build(asphere).diagnostics.warnings(), 1u);
  }
  asphere->semiAperture = 1;
  asphere->innerRadius = 1;
  EXPECT_EQ(build(asphere).mesh.kind, Mesh::Kind::empty);
  asphere->innerRadius = 0;
  asphere->terms.assign(9, 0.f);
  EXPECT_EQ(build(asphere).mesh.kind, Mesh::Kind::empty);
}

TEST(GeometryMesh, OtherNodesHaveNone) {
  Made<nodes::Coordinate> coordinates("Coordinate");
  EXPECT_EQ(build(coordinates).mesh.kind, Mesh::Kind::empty);
}

} // namespace
} // namespace xvrml::test
