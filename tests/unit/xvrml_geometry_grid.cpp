// xvrml_geometry_grid.cpp: Tests ElevationGrid (clause 6.17).
#include "unit/mesh_checks.h"

namespace xvrml::test {
namespace {

using Grid = Made<nodes::ElevationGrid>;

Grid grid(int columns, int rows, MFFloat height) {
  Grid node("ElevationGrid");
  node->xDimension = columns;
  node->zDimension = rows;
  node->height = std::move(height);
  return node;
}

TEST(GeometryGrid, IsFlatTowardsPlusY) {
  Grid node = grid(3, 2, MFFloat(6, 0.5f));
  node->xSpacing = 2;
  node->zSpacing = 3;
  Built built = build(node);
  expectSound(built.mesh);
  EXPECT_EQ(built.mesh.points.size(), 6u);
  EXPECT_NEAR(area(built.mesh), 4 * 3, 1e-6);
  for (size_t t = 0; t < built.mesh.indices.size() / 3; t++)
    EXPECT_GT(areaVector(built.mesh, t)[1], 0);
  EXPECT_EQ(built.mesh.points[5], (Vec3f{4, 0.5f, 3}));
}

// Grid and floor enclose the sum of the cells' heights, which shows that the surface is watertight
// and heights are ordered by x, then z.
TEST(GeometryGrid, HeightsRunAlongXFirst) {
  Grid node = grid(2, 3, {0, 1, 2, 3, 4, 5});
  Mesh mesh = build(node).mesh;
  for (const Vec3f& p : mesh.points) EXPECT_EQ(p.y, p.x + 2 * p.z);
}

TEST(GeometryGrid, ColoursAndNormalsByVertexOrQuadrilateral) {
  Grid node = grid(3, 2, MFFloat(6));
  node->color = color({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4, 0, 0}, {5, 0, 0}});
  Mesh mesh = build(node).mesh;
  for (size_t i = 0; i < 6; i++)
    EXPECT_EQ(mesh.colors[i].r, mesh.points[i].x + 3 * mesh.points[i].z);
  node->colorPerVertex = false;
  mesh = build(node).mesh;
  expectSound(mesh);
  EXPECT_EQ(mesh.points.size(), 8u);
  for (size_t t = 0; t < mesh.indices.size() / 3; t++)
    for (size_t e = 0; e < 3; e++) {
      double middle = (at(mesh, 3 * t)[0] + at(mesh, 3 * t + 1)[0] + at(mesh, 3 * t + 2)[0]) / 3;
      EXPECT_EQ(mesh.colors[mesh.indices[3 * t + e]].r, middle < 1 ? 0 : 1);
    }
  node->normal = normal({{1, 0, 0}, {0, 0, 1}});
  node->normalPerVertex = false;
  mesh = build(node).mesh;
  expectSound(mesh);
  for (size_t i = 0; i < mesh.points.size(); i++) EXPECT_EQ(mesh.normals[i].z, mesh.colors[i].r);
  node->normalPerVertex = true; // too few: the faces' own normals are used, with a warning
  Built built = build(node);
  expectSound(built.mesh);
  EXPECT_EQ(built.diagnostics.warnings(), 1u);
}

TEST(GeometryGrid, DefaultTextureCoversTheGrid) {
  Grid node = grid(3, 4, MFFloat(12));
  node->xSpacing = 0.1f;
  EXPECT_TRUE(build(node).mesh.texCoords.empty());
  Mesh mesh = build(node, true).mesh;
  for (size_t i = 0; i < mesh.points.size(); i++) {
    EXPECT_NEAR(mesh.texCoords[i].x, mesh.points[i].x / 0.2, 1e-5);
    EXPECT_NEAR(mesh.texCoords[i].y, mesh.points[i].z / 3, 1e-5);
  }
  node->texCoord = textureCoordinate(MFVec2f(12, {0.25f, 0.75f}));
  mesh = build(node, true).mesh;
  for (const Vec2f& st : mesh.texCoords) EXPECT_EQ(st, (Vec2f{0.25f, 0.75f}));
}

TEST(GeometryGrid, CreaseAngle) {
  Grid node = grid(3, 2, {0, 1, 0, 0, 1, 0}); // a roof: 90 degrees between its sides
  node->creaseAngle = 1.5f;
  Mesh sharp = build(node).mesh;
  expectSound(sharp);
  EXPECT_EQ(sharp.points.size(), 8u);
  node->creaseAngle = 1.6f;
  Mesh smooth = build(node).mesh;
  EXPECT_EQ(smooth.points.size(), 6u);
  for (size_t i = 0; i < 6; i++)
    if (smooth.points[i].x == 1) { EXPECT_NEAR(smooth.normals[i].y, 1, 1e-5); }
}

TEST(GeometryGrid, WrongSizes) {
  Grid shorter = grid(3, 3, MFFloat(7));
  Built built = build(shorter);
  expectSound(built.mesh);
  EXPECT_NEAR(area(built.mesh), 2, 1e-6) << "two whole rows are there";
  EXPECT_EQ(built.diagnostics.warnings(), 1u);
  Grid longer = grid(2, 2, MFFloat(99));
  EXPECT_EQ(build(longer).mesh.points.size(), 4u);
  for (auto [x, z] : {std::pair{INT32_MAX, INT32_MAX},
                      {INT32_MAX, 1},
                      {1, INT32_MAX},
                      {2, INT32_MAX},
                      {INT32_MAX, 2},
                      {-1, -1},
                      {-5, 3},
                      {0, 0},
                      {1, 1},
                      {INT32_MIN, INT32_MIN}}) {
    Grid node = grid(x, z, MFFloat(6));
    expectSound(build(node).mesh);
  }
  Grid huge = grid(2000, 2000, MFFloat(4000000));
  Limits limits;
  limits.triangles = 1000;
  built = build(huge, false, limits);
  EXPECT_EQ(built.mesh.kind, Mesh::Kind::empty);
  ASSERT_EQ(built.diagnostics.warnings(), 1u);
  EXPECT_NE(built.diagnostics.list()[0].message.find("limit 'triangles'"), std::string::npos);
  Grid wild = grid(3, 2, {0, NAN, 0, 0, 0, 0});
  EXPECT_EQ(build(wild).mesh.kind, Mesh::Kind::empty);
  wild = grid(4, 2, {0, 0, 0, INFINITY, 0, 0, 0, 0});
  built = build(wild);
  expectSound(built.mesh);
  EXPECT_NEAR(area(built.mesh), 2, 1e-6);
  wild->xSpacing = INFINITY;
  EXPECT_EQ(build(wild).mesh.kind, Mesh::Kind::empty);
}

} // namespace
} // namespace xvrml::test
