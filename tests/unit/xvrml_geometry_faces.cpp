// Tests IndexedFaceSet without attributes: faces of every shape, and faces that are wrong.
#include "geometry/bounds.h"
#include "unit/mesh_checks.h"

namespace xvrml::test {
namespace {

using Faces = Made<nodes::IndexedFaceSet>;

Faces faceSet(MFVec3f points, MFInt32 index) {
  Faces node("IndexedFaceSet");
  node->coord = coordinate(std::move(points));
  node->coordIndex = std::move(index);
  return node;
}

Faces polygon(MFVec3f points, bool convex) {
  MFInt32 index;
  for (size_t i = 0; i < points.size(); i++) index.push_back(int32_t(i));
  Faces node = faceSet(std::move(points), std::move(index));
  node->convex = convex;
  return node;
}

// Twice the signed area is the sum of the cross products of neighbours (shoelace formula).
double shoelace(const MFVec3f& p) {
  double sum = 0;
  for (size_t i = 0; i < p.size(); i++) {
    const Vec3f &a = p[i], &b = p[(i + 1) % p.size()];
    sum += double(a.x) * b.y - double(a.y) * b.x;
  }
  return sum / 2;
}

double frontArea(const Mesh& mesh) { // all triangles must face +z
  double sum = 0;
  for (size_t t = 0; t < mesh.indices.size() / 3; t++) {
    EXPECT_GT(areaVector(mesh, t)[2], 0);
    sum += areaVector(mesh, t)[2];
  }
  return sum;
}

TEST(GeometryFaces, TrianglesUseTheNodesPoints) {
  Faces node = faceSet({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {0, 1, 2, -1, 0, 2, 3, -1});
  Built built = build(node);
  expectSound(built.mesh);
  const auto& points = nodeCast<nodes::Coordinate>(node->coord)->point;
  EXPECT_EQ(built.mesh.points.data(), points.data());
  EXPECT_TRUE(built.mesh.ownPoints.empty());
  EXPECT_EQ(std::vector<uint32_t>(built.mesh.indices.begin(), built.mesh.indices.end()),
            (std::vector<uint32_t>{0, 1, 2, 0, 2, 3}));
  EXPECT_TRUE(built.mesh.normals.empty() && built.mesh.colors.empty() &&
              built.mesh.texCoords.empty());
  node->coordIndex.pop_back(); // the last -1 may be missing
  EXPECT_EQ(build(node).mesh.indices.size(), 6u);
}

TEST(GeometryFaces, FlagsPassOn) {
  Faces node = faceSet({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}, {0, 1, 2});
  node->ccw = node->solid = false;
  Mesh mesh = build(node).mesh;
  EXPECT_FALSE(mesh.ccw);
  EXPECT_FALSE(mesh.solid);
}

TEST(GeometryFaces, ConvexPolygonsAreFans) {
  MFVec3f circle;
  for (int i = 0; i < 12; i++)
    circle.push_back(
        {float(std::cos(i * std::numbers::pi / 6)), float(std::sin(i * std::numbers::pi / 6)), 0});
  Faces node = polygon(circle, true);
  Mesh mesh = build(node).mesh;
  EXPECT_EQ(mesh.indices.size(), 30u);
  EXPECT_NEAR(frontArea(mesh), shoelace(circle), 1e-6);
}

TEST(GeometryFaces, ConcavePolygonsKeepTheirArea) {
  const MFVec3f shapes[] = {
      {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {2, 1, 0}, {0, 4, 0}},            // notch
      {{0, 0, 0}, {3, 0, 0}, {3, 1, 0}, {1, 1, 0}, {1, 3, 0}, {0, 3, 0}}, // L
      {{0, 0, 0}, {1, 0.2f, 0}, {0.2f, 0.3f, 0}, {0, 1, 0}},   // arrow: concave quadrilateral
      {{0.2f, 0.3f, 0}, {0, 1, 0}, {0, 0, 0}, {1, 0.2f, 0}},   // the same from another corner
      {{0, 0, 0}, {2, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}}, // straight corner
      {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 2, 0}}, // quadrilateral with a straight corner
      {{0, 0, 0},
       {9, 0, 0},
       {9, 5, 0},
       {7, 5, 0},
       {7, 1, 0},
       {5, 1, 0},
       {5, 5, 0},
       {3, 5, 0},
       {3, 1, 0},
       {1, 1, 0},
       {1, 5, 0},
       {0, 5, 0}}, // comb
  };
  for (const MFVec3f& shape : shapes)
    for (bool convex : {true, false}) { // `convex TRUE` is often a wrong promise
      Faces node = polygon(shape, convex);
      Built built = build(node);
      expectSound(built.mesh);
      EXPECT_NEAR(frontArea(built.mesh), shoelace(shape), 1e-6);
      EXPECT_EQ(built.diagnostics.warnings(), 0u);
      // The other way round it faces away.
      Faces back = polygon(MFVec3f(shape.rbegin(), shape.rend()), convex);
      Mesh mesh = build(back).mesh;
      for (size_t t = 0; t < mesh.indices.size() / 3; t++) EXPECT_LT(areaVector(mesh, t)[2], 0);
      EXPECT_NEAR(area(mesh), shoelace(shape), 1e-6);
    }
}

TEST(GeometryFaces, HolesBridgedByADoubledEdgeStayOpen) {
  // A square of side 4 with a square hole of side 2, joined by an edge there and back.
  MFVec3f shape = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {0, 0, 0},
                   {1, 1, 0}, {1, 3, 0}, {3, 3, 0}, {3, 1, 0}, {1, 1, 0}};
  Faces node = polygon(shape, false);
  Mesh mesh = build(node).mesh;
  expectSound(mesh);
  EXPECT_NEAR(frontArea(mesh), 12, 1e-6);
  for (size_t t = 0; t < mesh.indices.size() / 3; t++) { // no triangle reaches into the hole
    double x = 0, y = 0;
    for (size_t e = 0; e < 3; e++) {
      x += at(mesh, 3 * t + e)[0] / 3;
      y += at(mesh, 3 * t + e)[1] / 3;
    }
    EXPECT_FALSE(x > 1 && x < 3 && y > 1 && y < 3);
  }
  // The same in one list of shared points.
  Faces shared = faceSet(
      {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {1, 1, 0}, {1, 3, 0}, {3, 3, 0}, {3, 1, 0}},
      {0, 1, 2, 3, 0, 4, 5, 6, 7, 4, -1});
  shared->convex = false;
  EXPECT_NEAR(area(build(shared).mesh), 12, 1e-6);
}

TEST(GeometryFaces, SelfCrossingFacesGetTheVertexWhereTheyCross) {
  Faces bow = polygon({{0, 0, 0}, {2, 2, 0}, {2, 0, 0}, {0, 2, 0}},
                      false); // figure of eight: two triangles of area 1
  bow->color = color({{1, 0, 0}, {1, 0, 0}, {0, 0, 1}, {0, 0, 1}});
  bow->texCoord = textureCoordinate({{0, 0}, {1, 1}, {1, 0}, {0, 1}});
  Mesh mesh = build(bow).mesh;
  expectSound(mesh);
  EXPECT_NEAR(area(mesh), 2, 1e-6);
  bool found = false;
  for (size_t i = 0; i < mesh.points.size(); i++)
    if (mesh.points[i] == Vec3f{1, 1, 0}) {
      found = true;
      EXPECT_NEAR(mesh.colors[i].r, 0.5, 1e-6);
      EXPECT_NEAR(mesh.texCoords[i].x, 0.5, 1e-6);
    }
  EXPECT_TRUE(found);
  // A pentagram: odd winding leaves the middle open. Its points' area by the golden ratio.
  MFVec3f star;
  for (int i = 0; i < 5; i++)
    star.push_back({float(std::cos(i * 0.8 * std::numbers::pi)),
                    float(std::sin(i * 0.8 * std::numbers::pi)), 0});
  Faces pentagram = polygon(star, true);
  double sine36 = std::sin(std::numbers::pi / 5), phi = std::numbers::phi;
  double inner = 2.5 * std::pow(1 / (phi * phi), 2) *
                 std::sin(0.4 * std::numbers::pi);                 // pentagon in the middle
  double side = 2 * sine36 / (phi * phi);                          // its edge
  double tip = side * side / 4 * std::tan(0.4 * std::numbers::pi); // 5 tips over those edges
  (void)inner;
  EXPECT_NEAR(area(build(pentagram).mesh), 5 * tip, 1e-5);
}

TEST(GeometryFaces, WrongFacesAreDroppedWithOneWarning) {
  Faces node = faceSet({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 2, 0}, {2, 2, 0}},
                       {0,  1,  2,  -1,         // good
                        0,  1,  -1,             // two vertices
                        0,  0,  0,  -1,         // one vertex
                        0,  1,  17, -1,         // no such point
                        0,  1,  -7, 2,  -1,     // nor this
                        -1, -1,                 // nothing at all
                        4,  5,  4,  -1,         // no extent
                        0,  2,  4,  -1,         // on a line
                        0,  0,  1,  2,  2,  -1, // repeated: a triangle
                        0,  1,  2,  3});        // good, without its -1
  node->source.line = 42;
  Built built = build(node);
  expectSound(built.mesh);
  EXPECT_NEAR(area(built.mesh), 2, 1e-6);
  ASSERT_EQ(built.diagnostics.list().size(), 1u);
  const Diagnostic& warning = built.diagnostics.list()[0];
  EXPECT_EQ(warning.severity, Severity::warning);
  EXPECT_EQ(warning.line, 42u);
  EXPECT_NE(warning.message.find("IndexedFaceSet"), std::string::npos);
  EXPECT_NE(warning.message.find("2 faces left out: coordIndex[13] has no point"),
            std::string::npos)
      << warning.message;
}

