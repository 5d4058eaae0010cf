// xvrml_geometry_attributes.cpp: Tests IndexedFaceSet's colours, normals and texture coordinates,
// for every combination of the flags and index lists of clause 6.23.
#include "unit/mesh_checks.h"

namespace xvrml::test {
namespace {

using Faces = Made<nodes::IndexedFaceSet>;

// Two squares side by side with six points:
//   3 4 5
//   0 1 2
Faces twoSquares() {
  Faces node("IndexedFaceSet");
  node->coord = coordinate({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}, {1, 1, 0}, {2, 1, 0}});
  node->coordIndex = {0, 1, 4, 3, -1, 1, 2, 5, 4, -1};
  return node;
}

// The value that each corner of the two squares should have: corner k of face f.
using Corners = std::vector<float>;

// Returns the mesh's value at each corner of each face. Values are identified by their first
// component.
template <class Values> Corners shown(const Mesh& mesh, Values valueOf) {
  Corners result;
  const D3 wanted[2][4] = {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},
                           {{1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}}};
  for (auto& face : wanted)
    for (const D3& place : face) {
      float value = -1;
      for (size_t i = 0; i < mesh.indices.size(); i++) {
        size_t triangle = i / 3; // the next triangle of this face
        double x = (at(mesh, 3 * triangle)[0] + at(mesh, 3 * triangle + 1)[0] +
                    at(mesh, 3 * triangle + 2)[0]) /
                   3;
        if ((x < 1) == (&face == &wanted[0]) && at(mesh, i) == place)
          value = valueOf(mesh.indices[i]);
      }
      result.push_back(value);
    }
  return result;
}
Corners reds(const Mesh& mesh) {
  return shown(mesh, [&](uint32_t i) { return mesh.colors[i].r; });
}
Corners tilts(const Mesh& mesh) {
  return shown(mesh, [&](uint32_t i) { return std::round(mesh.normals[i].x * 100); });
}

MFColor numbered(int n) {
  MFColor colors;
  for (int i = 0; i < n; i++) colors.push_back({float(i), 0, 0});
  return colors;
}
MFVec3f tilted(int n) { // unit normals whose first component times 100 identifies them
  MFVec3f normals;
  for (int i = 0; i < n; i++)
    normals.push_back({float(i) / 100, 0, std::sqrt(1 - float(i * i) / 10000)});
  return normals;
}

struct Case {
  bool perVertex;
  MFInt32 index;
  int values;
  Corners expected;
  size_t vertices;
};

const Case cases[] = {
    {true, {}, 6, {0, 1, 4, 3, 1, 2, 5, 4}, 6}, // coordIndex selects the values
    {true,
     {5, 4, 3, 2, -1, 4, 1, 0, 3, -1},
     6,
     {5, 4, 3, 2, 4, 1, 0, 3},
     6}, // their own index, with equal values where points are shared
    {true,
     {0, 1, 2, 3, -1, 4, 5, 6, 7, -1},
     8,
     {0, 1, 2, 3, 4, 5, 6, 7},
     8}, // different values there: two points are duplicated
    {false, {}, 2, {0, 0, 0, 0, 1, 1, 1, 1}, 8},     // one per face, in order
    {false, {3, 2}, 4, {3, 3, 3, 3, 2, 2, 2, 2}, 8}, // one per face, by index
    {false, {3, 3}, 4, {3, 3, 3, 3, 3, 3, 3, 3}, 6},
};

TEST(GeometryAttributes, ColoursByVertexOrFaceAndIndex) {
  for (const Case& c : cases)
    for (bool crease : {false, true}) {
      Faces node = twoSquares();
      node->color = color(numbered(c.values));
      node->colorPerVertex = c.perVertex;
      node->colorIndex = c.index;
      node->creaseAngle = crease ? 1.0f : 0.0f;
      Built built = build(node);
      expectSound(built.mesh);
      EXPECT_EQ(built.diagnostics.warnings(), 0u);
      EXPECT_EQ(reds(built.mesh), c.expected);
      EXPECT_EQ(built.mesh.points.size(), c.vertices);
      EXPECT_EQ(built.mesh.normals.empty(), !crease);
    }
}

