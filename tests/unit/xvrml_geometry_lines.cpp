// xvrml_geometry_lines.cpp: Tests IndexedLineSet and PointSet (clauses 6.24, 6.36).
#include "unit/mesh_checks.h"

namespace xvrml::test {
namespace {

using Lines = Made<nodes::IndexedLineSet>;

Lines lines(MFInt32 index) {
  Lines node("IndexedLineSet");
  node->coord = coordinate({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {0, 0, 0}});
  node->coordIndex = std::move(index);
  return node;
}

using Ends = std::vector<std::pair<float, float>>; // x, or red, of both ends of each segment
template <class F> Ends ends(const Mesh& mesh, F value) {
  Ends result;
  for (size_t i = 0; i + 1 < mesh.indices.size(); i += 2)
    result.push_back({value(mesh.indices[i]), value(mesh.indices[i + 1])});
  return result;
}
Ends places(const Mesh& mesh) {
  return ends(mesh, [&](uint32_t i) { return mesh.points[i].x; });
}
Ends reds(const Mesh& mesh) {
  return ends(mesh, [&](uint32_t i) { return mesh.colors[i].r; });
}

TEST(GeometryLines, PolylinesBecomeSegmentsInPlace) {
  Lines node = lines({0, 1, 2, -1, 3, 0});
  Built built = build(node);
  expectSound(built.mesh);
  EXPECT_EQ(built.mesh.kind, Mesh::Kind::lines);
  EXPECT_EQ(places(built.mesh), (Ends{{0, 1}, {1, 2}, {3, 0}}));
  EXPECT_EQ(built.mesh.points.data(), nodeCast<nodes::Coordinate>(node->coord)->point.data());
}

TEST(GeometryLines, ColoursByVertexOrPolylineAndIndex) {
  MFColor colors;
  for (int i = 0; i < 5; i++) colors.push_back({float(i), 0, 0});
  struct Case {
    bool perVertex;
    MFInt32 index;
    Ends expected;
  };
  const Case cases[] = {{true, {}, {{0, 1}, {1, 2}, {3, 0}}},
                        {true, {4, 3, 2, -1, 1, 0}, {{4, 3}, {3, 2}, {1, 0}}},
                        {false, {}, {{0, 0}, {0, 0}, {1, 1}}},
                        {false, {3, 2}, {{3, 3}, {3, 3}, {2, 2}}}};
  for (const Case& c : cases) {
    Lines node = lines({0, 1, 2, -1, 3, 0});
    node->color = color(colors);
    node->colorPerVertex = c.perVertex;
    node->colorIndex = c.index;
    Built built = build(node);
    expectSound(built.mesh);
    EXPECT_EQ(places(built.mesh), (Ends{{0, 1}, {1, 2}, {3, 0}}));
    EXPECT_EQ(reds(built.mesh), c.expected);
    EXPECT_EQ(built.diagnostics.warnings(), 0u);
  }
}

TEST(GeometryLines, WrongLinesAreDroppedWithOneWarning) {
  Lines node = lines({0, -1, 1, 1, -1, 0, 4, -1, 0, 9, -1, 0, -3, -1, -1, 0, 1, 1, 2, -1});
  Built built = build(node);
  expectSound(built.mesh);
  EXPECT_EQ(places(built.mesh), (Ends{{0, 1}, {1, 2}}));
  EXPECT_EQ(built.diagnostics.warnings(), 1u);
  node = lines({0, 1, -1});
  nodeCast<nodes::Coordinate>(node->coord)->point[1].x = NAN;
  EXPECT_EQ(build(node).mesh.kind, Mesh::Kind::empty);
  node = lines({0, 1, 2});
  node->color = color({{0.5f, 0, 0}, {NAN, 0, 0}});
  built = build(node);
  expectSound(built.mesh);
  EXPECT_EQ(reds(built.mesh), (Ends{{0.5f, 0}, {0, 1}})); // a missing colour is white
}

TEST(GeometryPoints, PointsAndColoursInPlace) {
  Made<nodes::PointSet> node("PointSet");
  EXPECT_EQ(build(node).mesh.kind, Mesh::Kind::empty);
  node->coord = coordinate({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}});
  node->color = color({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}});
  Built built = build(node);
  expectSound(built.mesh);
  EXPECT_EQ(built.mesh.kind, Mesh::Kind::points);
  EXPECT_EQ(built.mesh.indices.size(), 3u);
  EXPECT_EQ(built.mesh.colors[2].r, 2);
  EXPECT_EQ(built.diagnostics.warnings(), 0u);
}

TEST(GeometryPoints, MissingColoursAndWildPoints) {
  Made<nodes::PointSet> node("PointSet");
  node->coord = coordinate({{0, 0, 0}, {INFINITY, 0, 0}, {2, 0, 0}, {3, 0, 0}});
  node->color = color({{0, 0, 0}, {1, 0, 0}, {2, 0, NAN}});
  Built built = build(node);
  expectSound(built.mesh);
  EXPECT_EQ(built.mesh.points.size(), 3u);
  EXPECT_EQ(built.mesh.colors[2], (Color{1, 1, 1}));
  EXPECT_EQ(built.diagnostics.warnings(), 1u);
}

} // namespace
} // namespace xvrml::test
