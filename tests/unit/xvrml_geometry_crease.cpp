// xvrml_geometry_crease.cpp: Tests creaseAngle (clause 4.6.3.5): which edges are smooth, and that
// generated normals are finite unit vectors on the front side.
#include <cstring>

#include "unit/mesh_checks.h"

namespace xvrml::test {
namespace {

using Faces = Made<nodes::IndexedFaceSet>;
constexpr float pi = std::numbers::pi_v<float>;

Faces cube(float creaseAngle) {
  Faces node("IndexedFaceSet");
  MFVec3f points;
  for (int i = 0; i < 8; i++)
    points.push_back({i & 1 ? 1.f : -1.f, i & 2 ? 1.f : -1.f, i & 4 ? 1.f : -1.f});
  node->coord = coordinate(points);
  node->coordIndex = {0, 2, 3, 1, -1, 4, 5, 7, 6, -1, 0, 1, 5, 4, -1,
                      2, 6, 7, 3, -1, 0, 4, 6, 2, -1, 1, 3, 7, 5, -1};
  node->creaseAngle = creaseAngle;
  return node;
}

// Two squares that share an edge on the y axis and have `angle` between their normals.
Faces folded(float angle, float creaseAngle) {
  Faces node("IndexedFaceSet");
  node->coord = coordinate({{-1, 0, 0},
                            {0, 0, 0},
                            {std::cos(angle), 0, -std::sin(angle)},
                            {-1, 1, 0},
                            {0, 1, 0},
                            {std::cos(angle), 1, -std::sin(angle)}});
  node->coordIndex = {0, 1, 4, 3, -1, 1, 2, 5, 4, -1};
  node->creaseAngle = creaseAngle;
  return node;
}

TEST(GeometryCrease, ZeroIsFlat) {
  Faces node = cube(0);
  EXPECT_TRUE(build(node).mesh.normals.empty());
}

TEST(GeometryCrease, ACubeIsSharpBelowARightAngleAndSmoothAbove) {
  Faces sharp = cube(pi / 2 - 0.01f);
  Mesh mesh = build(sharp).mesh;
  expectSound(mesh);
  EXPECT_EQ(mesh.points.size(), 24u);
  EXPECT_NEAR(signedVolume(mesh), 8, 1e-6);
  EXPECT_TRUE(normalsFaceFront(mesh));
  Faces smooth = cube(pi / 2 + 0.01f);
  mesh = build(smooth).mesh;
  expectSound(mesh);
  EXPECT_EQ(mesh.points.size(), 8u);
  for (size_t i = 0; i < mesh.points.size(); i++) {
    EXPECT_NEAR(mesh.normals[i].x, mesh.points[i].x / std::sqrt(3.0), 1e-5);
    EXPECT_NEAR(mesh.normals[i].y, mesh.points[i].y / std::sqrt(3.0), 1e-5);
    EXPECT_NEAR(mesh.normals[i].z, mesh.points[i].z / std::sqrt(3.0), 1e-5);
  }
}

TEST(GeometryCrease, TheAngleOfAFoldDecides) {
  for (float angle : {0.01f, 0.1f, 0.5f, 1.f, 1.5f, 2.f, 3.f}) {
    Faces below = folded(angle, angle * 0.98f), above = folded(angle, angle * 1.02f);
    Mesh sharp = build(below).mesh, smooth = build(above).mesh;
    expectSound(sharp);
    expectSound(smooth);
    EXPECT_EQ(sharp.points.size(), 8u) << angle;
    EXPECT_EQ(smooth.points.size(), 6u) << angle;
    // On the fold the smooth normal bisects the angle.
    for (size_t i = 0; i < smooth.points.size(); i++)
      if (smooth.points[i].x == 0 && smooth.points[i].z == 0) {
        EXPECT_NEAR(smooth.normals[i].x, std::sin(angle / 2), 1e-4);
      }
  }
}

TEST(GeometryCrease, NormalsFollowCcw) {
  Faces node = folded(0.5f, 1);
  Vec3f front = build(node).mesh.normals[0];
  node->ccw = false;
  Mesh mesh = build(node).mesh;
  EXPECT_EQ(mesh.normals[0], (Vec3f{-front.x, -front.y, -front.z}));
  EXPECT_TRUE(normalsFaceFront(mesh));
}

TEST(GeometryCrease, DoesNotDependOnHowFacesAreCut) {
  Faces whole = cube(2);
  Faces cut = cube(2);
  cut->coordIndex.clear();
  const MFInt32& quads = whole->coordIndex;
  for (size_t i = 0; i < quads.size(); i += 5) {
    cut->coordIndex.insert(cut->coordIndex.end(), {quads[i], quads[i + 1], quads[i + 2], -1});
    cut->coordIndex.insert(cut->coordIndex.end(), {quads[i], quads[i + 2], quads[i + 3], -1});
  }
  Mesh a = build(whole).mesh, b = build(cut).mesh;
  ASSERT_EQ(a.points.size(), b.points.size());
  for (size_t i = 0; i < a.points.size(); i++)
    for (size_t k = 0; k < b.points.size(); k++)
      if (a.points[i] == b.points[k]) { EXPECT_NEAR(a.normals[i].x, b.normals[k].x, 1e-3); }
}

TEST(GeometryCrease, OppositeFacesFallBackToTheirOwnNormals) {
  Faces node("IndexedFaceSet");
  node->coord = coordinate({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  node->coordIndex = {0, 1, 2, -1, 2, 1, 0, -1};
  node->creaseAngle = 4;
  Mesh mesh = build(node).mesh;
  expectSound(mesh);
  EXPECT_EQ(mesh.points.size(), 6u);
  EXPECT_TRUE(normalsFaceFront(mesh));
}

// A fan of very many faces around one point: the cost must stay linear and the result smooth.
TEST(GeometryCrease, ManyFacesAtOnePoint) {
  const int n = 100000;
  Faces node("IndexedFaceSet");
  MFVec3f points = {{0, 1, 0}};
  for (int i = 0; i < n; i++)
    points.push_back({float(std::cos(2 * pi * i / n)), 0, float(-std::sin(2 * pi * i / n))});
  node->coord = coordinate(points);
  for (int i = 0; i < n; i++)
    node->coordIndex.insert(node->coordIndex.end(), {0, 1 + i, 1 + (i + 1) % n, -1});
  node->creaseAngle = 0.5f;
  Mesh mesh = build(node).mesh;
  expectSound(mesh);
  EXPECT_TRUE(normalsFaceFront(mesh));
  for (size_t i = 0; i < mesh.points.size(); i++)
    if (mesh.points[i].y == 0) { // normal of the cone
      EXPECT_NEAR(mesh.normals[i].y, std::sqrt(0.5), 1e-2);
    }
  node->creaseAngle = 4;
  mesh = build(node).mesh;
  for (size_t i = 0; i < mesh.points.size(); i++)
    if (mesh.points[i].y == 1) { // the apex: all normals together give the axis
      EXPECT_NEAR(mesh.normals[i].y, 1, 1e-3);
    }
}

// A wave of n x n points. Its mesh uses the node's points; with `again` the first face names a
// point twice, so that the mesh is built of a FaceSet.
Faces wave(size_t n, float creaseAngle, bool again) {
  Faces node("IndexedFaceSet");
  MFVec3f points;
  for (size_t i = 0; i < n * n; i++) {
    const float u = float(i % n) / float(n), v = float(i / n) / float(n);
    points.push_back({u, .05f * std::sin(9 * u) * std::cos(7 * v), v});
  }
  node->coord = coordinate(points);
  if (again) node->coordIndex.push_back(0);
  for (size_t i = 0; i + n < n * n; i++) {
    const auto a = int32_t(i), b = a + 1, c = a + int32_t(n), d = c + 1;
    if (size_t(b) % n != 0)
      node->coordIndex.insert(node->coordIndex.end(), {a, c, b, -1, b, c, d, -1});
  }
  node->creaseAngle = creaseAngle;
  return node;
}

template <class T> bool sameBytes(std::span<const T> a, std::span<const T> b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size_bytes()) == 0;
}

TEST(GeometryCrease, LargeSetsOfTrianglesGetTheNormalsOfAllOthers) {
  for (const float creaseAngle : {.01f, 1.0f, 4.0f})
    for (const bool ccw : {true, false}) {
      Faces plain = wave(90, creaseAngle, false), again = wave(90, creaseAngle, true);
      plain->ccw = again->ccw = ccw;
      const Built a = build(plain), b = build(again);
      EXPECT_EQ(a.mesh.plain, creaseAngle >= 1);
      EXPECT_FALSE(b.mesh.plain);
      EXPECT_TRUE(sameBytes(a.mesh.points, b.mesh.points));
      EXPECT_TRUE(sameBytes(a.mesh.indices, b.mesh.indices));
      EXPECT_TRUE(sameBytes(a.mesh.normals, b.mesh.normals));
    }
}

} // namespace
} // namespace xvrml::test