TEST(GeometryAttributes, NormalsByVertexOrFaceAndIndex) {
  for (const Case& c : cases) {
    Faces node = twoSquares();
    node->normal = normal(tilted(c.values));
    node->normalPerVertex = c.perVertex;
    node->normalIndex = c.index;
    Built built = build(node);
    expectSound(built.mesh);
    EXPECT_EQ(built.diagnostics.warnings(), 0u);
    EXPECT_EQ(tilts(built.mesh), c.expected);
    EXPECT_EQ(built.mesh.points.size(), c.vertices);
  }
}

TEST(GeometryAttributes, AllThreeTogether) {
  for (const Case& colors : cases)
    for (const Case& normals : cases)
      for (bool ownTexture : {false, true}) {
        Faces node = twoSquares();
        node->color = color(numbered(colors.values));
        node->colorPerVertex = colors.perVertex;
        node->colorIndex = colors.index;
        node->normal = normal(tilted(normals.values));
        node->normalPerVertex = normals.perVertex;
        node->normalIndex = normals.index;
        node->texCoord = textureCoordinate({{0, 0}, {1, 0}, {2, 0}, {3, 0}, {4, 0}, {5, 0}});
        if (ownTexture) node->texCoordIndex = {0, 1, 2, 3, -1, 4, 5, 0, 1, -1};
        Mesh mesh = build(node).mesh;
        expectSound(mesh);
        EXPECT_EQ(reds(mesh), colors.expected);
        EXPECT_EQ(tilts(mesh), normals.expected);
        Corners s = shown(mesh, [&](uint32_t i) { return mesh.texCoords[i].x; });
        EXPECT_EQ(s, ownTexture ? (Corners{0, 1, 2, 3, 4, 5, 0, 1})
                                : (Corners{0, 1, 4, 3, 1, 2, 5, 4}));
      }
}

TEST(GeometryAttributes, ValuesBesideThePointsAreUsedInPlace) {
  Faces node = twoSquares();
  node->color = color(numbered(6));
  node->normal = normal(tilted(6));
  node->texCoord = textureCoordinate(MFVec2f(6));
  Mesh mesh = build(node).mesh;
  EXPECT_EQ(mesh.points.data(), nodeCast<nodes::Coordinate>(node->coord)->point.data());
  EXPECT_EQ(mesh.colors.data(), nodeCast<nodes::Color>(node->color)->color.data());
  EXPECT_EQ(mesh.normals.data(), nodeCast<nodes::Normal>(node->normal)->vector.data());
  EXPECT_EQ(mesh.texCoords.data(),
            nodeCast<nodes::TextureCoordinate>(node->texCoord)->point.data());
}

TEST(GeometryAttributes, MissingColoursAreWhite) {
  Faces node = twoSquares();
  node->color = color({{0.5f, 0, 0}, {0.25f, 0, 0}});
  Built built = build(node);
  expectSound(built.mesh);
  EXPECT_EQ(reds(built.mesh), (Corners{0.5f, 0.25f, 1, 1, 0.25f, 1, 1, 1}));
  EXPECT_EQ(built.diagnostics.warnings(), 1u);
  node->colorPerVertex = false;
  node->colorIndex = {1, 99};
  built = build(node);
  EXPECT_EQ(reds(built.mesh), (Corners{0.25f, 0.25f, 0.25f, 0.25f, 1, 1, 1, 1}));
  node->colorIndex = {-5};
  EXPECT_EQ(reds(build(node).mesh), (Corners(8, 1)));
  node->color = color({}); // an empty Color node counts as none
  EXPECT_TRUE(build(node).mesh.colors.empty());
}

TEST(GeometryAttributes, FaceNumbersCountDroppedFacesToo) {
  Faces node = twoSquares();
  node->coordIndex = {0, 1, 4, 3, -1, 0, 77, 1, -1, 1, 2, 5, 4, -1};
  node->color = color(numbered(3));
  node->colorPerVertex = false;
  EXPECT_EQ(reds(build(node).mesh), (Corners{0, 0, 0, 0, 2, 2, 2, 2}));
}