TEST(GeometryFaces, NothingToDrawIsNoMistake) {
  Faces empty("IndexedFaceSet");
  EXPECT_EQ(build(empty).mesh.kind, Mesh::Kind::empty);
  empty->coord = coordinate({{0, 0, 0}});
  Built built = build(empty);
  EXPECT_EQ(built.mesh.kind, Mesh::Kind::empty);
  EXPECT_EQ(built.diagnostics.warnings(), 0u);
  empty->coordIndex = {-1, -1, -1};
  EXPECT_EQ(build(empty).mesh.kind, Mesh::Kind::empty);
}

TEST(GeometryFaces, PointsThatAreNotFiniteAreNeverSeen) {
  Faces node = faceSet({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {NAN, 0, 0}, {0, INFINITY, 0}},
                       {0, 1, 2, -1, 0, 1, 3, -1, 0, 1, 4, -1});
  Built built = build(node);
  expectSound(built.mesh);
  EXPECT_EQ(built.mesh.indices.size(), 3u);
  EXPECT_EQ(built.diagnostics.warnings(), 1u);
}

TEST(GeometryFaces, FewFacesOfALargeCoordinateTakeOnlyTheirPoints) {
  MFVec3f many(1000);
  for (size_t i = 0; i < many.size(); i++) many[i] = {float(i), float(i * i % 7), 0};
  Faces node = faceSet(std::move(many), {998, 999, 997, -1});
  Mesh mesh = build(node).mesh;
  EXPECT_EQ(mesh.points.size(), 3u);
  EXPECT_EQ(boundsOf(mesh).minimum.x, 997);
}

