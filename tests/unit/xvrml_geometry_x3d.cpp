// xvrml_geometry_x3d.cpp: Tests the sets of triangles, strips, fans and quadrilaterals of X3D,
// LineSet and the opacities of ColorRGBA (ISO/IEC 19775-1 clauses 11.4, 32.4).
#include <array>
#include <cmath>
#include <tuple>

#include "unit/mesh_checks.h"
#include "xvrml/world.h"

namespace xvrml::test {
namespace {

NodeRef colorRgba(MFColorRGBA values) {
  Made<nodes::ColorRGBA> node("ColorRGBA");
  node->color = std::move(values);
  return node;
}

// Two rows of three points, one above the other: columns at x = 0, 1, 2.
NodeRef ladder() {
  return coordinate({{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}, {2, 0, 0}, {2, 1, 0}});
}

double area(const Mesh& mesh) { // positive where the front faces +z
  double sum = 0;
  for (size_t t = 0; t < mesh.indices.size() / 3; t++) sum += areaVector(mesh, t)[2];
  return sum;
}
double leastArea(const Mesh& mesh) {
  double least = 1e300;
  for (size_t t = 0; t < mesh.indices.size() / 3; t++)
    least = std::min(least, areaVector(mesh, t)[2]);
  return least;
}

template <class T> Made<T> indexed(const char* type, NodeRef points, MFInt32 index) {
  Made<T> node(type);
  node->coord = std::move(points);
  node->index = std::move(index);
  return node;
}

TEST(GeometryX3d, TrianglesOfAnIndexShareTheirPoints) {
  auto node = indexed<nodes::IndexedTriangleSet>("IndexedTriangleSet", ladder(),
                                                 {0, 2, 1, 1, 2, 3, 4, 5}); // two are left over
  Built built = build(node);
  expectSound(built.mesh);
  EXPECT_EQ(built.mesh.kind, Mesh::Kind::triangles);
  EXPECT_EQ(built.mesh.points.size(), 4u);
  EXPECT_EQ(std::vector(built.mesh.indices.begin(), built.mesh.indices.end()),
            (std::vector<uint32_t>{0, 2, 1, 1, 2, 3}));
  EXPECT_EQ(built.diagnostics.list().size(), 0u);
}

// A large set takes a path of its own, on several threads; strips of one triangle each do not.
TEST(GeometryX3d, LargeTriangleSetsUseTheirArraysAndHaveTheNormalsOfStrips) {
  constexpr int side = 120;
  MFVec3f points;
  MFInt32 triangles, strips;
  for (int i = 0; i < side * side; i++) {
    const float x = float(i % side), y = float(i / side);
    points.push_back({x, y, 3 * std::sin(.3f * x) * std::cos(.2f * y)});
    if (i % side == side - 1 || i / side == side - 1) continue;
    for (const std::array<int, 3>& t :
         {std::array{i, i + 1, i + side}, {i + 1, i + side + 1, i + side}}) {
      triangles.insert(triangles.end(), t.begin(), t.end());
      strips.insert(strips.end(), {t[0], t[1], t[2], -1});
    }
  }
  const NodeRef coord = coordinate(points);
  auto set = indexed<nodes::IndexedTriangleSet>("IndexedTriangleSet", coord, triangles);
  auto strip = indexed<nodes::IndexedTriangleStripSet>("IndexedTriangleStripSet", coord, strips);
  const Built plain = build(set), welded = build(strip);
  EXPECT_TRUE(plain.mesh.plain);
  EXPECT_FALSE(welded.mesh.plain);
  EXPECT_EQ(plain.mesh.points.data(), static_cast<nodes::Coordinate&>(*coord).point.data());
  ASSERT_EQ(plain.mesh.indices.size(), welded.mesh.indices.size());
  size_t other = 0;
  for (size_t i = 0; i < plain.mesh.indices.size(); i++) {
    const uint32_t a = plain.mesh.indices[i], b = welded.mesh.indices[i];
    const Vec3f n = plain.mesh.normals[a], m = welded.mesh.normals[b];
    other += plain.mesh.points[a] != welded.mesh.points[b] ||
             std::hypot(n.x - m.x, n.y - m.y, n.z - m.z) > 1e-6f;
  }
  EXPECT_EQ(other, 0u);
  set->normalPerVertex = false;
  EXPECT_TRUE(build(set).mesh.normals.empty());
}

TEST(GeometryX3d, EverySecondTriangleOfAStripRunsTheOtherWay) {
  auto strip = indexed<nodes::IndexedTriangleStripSet>("IndexedTriangleStripSet", ladder(),
                                                       {1, 0, 3, 2, 5, 4, -1, 0, 2, 1, -1});
  Built built = build(strip);
  expectSound(built.mesh);
  EXPECT_EQ(built.mesh.indices.size(), 15u);
  EXPECT_NEAR(area(built.mesh), 2.5, 1e-6);
  EXPECT_NEAR(leastArea(built.mesh), 0.5, 1e-6);
}

TEST(GeometryX3d, TrianglesWithoutAreaJoinStripsSilently) {
  auto strip = indexed<nodes::IndexedTriangleStripSet>("IndexedTriangleStripSet", ladder(),
                                                       {1, 0, 3, 2, 2, 3, 3, 2, 5, 4});
  Built built = build(strip);
  EXPECT_NEAR(area(built.mesh), 2, 1e-6);
  EXPECT_NEAR(leastArea(built.mesh), 0.5, 1e-6);
  EXPECT_EQ(built.diagnostics.list().size(), 0u);
}

TEST(GeometryX3d, FansShareTheirFirstPoint) {
  auto fan = indexed<nodes::IndexedTriangleFanSet>("IndexedTriangleFanSet", ladder(),
                                                   {0, 2, 4, 5, 3, 1, -1, 0, 2});
  Built built = build(fan);
  expectSound(built.mesh);
  EXPECT_EQ(built.mesh.indices.size(), 9u) << "one of four has no area";
  EXPECT_NEAR(area(built.mesh), 2, 1e-6);
}

TEST(GeometryX3d, QuadrilateralsOfAnIndexAndInOrder) {
  auto node =
      indexed<nodes::IndexedQuadSet>("IndexedQuadSet", ladder(), {0, 2, 3, 1, 2, 4, 5, 3, 0, 1, 2});
  Built built = build(node);
  expectSound(built.mesh);
  EXPECT_EQ(built.mesh.indices.size(), 12u);
  EXPECT_NEAR(area(built.mesh), 2, 1e-6);
  Made<nodes::QuadSet> set("QuadSet");
  set->coord = coordinate({{0, 0, 0}, {3, 0, 0}, {3, 2, 0}, {0, 2, 0}, {9, 9, 9}});
  Built inOrder = build(set);
  expectSound(inOrder.mesh);
  EXPECT_NEAR(area(inOrder.mesh), 6, 1e-6);
}

TEST(GeometryX3d, CountsCutTheListIntoFansAndStrips) {
  Made<nodes::TriangleFanSet> fans("TriangleFanSet");
  fans->coord = coordinate(
      {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {5, 0, 0}, {6, 0, 0}, {5, 1, 0}, {9, 9, 9}});
  fans->fanCount = {4, 3};
  Built built = build(fans);
  expectSound(built.mesh);
  EXPECT_EQ(built.mesh.indices.size(), 9u);
  EXPECT_NEAR(area(built.mesh), 1.5, 1e-6);
  EXPECT_EQ(built.diagnostics.list().size(), 0u);
  Made<nodes::TriangleStripSet> strips("TriangleStripSet");
  strips->coord = coordinate({{0, 1, 0}, {0, 0, 0}, {1, 1, 0}, {1, 0, 0}});
  strips->stripCount = {4};
  EXPECT_NEAR(area(build(strips).mesh), 1, 1e-6);
}

TEST(GeometryX3d, CountsThatAreWrongOrTooLargeGiveOneWarning) {
  for (const MFInt32& counts :
       {MFInt32{3, 2'000'000'000, 2'000'000'000}, MFInt32{-5, 1, 3, INT32_MAX},
        MFInt32{INT32_MIN, 3}, MFInt32{2, 3, -1}}) {
    Made<nodes::TriangleFanSet> fans("TriangleFanSet");
    fans->coord =
        coordinate({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {7, 7, 7}});
    fans->fanCount = counts;
    Built built = build(fans);
    expectSound(built.mesh);
    EXPECT_EQ(built.diagnostics.warnings(), 1u);
    Made<nodes::TriangleStripSet> strips("TriangleStripSet");
    strips->coord = fans->coord;
    strips->stripCount = counts;
    Built other = build(strips);
    expectSound(other.mesh);
    EXPECT_EQ(other.diagnostics.warnings(), 1u);
    Made<nodes::LineSet> lines("LineSet");
    lines->coord = fans->coord;
    lines->vertexCount = counts;
    Built line = build(lines);
    expectSound(line.mesh);
    EXPECT_EQ(line.diagnostics.warnings(), 1u);
  }
}

TEST(GeometryX3d, IndicesWithoutAPointAndWildPointsLeaveTheirFacesOut) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const MFInt32 index{0, 1, 2, 0, INT32_MAX, 2, -7, 1, 2, 0, 1, 3, INT32_MIN, 0, 1};
  auto node = indexed<nodes::IndexedTriangleSet>(
      "IndexedTriangleSet", coordinate({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {nan, 0, 0}}), index);
  Built built = build(node, true);
  expectSound(built.mesh);
  EXPECT_EQ(built.mesh.indices.size(), 3u);
  EXPECT_EQ(built.diagnostics.warnings(), 1u);
  EXPECT_NE(built.diagnostics.list()[0].message.find("index[4] has no point"), std::string::npos)
      << built.diagnostics.list()[0].message;
  for (const char* type : {"IndexedTriangleFanSet", "IndexedTriangleStripSet", "IndexedQuadSet"}) {
    NodeRef other(findNodeType(type)->create(*findNodeType(type)));
    *static_cast<NodeRef*>(other->storage(*other->type().find("coord"))) = node->coord;
    *static_cast<MFInt32*>(other->storage(*other->type().find("index"))) = index;
    MeshOptions options;
    expectSound(buildMesh(*other, options));
  }
}

TEST(GeometryX3d, TheLimitOnTrianglesHolds) {
  Limits limits;
  limits.triangles = 2;
  auto node = indexed<nodes::IndexedTriangleStripSet>("IndexedTriangleStripSet", ladder(),
                                                      {1, 0, 3, 2, 5, 4});
  Built built = build(node, false, limits);
  EXPECT_EQ(built.mesh.indices.size(), 6u);
  EXPECT_EQ(built.diagnostics.warnings(), 1u);
}

// A roof of two squares at a right angle.
NodeRef roof() {
  return coordinate({{0, 0, 0}, {0, 0, 1}, {1, 1, 0}, {1, 1, 1}, {2, 0, 0}, {2, 0, 1}});
}

TEST(GeometryX3d, NormalsAreMeansOfTheFacesThatShareAPoint) {
  for (const bool perVertex : {true, false}) {
    auto node = indexed<nodes::IndexedQuadSet>("IndexedQuadSet", roof(), {0, 1, 3, 2, 2, 3, 5, 4});
    node->normalPerVertex = perVertex;
    Built built = build(node);
    expectSound(built.mesh);
    size_t upright = 0;
    for (const Vec3f& n : built.mesh.normals) upright += std::abs(n.y - 1) < 1e-6;
    EXPECT_EQ(upright, perVertex ? 2u : 0u);
  }
  Made<nodes::TriangleSet> flat("TriangleSet");
  flat->coord = coordinate({{0, 0, 0}, {0, 0, 1}, {1, 1, 0}});
  EXPECT_TRUE(build(flat).mesh.normals.empty()) << "faces share no points";
}

TEST(GeometryX3d, GivenNormalsColoursAndTextureCoordinatesBelongToPoints) {
  auto node = indexed<nodes::IndexedTriangleSet>("IndexedTriangleSet", ladder(), {2, 3, 1});
  node->colorPerVertex = false; // not used
  node->color = color({{0, 0, 0}, {.1f, 0, 0}, {.2f, 0, 0}, {.3f, 0, 0}});
  node->normal = normal({{0, 0, 1}, {0, 1, 0}, {1, 0, 0}, {0, 0, 5}});
  node->texCoord = textureCoordinate({{0, 0}, {.1f, 0}, {.2f, 0}, {.3f, 0}});
  Built built = build(node, true);
  expectSound(built.mesh);
  ASSERT_EQ(built.mesh.indices.size(), 3u);
  const float expected[] = {.2f, .3f, .1f};
  for (size_t i = 0; i < 3; i++) {
    EXPECT_EQ(built.mesh.colors[built.mesh.indices[i]].r, expected[i]);
    EXPECT_EQ(built.mesh.texCoords[built.mesh.indices[i]].x, expected[i]);
  }
  EXPECT_EQ(built.mesh.normals[built.mesh.indices[0]], (Vec3f{1, 0, 0}));
  EXPECT_EQ(built.diagnostics.list().size(), 0u) << "values of points that no face uses may lack";
  node->index = {4, 5, 3};
  EXPECT_EQ(build(node, true).diagnostics.warnings(), 1u);
}

TEST(GeometryX3d, DefaultTextureCoordinatesAreThoseOfAnIndexedFaceSet) {
  Made<nodes::QuadSet> set("QuadSet");
  set->coord = coordinate({{0, 0, 0}, {4, 0, 0}, {4, 2, 0}, {0, 2, 0}});
  Built built = build(set, true);
  ASSERT_EQ(built.mesh.texCoords.size(), 4u);
  EXPECT_EQ(built.mesh.texCoords[2], (Vec2f{1, .5f}));
}

TEST(GeometryX3d, LinesOfCounts) {
  Made<nodes::LineSet> lines("LineSet");
  lines->coord = coordinate({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {7, 0, 0}, {9, 0, 0}, {99, 0, 0}});
  lines->vertexCount = {3, 2};
  lines->color = colorRgba(
      {{0, 0, 0, 0}, {0, 0, 0, .5f}, {0, 0, 0, 1}, {1, 0, 0, 2}, {1, 1, 1, -1}, {1, 1, 1, 1}});
  Built built = build(lines);
  expectSound(built.mesh);
  EXPECT_EQ(built.mesh.kind, Mesh::Kind::lines);
  ASSERT_EQ(built.mesh.indices.size(), 6u);
  const float x[] = {0, 1, 1, 2, 7, 9}, alpha[] = {0, .5f, .5f, 1, 1, 0};
  ASSERT_EQ(built.mesh.alphas.size(), built.mesh.points.size());
  for (size_t i = 0; i < 6; i++) {
    EXPECT_EQ(built.mesh.points[built.mesh.indices[i]].x, x[i]);
    EXPECT_EQ(built.mesh.alphas[built.mesh.indices[i]], alpha[i]);
  }
  EXPECT_EQ(built.diagnostics.list().size(), 0u);
}

// Clause 11.4.12: counts are 2 or more. A smaller one in a file does what it does after an event.
TEST(GeometryX3d, CountsOfAFileStayAsTheyAre) {
  for (const auto& [node, field, counts, kept] :
       {std::tuple{"LineSet", "vertexCount", "1 2", MFInt32{1, 2}},
        {"LineSet", "vertexCount", "-7 0 2", MFInt32{-7, 0, 2}},
        {"TriangleFanSet", "fanCount", "2 3", MFInt32{2, 3}},
        {"TriangleStripSet", "stripCount", "1 3", MFInt32{1, 3}}}) {
    SCOPED_TRACE(testing::Message() << node << " " << counts);
    const auto world = loadWorldFromMemory(
        std::string("#X3D V3.3 utf8\nPROFILE Full\nShape { geometry DEF G ") + node + " { " +
            field + " [ " + counts +
            " ] coord Coordinate { point [ 0 0 0, 1 0 0, 2 1 0, 7 8 0, 9 0 0 ] } } }",
        "counts.x3dv");
    EXPECT_EQ(world->diagnostics.list().size(), 0u);
    Node& geometry = *world->scope.names.at("G");
    EXPECT_EQ(*static_cast<MFInt32*>(geometry.storage(*geometry.type().find(field))), kept);
    MeshOptions options;
    options.diagnostics = &world->diagnostics;
    expectSound(buildMesh(geometry, options));
    EXPECT_EQ(world->diagnostics.warnings(), 1u);
  }
}

TEST(GeometryX3d, OpacitiesFollowTheirColours) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const MFColorRGBA values{{.1f, 0, 0, .1f}, {.2f, 0, 0, .2f}, {.3f, 0, 0, .3f}, {nan, 0, 0, nan}};
  const auto check = [&](const Mesh& mesh) {
    expectSound(mesh);
    ASSERT_EQ(mesh.alphas.size(), mesh.points.size());
    for (size_t i = 0; i < mesh.points.size(); i++)
      EXPECT_EQ(mesh.alphas[i], mesh.colors[i].r == 0 ? 1 : mesh.colors[i].r) << i;
  };
  const MFVec3f square{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  for (const bool perVertex : {true, false})
    for (const MFInt32& colorIndex : {MFInt32{}, MFInt32{2, 1, 0, -1, 1, 2, 0, -1}}) {
      Made<nodes::IndexedFaceSet> faces("IndexedFaceSet");
      faces->coord = coordinate(square);
      faces->coordIndex = {0, 1, 2, -1, 0, 2, 3, -1};
      faces->color = colorRgba(values);
      faces->colorPerVertex = perVertex;
      faces->colorIndex = colorIndex;
      check(build(faces).mesh);
      Made<nodes::IndexedLineSet> lines("IndexedLineSet");
      lines->coord = coordinate(square);
      lines->coordIndex = faces->coordIndex;
      lines->color = faces->color;
      lines->colorPerVertex = perVertex;
      lines->colorIndex = colorIndex;
      check(build(lines).mesh);
    }
  Made<nodes::PointSet> points("PointSet");
  points->coord = coordinate({{0, 0, 0}, {nan, 0, 0}, {1, 1, 0}});
  points->color = colorRgba(values);
  check(build(points).mesh);
  points->coord = coordinate(square);
  check(build(points).mesh);
  Made<nodes::ElevationGrid> grid("ElevationGrid");
  grid->xDimension = grid->zDimension = 2;
  grid->height = {0, 1, 0, 1};
  grid->color = colorRgba(values);
  check(build(grid).mesh);
}

TEST(GeometryX3d, OpacitiesAreMixedWhereAFaceCrossesItself) {
  Made<nodes::IndexedFaceSet> faces("IndexedFaceSet");
  faces->coord = coordinate({{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}});
  faces->coordIndex = {0, 1, 2, 3};
  faces->convex = false;
  faces->color = colorRgba({{0, 0, 0, 0}, {0, 0, 0, 1}, {0, 0, 0, 0}, {0, 0, 0, 1}});
  Built built = build(faces);
  expectSound(built.mesh);
  ASSERT_EQ(built.mesh.alphas.size(), built.mesh.points.size());
  for (size_t i = 0; i < built.mesh.points.size(); i++)
    if (built.mesh.points[i].x == .5f) { EXPECT_NEAR(built.mesh.alphas[i], .5, 1e-6); }
}

} // namespace
} // namespace xvrml::test
