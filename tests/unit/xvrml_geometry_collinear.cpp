// xvrml_geometry_collinear.cpp: Tests concave faces with collinear corners. Every corner is a
// vertex of the triangles on all its sides, with its own colour, normal and texture coordinate. No
// edge runs past a vertex (a T-junction).
#include <random>

#include "unit/mesh_checks.h"

namespace xvrml::test {
namespace {

using Faces = Made<nodes::IndexedFaceSet>;

// An H of unit bars: the four corners of its crossbar lie on the sides of the uprights.
const MFVec3f letterH = {{0, 0, 0}, {1, 0, 0}, {1, 1.2f, 0}, {2, 1.2f, 0}, {2, 0, 0}, {3, 0, 0},
                         {3, 3, 0}, {2, 3, 0}, {2, 1.8f, 0}, {1, 1.8f, 0}, {1, 3, 0}, {0, 3, 0}};

// A comb with teeth of equal height, whose ends and gaps lie on two lines.
MFVec3f comb(int teeth) {
  MFVec3f points{{0, -1, 0}, {float(2 * teeth), -1, 0}};
  for (int i = teeth; i-- > 0;) {
    const auto x = float(2 * i);
    for (const Vec3f& p :
         {Vec3f{x + 2, 0, 0}, Vec3f{x + 1, 0, 0}, Vec3f{x + 1, 1, 0}, Vec3f{x, 1, 0}})
      points.push_back(p);
  }
  return points;
}

// Rotates the points by an angle and about an axis that rounding does not keep collinear.
MFVec3f turned(MFVec3f points, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  for (Vec3f& p : points)
    p = {float(c * p.x - s * p.y), float(s * p.x + c * p.y), float(0.3 * p.x - 0.2 * p.y)};
  return points;
}

Faces face(const MFVec3f& points) {
  Faces node("IndexedFaceSet");
  MFInt32 index;
  MFColor colors;
  MFVec2f places;
  MFVec3f normals;
  for (size_t i = 0; i < points.size(); ++i) {
    index.push_back(int32_t(i));
    colors.push_back({float(i), 0, 0});
    places.push_back({float(i), 1});
    const double a = 0.01 * double(i);
    normals.push_back({float(std::sin(a)), 0, float(std::cos(a))});
  }
  node->coord = coordinate(points);
  node->color = color(colors);
  node->texCoord = textureCoordinate(places);
  node->normal = normal(normals);
  node->coordIndex = index;
  node->convex = node->solid = false;
  return node;
}

double length(const D3& v) { return std::sqrt(dotProduct(v, v)); }

// Returns the number of vertices inside an edge of a triangle, less than 1e-4 off.
size_t junctions(const Mesh& mesh) {
  size_t found = 0;
  for (size_t corner = 0; corner < mesh.indices.size(); ++corner) {
    const D3 a = at(mesh, corner),
             along = minus(at(mesh, corner % 3 == 2 ? corner - 2 : corner + 1), a);
    for (const Vec3f& point : mesh.points) {
      const D3 to = minus({point.x, point.y, point.z}, a);
      const double t = dotProduct(to, along) / dotProduct(along, along);
      found += t > 1e-3 && t < 1 - 1e-3 && length(crossProduct(to, along)) < 1e-4 * length(along);
    }
  }
  return found;
}

void expectWhole(const MFVec3f& points, double expectedArea) {
  Faces node = face(points);
  const Built built = build(node, true);
  const Mesh& mesh = built.mesh;
  expectSound(mesh);
  EXPECT_EQ(junctions(mesh), 0u);
  EXPECT_NEAR(area(mesh), expectedArea, 1e-5 * expectedArea);
  EXPECT_EQ(mesh.indices.size() / 3,
            points.size() - 2); // every triangulation of a polygon has this many triangles
  std::vector<bool> used(points.size());
  for (const uint32_t vertex : mesh.indices) {
    const auto number = size_t(mesh.colors[vertex].r);
    ASSERT_LT(number, points.size());
    used[number] = true;
    EXPECT_EQ(mesh.points[vertex], points[number]);
    EXPECT_EQ(mesh.texCoords[vertex].x, float(number));
    EXPECT_NEAR(mesh.normals[vertex].x, std::sin(0.01 * double(number)), 1e-6);
  }
  EXPECT_EQ(std::count(used.begin(), used.end(), true), std::ptrdiff_t(points.size()));
}

TEST(GeometryCollinear, AnHKeepsTheCornersOfItsBar) { expectWhole(letterH, 3 + 3 + 0.6); }

TEST(GeometryCollinear, HoweverItIsTurned) {
  for (int i = 1; i < 40; ++i) {
    SCOPED_TRACE(i);
    // Ratio of the tilted plane's area to its projection's.
    const double stretch = std::sqrt(1 + 0.3 * 0.3 + 0.2 * 0.2);
    expectWhole(turned(letterH, i * 0.157), 6.6 * stretch);
  }
}

TEST(GeometryCollinear, ACombKeepsAllItsTeeth) {
  for (const int teeth : {2, 3, 10, 100}) {
    SCOPED_TRACE(teeth);
    expectWhole(comb(teeth), 3.0 * teeth);
    expectWhole(turned(comb(teeth), 0.4), 3.0 * teeth * std::sqrt(1 + 0.3 * 0.3 + 0.2 * 0.2));
  }
}

// Random staircases with extra corners on their edges.
TEST(GeometryCollinear, RandomCornersOnEdgesAreKept) {
  std::mt19937 random(7);
  for (int round = 0; round < 200; ++round) {
    SCOPED_TRACE(round);
    MFVec3f points{{0, 0, 0}};
    const int steps = 1 + int(random() % 5);
    const auto to = [&](float x, float y) {
      const Vec3f from = points.back();
      const int extra = int(random() % 4);
      for (int i = 1; i <= extra; ++i) {
        const float t = float(i) / float(extra + 1);
        points.push_back({from.x + t * (x - from.x), from.y + t * (y - from.y), 0});
      }
      points.push_back({x, y, 0});
    };
    to(float(steps), 0);
    for (int i = steps; i > 0; --i) {
      to(float(i), float(steps - i + 1));
      if (i > 1) to(float(i - 1), float(steps - i + 1));
    }
    to(0, float(steps));
    points.pop_back(); // the point was there already
    points.push_back({0, float(steps), 0});
    points.erase(std::unique(points.begin(), points.end()), points.end());
    double expected = 0;
    for (int i = 1; i <= steps; ++i) expected += steps - i + 1;
    expectWhole(points, expected);
  }
}

} // namespace
} // namespace xvrml::test