TEST(GeometryFaces, TriangleLimitHolds) {
  Limits limits;
  limits.triangles = 3;
  Faces node = faceSet({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}, {});
  for (int i = 0; i < 10; i++) node->coordIndex.insert(node->coordIndex.end(), {0, 1, 2, -1});
  Built built = build(node, false, limits);
  EXPECT_EQ(built.mesh.indices.size(), 9u);
  ASSERT_EQ(built.diagnostics.warnings(), 1u);
  EXPECT_NE(built.diagnostics.list()[0].message.find("triangles"), std::string::npos);
}

TEST(GeometryFaces, SimpleOutlinesOf12000CornersAreDrawn) {
  const int n = 12000;
  MFVec3f star, comb;
  for (int i = 0; i < n; i++) {
    const double angle = 2 * std::numbers::pi * i / n, r = i % 2 ? 1 : 0.1;
    star.push_back({float(r * std::cos(angle)), float(r * std::sin(angle)), 0});
  }
  for (int i = 0; i < n; i++) { // long teeth on both sides, turned by 45 degrees
    const bool back = i >= n / 2;
    const float along = float(back ? n - 1 - i : i) / float(n / 2);
    const float across = back ? 1.5f + 0.4f * float(i % 2) : float(i % 2);
    comb.push_back({along - across, along + across, 0});
  }
  for (MFVec3f* outline : {&star, &comb}) {
    const double expected = std::abs(shoelace(*outline));
    Faces node = polygon(std::move(*outline), false);
    const Built built = build(node);
    EXPECT_EQ(built.diagnostics.warnings(), 0u);
    double area = 0;
    for (size_t t = 0; t < built.mesh.indices.size() / 3; t++)
      area += std::abs(areaVector(built.mesh, t)[2]);
    EXPECT_NEAR(area / expected, 1, 1e-3);
  }
}