TEST(GeometryAttributes, UselessNormalsBecomeTheFaces) {
  for (Vec3f bad : {Vec3f{0, 0, 0}, Vec3f{NAN, 0, 0}, Vec3f{INFINITY, 0, 0}})
    for (bool perVertex : {true, false})
      for (bool ccw : {true, false}) {
        Faces node = twoSquares();
        MFVec3f vectors = tilted(6);
        vectors[1] = bad;
        node->normal = normal(vectors);
        node->normalPerVertex = perVertex;
        node->ccw = ccw;
        Built built = build(node);
        expectSound(built.mesh);
        EXPECT_EQ(built.diagnostics.warnings(), 1u);
        Corners expected = perVertex ? Corners{0, 0, 4, 3, 0, 2, 5, 4} : Corners(8, 0);
        EXPECT_EQ(tilts(built.mesh), expected);
        for (size_t i = 0; i < built.mesh.points.size(); i++)
          if (built.mesh.points[i] == Vec3f{1, 0, 0} && perVertex) {
            EXPECT_EQ(built.mesh.normals[i].z, ccw ? 1 : -1);
          }
      }
  Faces few = twoSquares(); // fewer normals than points
  few->normal = normal(tilted(2));
  Built built = build(few);
  expectSound(built.mesh);
  EXPECT_EQ(tilts(built.mesh), (Corners{0, 1, 0, 0, 1, 0, 0, 0}));
}

TEST(GeometryAttributes, NormalsOfAnyLengthBecomeUnit) {
  Faces node = twoSquares();
  node->normal = normal(MFVec3f(6, {0, 0, 1e-20f}));
  expectSound(build(node).mesh);
  node->normal = normal(MFVec3f(6, {0, 3e38f, 3e38f}));
  expectSound(build(node).mesh);
}

// Default mapping (clause 6.23): S along the longest side, T along the second longest; ties in the
// order X, Y, Z.
TEST(GeometryAttributes, DefaultTextureMapping) {
  struct Expected {
    Vec3f size;
    int s, t;
  };
  const Expected table[] = {
      {{4, 2, 1}, 0, 1}, {{4, 1, 2}, 0, 2}, {{2, 4, 1}, 1, 0}, {{1, 4, 2}, 1, 2}, {{2, 1, 4}, 2, 0},
      {{1, 2, 4}, 2, 1}, {{4, 4, 1}, 0, 1}, {{4, 1, 4}, 0, 2}, {{1, 4, 4}, 1, 2}, {{4, 4, 4}, 0, 1},
      {{4, 2, 2}, 0, 1}, {{2, 4, 2}, 1, 0}, {{2, 2, 4}, 2, 0}};
  for (const Expected& e : table) {
    const float size[3] = {e.size.x, e.size.y, e.size.z};
    // The far corner 7 and its neighbours span the box from (10, 20, 30).
    Faces node("IndexedFaceSet");
    MFVec3f points;
    for (int i = 0; i < 8; i++)
      points.push_back(
          {10 + (i & 1 ? size[0] : 0), 20 + (i & 2 ? size[1] : 0), 30 + (i & 4 ? size[2] : 0)});
    points.push_back({-99, 99, 99}); // unused by any face
    node->coord = coordinate(points);
    node->coordIndex = {0, 3, 5, -1, 6, 5, 3, -1, 7, 1, 2, -1, 4, 2, 1};
    EXPECT_TRUE(build(node, false).mesh.texCoords.empty());
    for (float crease : {0.f, 1.f}) {
      node->creaseAngle = crease;
      Mesh mesh = build(node, true).mesh;
      expectSound(mesh);
      for (uint32_t i : mesh.indices) {
        const float place[3] = {mesh.points[i].x - 10, mesh.points[i].y - 20,
                                mesh.points[i].z - 30};
        EXPECT_NEAR(mesh.texCoords[i].x, place[e.s] / size[e.s], 1e-5);
        EXPECT_NEAR(mesh.texCoords[i].y, place[e.t] / size[e.s],
                    1e-5); // same scale in both directions
      }
    }
  }
}

} // namespace
} // namespace xvrml::test
