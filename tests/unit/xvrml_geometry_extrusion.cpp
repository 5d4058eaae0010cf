// xvrml_geometry_extrusion.cpp: Tests Extrusion (clause 6.18): frames, caps, scale, orientation,
// closed and degenerate spines, against closed forms.
#include "unit/mesh_checks.h"

namespace xvrml::test {
namespace {

using Sweep = Made<nodes::Extrusion>;
constexpr double pi = std::numbers::pi;

// The points run in the direction of the default crossSection.
MFVec2f circle(int n, double radius, bool closed = true) {
  MFVec2f points;
  for (int i = 0; i < n; i++)
    points.push_back(
        {float(radius * std::cos(2 * pi * i / n)), float(-radius * std::sin(2 * pi * i / n))});
  if (closed) points.push_back(points[0]);
  return points;
}
double polygonArea(int n, double radius) { return n * radius * radius * std::sin(2 * pi / n) / 2; }

TEST(GeometryExtrusion, DefaultIsABox) {
  Sweep node("Extrusion");
  Built built = build(node);
  expectSound(built.mesh);
  EXPECT_EQ(openEdges(built.mesh), 0u);
  EXPECT_NEAR(signedVolume(built.mesh), 4, 1e-6);
  EXPECT_NEAR(area(built.mesh), 16, 1e-6);
  EXPECT_EQ(built.diagnostics.warnings(), 0u);
  node->beginCap = false;
  EXPECT_NEAR(area(build(node).mesh), 12, 1e-6);
  node->endCap = false;
  Mesh tube = build(node).mesh;
  EXPECT_NEAR(area(tube), 8, 1e-6);
  EXPECT_GT(openEdges(tube), 0u);
  node->solid = node->ccw = false;
  Mesh flags = build(node).mesh;
  EXPECT_FALSE(flags.solid);
  EXPECT_FALSE(flags.ccw);
}

TEST(GeometryExtrusion, StraightSpinesInAnyDirection) {
  for (Vec3f d : {Vec3f{0, 1, 0}, Vec3f{0, -1, 0}, Vec3f{1, 0, 0}, Vec3f{-1, 0, 0}, Vec3f{0, 0, 1},
                  Vec3f{0, 0, -1}, Vec3f{1, 2, 3}, Vec3f{-3, 0.1f, 2}})
    for (int points : {2, 3, 7}) {
      Sweep node("Extrusion");
      node->crossSection = circle(24, 0.5);
      node->spine.clear();
      for (int i = 0; i < points; i++) node->spine.push_back({d.x * i, d.y * i, d.z * i});
      Mesh mesh = build(node).mesh;
      expectSound(mesh);
      EXPECT_EQ(openEdges(mesh), 0u);
      double length = std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z) * (points - 1);
      EXPECT_NEAR(signedVolume(mesh), polygonArea(24, 0.5) * length, 1e-4 * length);
    }
}

// Collinear spine: the xz plane is rotated by the rotation that takes +y to the spine.
TEST(GeometryExtrusion, CollinearSpineTurnsTheSectionTheShortWay) {
  Sweep node("Extrusion");
  node->crossSection = {{1, 0}, {0, 1}};
  node->beginCap = node->endCap = false;
  node->spine = {{0, 0, 0}, {5, 0, 0}};
  Mesh mesh = build(node).mesh;
  EXPECT_NEAR(mesh.points[0].y, -1, 1e-6); // taking +y to +x takes +x to -y
  EXPECT_NEAR(mesh.points[1].z, 1, 1e-6);  // and leaves z unchanged
}

TEST(GeometryExtrusion, ABentSpineMitresItsCorner) {
  // An L in the xy plane: at the corner the plane of the section bisects the angle.
  Sweep node("Extrusion");
  node->spine = {{0, 0, 0}, {0, 4, 0}, {4, 4, 0}};
  node->crossSection = circle(4, 0.1);
  Mesh mesh = build(node).mesh;
  expectSound(mesh);
  EXPECT_EQ(openEdges(mesh), 0u);
  EXPECT_GT(signedVolume(mesh), 0);
  // Middle row: y axis along (1, 1, 0), z = (p2 - p1) x (p0 - p1) = (4,0,0) x (0,-4,0) = -z, x = y
  // x z.
  const Vec3f& x = mesh.points[4]; // belongs to the first section point (0.1, 0)
  EXPECT_NEAR(x.x, -0.1 / std::sqrt(2), 1e-6);
  EXPECT_NEAR(x.y, 4 + 0.1 / std::sqrt(2), 1e-6);
}

TEST(GeometryExtrusion, SpinesThatBendBothWaysDoNotTwist) {
  Sweep node("Extrusion"); // an S: z axes must not flip where the bend changes its direction
  node->spine.clear();
  for (int i = 0; i <= 40; i++)
    node->spine.push_back({float(std::sin(i * pi / 10)), float(i) * 0.2f, 0});
  node->crossSection = circle(16, 0.1);
  Mesh mesh = build(node).mesh;
  expectSound(mesh);
  EXPECT_EQ(openEdges(mesh), 0u);
  EXPECT_GT(signedVolume(mesh), 0);
  // The same section point stays on the same side.
  for (size_t i = 0; i + 1 < node->spine.size(); i++) {
    const Vec3f &a = mesh.points[i * 16 + 4], &b = mesh.points[(i + 1) * 16 + 4];
    EXPECT_NEAR(a.z, b.z, 1e-5);
  }
}

TEST(GeometryExtrusion, AClosedRingIsATorus) {
  Sweep node("Extrusion");
  const int around = 96, section = 32;
  node->spine.clear();
  for (int i = 0; i < around; i++)
    node->spine.push_back(
        {float(2 * std::cos(2 * pi * i / around)), 0, float(-2 * std::sin(2 * pi * i / around))});
  node->spine.push_back(node->spine[0]);
  node->crossSection = circle(section, 0.5);
  for (float crease : {0.f, 1.f}) {
    node->creaseAngle = crease;
    Mesh mesh = build(node).mesh;
    expectSound(mesh);
    EXPECT_EQ(openEdges(mesh), 0u);
    // Pappus: area of the section times the path of its centroid. The sections stand on the corners
    // of the spine's polygon.
    double expected = polygonArea(section, 0.5) * polygonArea(around, 2) / 2 * 2;
    EXPECT_NEAR(signedVolume(mesh), expected, 0.005 * expected);
    EXPECT_EQ(mesh.points.size(), crease > 0 ? size_t(around * section) : mesh.points.size())
        << "smooth across both seams";
    if (crease > 0) { EXPECT_TRUE(normalsFaceFront(mesh)); }
  }
}

TEST(GeometryExtrusion, ScaleZeroMakesACone) {
  Sweep node("Extrusion");
  node->crossSection = circle(64, 1);
  node->spine = {{0, 0, 0}, {0, 3, 0}};
  node->scale = {{1, 1}, {0, 0}};
  for (float crease : {0.f, 1.f}) {
    node->creaseAngle = crease;
    Built built = build(node);
    expectSound(built.mesh);
    EXPECT_EQ(built.diagnostics.warnings(), 0u);
    EXPECT_EQ(openEdges(built.mesh), 0u);
    EXPECT_NEAR(signedVolume(built.mesh), polygonArea(64, 1), 1e-5); // a third of base times height
  }
  node->scale = {{2, 0.5f}};
  EXPECT_NEAR(signedVolume(build(node).mesh), 3 * polygonArea(64, 1), 1e-4);
}

TEST(GeometryExtrusion, FewerScalesAndOrientationsThanSpinePoints) {
  Sweep node("Extrusion");
  node->spine = {{0, 0, 0}, {0, 1, 0}, {0, 2, 0}, {0, 3, 0}};
  node->scale = {{1, 1}, {2, 2}};
  Mesh mesh = build(node).mesh; // the last scale continues: a frustum, then a box
  EXPECT_NEAR(signedVolume(mesh), (4 + 16 + 8) / 3.0 + 2 * 16, 1e-4);
  node->scale = {};
  node->orientation = {};
  EXPECT_NEAR(signedVolume(build(node).mesh), 12, 1e-5);
  node->scale = MFVec2f(20, {1, 1}); // additional values are ignored
  EXPECT_NEAR(signedVolume(build(node).mesh), 12, 1e-5);
}

TEST(GeometryExtrusion, OrientationTurnsAboutTheSpinePoint) {
  Sweep node("Extrusion");
  node->spine = {{0, 0, 0}, {0, 2, 0}};
  node->crossSection = {{1, 0}, {-1, 0}};
  node->beginCap = node->endCap = false;
  node->orientation = {{0, 1, 0, 0}, {0, 1, 0, float(pi / 2)}};
  Mesh mesh = build(node).mesh;
  EXPECT_NEAR(mesh.points[0].x, 1, 1e-6);
  EXPECT_NEAR(mesh.points[2].z, -1, 1e-6); // a quarter turn about y takes +x to -z
  EXPECT_NEAR(mesh.points[2].y, 2, 1e-6);
}

TEST(GeometryExtrusion, CoincidentSpinePointsMakeASurfaceOfRevolution) {
  // A half circle of radius 1 right of the y axis, rotated about y: a sphere.
  Sweep node("Extrusion");
  const int turns = 48, arc = 24;
  node->crossSection.clear();
  for (int i = 0; i <= arc; i++)
    node->crossSection.push_back({float(std::sin(pi * i / arc)), float(std::cos(pi * i / arc))});
  node->crossSection.back().x = 0; // on the axis
  node->spine.assign(turns + 1, {0, 0, 0});
  node->orientation.clear();
  // The section lies in the xz plane and is rotated about z in steps, so it sweeps a sphere about
  // z.
  for (int i = 0; i <= turns; i++)
    node->orientation.push_back({0, 0, 1, i == turns ? 0 : float(2 * pi * i / turns)});
  node->beginCap = node->endCap = false;
  Mesh mesh = build(node).mesh;
  expectSound(mesh);
  EXPECT_EQ(openEdges(mesh), 0u);
  EXPECT_NEAR(std::abs(signedVolume(mesh)), 4 * pi / 3, 0.03);
}

TEST(GeometryExtrusion, SomeCoincidentPointsShareAFrame) {
  Sweep node("Extrusion");
  node->spine = {{0, 0, 0}, {0, 0, 0}, {0, 1, 0}, {0, 1, 0}, {0, 1, 0}, {0, 2, 0}, {0, 2, 0}};
  node->scale = {{1, 1},       {1, 1},       {1, 1},      {1, 1},
                 {0.5f, 0.5f}, {0.5f, 0.5f}, {0.5f, 0.5f}}; // a step
  Mesh mesh = build(node).mesh;
  expectSound(mesh);
  EXPECT_EQ(openEdges(mesh), 0u);
  EXPECT_NEAR(signedVolume(mesh), 4 + 1, 1e-5);
}

TEST(GeometryExtrusion, ConcaveCapsKeepTheirArea) {
  const MFVec2f l = {{0, 0}, {0, 3}, {1, 3}, {1, 1}, {3, 1}, {3, 0}, {0, 0}}; // an L of area 5
  for (bool convex : {true, false}) {
    Sweep node("Extrusion");
    node->crossSection = MFVec2f(l.rbegin(), l.rend());
    node->convex = convex;
    node->spine = {{0, 0, 0}, {0, 2, 0}};
    Mesh mesh = build(node).mesh;
    expectSound(mesh);
    EXPECT_EQ(openEdges(mesh), 0u);
    EXPECT_NEAR(std::abs(signedVolume(mesh)), 10, 1e-5);
    EXPECT_NEAR(area(mesh), 2 * 5 + 12 * 2, 1e-5);
  }
}

TEST(GeometryExtrusion, OpenSectionsAreClosedByTheirCaps) {
  Sweep node("Extrusion"); // three sides of the default box; the caps close the missing edge
  node->crossSection.pop_back();
  Mesh mesh = build(node).mesh;
  expectSound(mesh);
  EXPECT_NEAR(area(mesh), 3 * 2 + 2 * 4, 1e-5);
}

TEST(GeometryExtrusion, CapsStaySharpHoweverLargeTheCreaseAngle) {
  Sweep node("Extrusion");
  node->crossSection = circle(32, 1);
  node->creaseAngle = 4;
  Mesh mesh = build(node).mesh;
  expectSound(mesh);
  size_t up = 0, down = 0, side = 0;
  for (const Vec3f& n : mesh.normals) (n.y > 0.999f ? up : n.y < -0.999f ? down : side)++;
  EXPECT_EQ(up, 32u);
  EXPECT_EQ(down, 32u);
  EXPECT_EQ(side, 64u);
}

TEST(GeometryExtrusion, TextureOfSidesAndCaps) {
  Sweep node("Extrusion");
  node->crossSection = {{2, 1}, {2, -1}, {-2, -1}, {-2, 1}, {2, 1}};
  node->spine = {{0, 0, 0}, {0, 1, 0}, {0, 3, 0}};
  EXPECT_TRUE(build(node).mesh.texCoords.empty());
  Mesh mesh = build(node, true).mesh;
  expectSound(mesh);
  EXPECT_EQ(openEdges(mesh), 0u);
  size_t seams = 0;
  for (size_t t = 0; t < mesh.indices.size() / 3; t++) {
    D3 n = areaVector(mesh, t);
    for (size_t e = 0; e < 3; e++) {
      D3 p = at(mesh, 3 * t + e);
      Vec2f st = mesh.texCoords[mesh.indices[3 * t + e]];
      if (std::abs(n[1]) > 1e-6) { // caps: the larger side of the section, along x, has 0 to 1
        EXPECT_NEAR(st.x, (p[0] + 2) / 4, 1e-6);
        EXPECT_NEAR(st.y, (p[2] + 1) / 4, 1e-6);
      } else { // sides: T by spine point, S by section point
        EXPECT_NEAR(st.y, p[1] == 3 ? 1 : p[1] / 2, 1e-6);
        if (p[0] == 2 && p[2] == 1) {
          seams++;
          EXPECT_TRUE(st.x == 0 || st.x == 1);
        }
        if (p[0] == 2 && p[2] == -1) { EXPECT_EQ(st.x, 0.25); }
      }
    }
  }
  EXPECT_GT(seams, 2u);
}

TEST(GeometryExtrusion, NothingToSweepIsSaid) {
  for (int what = 0; what < 4; what++) {
    Sweep node("Extrusion");
    if (what == 0) node->spine = {{0, 0, 0}};
    if (what == 1) node->crossSection = {{1, 1}};
    if (what == 2) node->spine[1].x = NAN;
    if (what == 3) node->crossSection[1].x = INFINITY;
    Built built = build(node);
    EXPECT_EQ(built.mesh.kind, Mesh::Kind::empty);
    EXPECT_EQ(built.diagnostics.warnings(), 1u);
  }
  Sweep point("Extrusion"); // all points coincide
  point->crossSection = {{0, 0}, {0, 0}, {0, 0}};
  EXPECT_EQ(build(point).mesh.kind, Mesh::Kind::empty);
  Sweep back("Extrusion"); // forward and back again
  back->spine = {{0, 0, 0}, {0, 1, 0}, {0, 0, 0}, {0, 1, 0}};
  expectSound(build(back).mesh);
  Limits limits;
  limits.triangles = 100;
  Sweep large("Extrusion");
  large->spine.clear();
  for (int i = 0; i < 1000; i++) large->spine.push_back({0, float(i), 0});
  Built built = build(large, false, limits);
  EXPECT_EQ(built.mesh.kind, Mesh::Kind::empty);
  EXPECT_EQ(built.diagnostics.warnings(), 1u);
}

} // namespace
} // namespace xvrml::test