TEST(GeometryFaces, FacesWithoutTheirEndsAreReported) {
  MFVec3f points;
  for (int i = 0; i < 9; i++) points.push_back({float(i % 3), float(i / 3), 0});
  MFInt32 joined; // eight triangles, of which none is ended by -1
  for (const int i : {0, 1, 3, 4})
    for (const int k : {i, i + 1, i + 4, i, i + 4, i + 3}) joined.push_back(k);
  Faces garbage = faceSet(points, joined);
  Built built = build(garbage);
  ASSERT_EQ(built.diagnostics.warnings(), 1u);
  EXPECT_NE(built.diagnostics.list()[0].message.find("is -1 missing between faces?"),
            std::string::npos);
  // A square with two holes, each joined to the outline by two edges, is as it should be.
  MFVec3f holes{{0, 0, 0}, {9, 0, 0}, {9, 9, 0}, {0, 9, 0}, {1, 1, 0}, {1, 2, 0},
                {2, 2, 0}, {2, 1, 0}, {4, 1, 0}, {4, 2, 0}, {5, 2, 0}, {5, 1, 0}};
  Faces outline = faceSet(holes, {0, 4, 5, 6, 7, 4, 0, 8, 9, 10, 11, 8, 0, 1, 2, 3});
  Built plain = build(outline);
  EXPECT_EQ(plain.diagnostics.warnings(), 0u);
}

TEST(GeometryFaces, AListWithoutEndsThatCrossesItselfIsReported) {
  const MFVec3f squares{{-3, -1, 0}, {-1, -1, 0}, {-1, 1, 0}, {-3, 1, 0},
                        {1, -1, 0},  {3, -1, 0},  {3, 1, 0},  {1, 1, 0}};
  for (const MFInt32& joined :
       {MFInt32{0, 1, 2, 0, 2, 3, 4, 5, 6, 4, 6, 7}, MFInt32{0, 1, 2, 3, 4, 5, 6, 7}}) {
    Faces garbage = faceSet(squares, joined);
    Built built = build(garbage);
    ASSERT_EQ(built.diagnostics.warnings(), 1u);
    EXPECT_NE(built.diagnostics.list()[0].message.find("is -1 missing between faces?"),
              std::string::npos);
  }
  // The last -1 may be missing; a bridge to a hole, and edges that touch, cross nothing.
  const MFVec3f outline{{0, 0, 0}, {9, 0, 0}, {9, 9, 0}, {4, 0, 0}, {0, 9, 0},
                        {1, 2, 0}, {1, 3, 0}, {2, 3, 0}, {2, 2, 0}};
  for (const MFInt32& simple :
       {MFInt32{0, 1, 2, 3, 4}, MFInt32{0, 3, 1, 2, 4}, MFInt32{0, 5, 6, 7, 8, 5, 0, 1, 2, 4}}) {
    Faces face = faceSet(outline, simple);
    Built built = build(face);
    EXPECT_EQ(built.diagnostics.warnings(), 0u);
  }
}

TEST(GeometryFaces, HopelesslyTangledFacesAreRefused) {
  MFVec3f star; // every edge crosses nearly all others
  const int n = 5001;
  for (int i = 0; i < n; i++) {
    double angle = 2 * std::numbers::pi * (double(i) * (n / 2) / n);
    star.push_back({float(std::cos(angle)), float(std::sin(angle)), 0});
  }
  Faces node = polygon(star, false);
  Built built = build(node);
  EXPECT_EQ(built.mesh.kind, Mesh::Kind::empty);
  ASSERT_EQ(built.diagnostics.warnings(), 1u);
  EXPECT_NE(built.diagnostics.list()[0].message.find("tangled"), std::string::npos);
  // So is one that a long edge cuts into very many pieces: each cut walks along what is left of it.
  MFVec3f zigzag;
  for (int i = 0; i < 60000; i++) zigzag.push_back({float(i), float(i * 7919 % 1000), 0});
  Faces comb = polygon(zigzag, false);
  Built cut = build(comb);
  EXPECT_EQ(cut.mesh.kind, Mesh::Kind::empty);
  ASSERT_EQ(cut.diagnostics.warnings(), 1u);
  EXPECT_NE(cut.diagnostics.list()[0].message.find("tangled"), std::string::npos);
  // A plain outline of as many points is drawn.
  MFVec3f wavy;
  for (int i = 0; i < n; i++) {
    double angle = 2 * std::numbers::pi * i / n, r = 1 + 0.1 * ((i % 2) ? 1 : -1);
    wavy.push_back({float(r * std::cos(angle)), float(r * std::sin(angle)), 0});
  }
  double expected = shoelace(wavy);
  Faces outline = polygon(std::move(wavy), false);
  EXPECT_NEAR(area(build(outline).mesh), expected, 1e-4);
}

TEST(GeometryFaces, FarFromTheOriginConcaveFacesAreStillRight) {
  MFVec3f shape = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {2, 1, 0}, {0, 4, 0}};
  for (Vec3f& p : shape) p = {p.x + 1e6f, p.y - 1e6f, 1e6f};
  Faces node = polygon(shape, false);
  Mesh mesh = build(node).mesh;
  EXPECT_NEAR(area(mesh), 10, 1e-6);
}

} // namespace
} // namespace xvrml::test
