// xvrml_geometry_2d.cpp: Tests the planar geometry of X3D (ISO/IEC 19775-1 clause 14): numbers of
// segments, areas of the inscribed polygons, the side that they face, and values out of range.
#include "unit/mesh_checks.h"

namespace xvrml::test {
namespace {

constexpr double pi = std::numbers::pi;

double area(const Mesh& mesh) {
  double sum = 0;
  for (size_t t = 0; t < mesh.indices.size() / 3; t++) {
    const double part = areaVector(mesh, t)[2];
    EXPECT_GT(part, 0) << "the front faces +z";
    sum += part;
  }
  return sum;
}
// Returns the area of a slice of a regular polygon, whose segments take these angles.
double slice(double radius, int segments, double angle) {
  return segments * radius * radius * std::sin(angle / segments) / 2;
}
double length(const Mesh& mesh) {
  double sum = 0;
  for (size_t i = 0; i + 1 < mesh.indices.size(); i += 2) {
    const D3 d = minus(at(mesh, i + 1), at(mesh, i));
    sum += std::sqrt(dotProduct(d, d));
  }
  return sum;
}

TEST(Geometry2d, ArcsRunCounterClockwise) {
  struct Case {
    float start, end;
    size_t segments;
    double sweep;
  };
  const Case cases[] = {{0, float(pi / 2), 16, pi / 2},
                        {float(pi / 2), 0, 48, 1.5 * pi},
                        {-float(pi / 2), float(pi / 2), 32, pi},
                        {1, 1.01f, 1, 0.01},
                        {1, 1, 64, 2 * pi},
                        {0, float(2 * pi), 64, 2 * pi},
                        {float(2 * pi), -float(2 * pi), 64, 2 * pi}};
  for (const Case& c : cases) {
    Made<nodes::Arc2D> arc("Arc2D");
    arc->radius = 3;
    arc->startAngle = c.start;
    arc->endAngle = c.end;
    Built built = build(arc);
    expectSound(built.mesh);
    EXPECT_EQ(built.mesh.kind, Mesh::Kind::lines);
    EXPECT_EQ(built.mesh.indices.size(), 2 * c.segments);
    const double part = c.sweep / double(c.segments);
    EXPECT_NEAR(length(built.mesh), 6 * double(c.segments) * std::sin(part / 2), 1e-4);
    EXPECT_NEAR(at(built.mesh, 0)[0], 3 * std::cos(c.segments == 64 ? 0 : c.start), 1e-6);
    EXPECT_NEAR(at(built.mesh, 0)[1], 3 * std::sin(c.segments == 64 ? 0 : c.start), 1e-6);
    EXPECT_EQ(built.diagnostics.list().size(), 0u);
  }
}

TEST(Geometry2d, SlicesAndChordsHaveTheirAreas) {
  for (const double sweep : {0.5 * pi, 1.5 * pi}) {
    Made<nodes::ArcClose2D> arc("ArcClose2D");
    arc->radius = 2;
    arc->startAngle = 0.25f;
    arc->endAngle = float(0.25 + sweep);
    const int segments = int(std::lround(sweep / (2 * pi) * 64));
    Built pie = build(arc, true);
    expectSound(pie.mesh);
    EXPECT_NEAR(area(pie.mesh), slice(2, segments, sweep), 1e-5);
    EXPECT_NEAR(area(pie.mesh), 2 * sweep, 2 * sweep * 0.0017) << "the facets' error";
    arc->closureType = "CHORD";
    Built chord = build(arc, true);
    expectSound(chord.mesh);
    EXPECT_NEAR(area(chord.mesh), slice(2, segments, sweep) - 2 * std::sin(sweep), 1e-5);
  }
  Made<nodes::ArcClose2D> whole("ArcClose2D");
  whole->endAngle = 0;
  for (const char* closure : {"PIE", "CHORD"}) {
    whole->closureType = closure;
    EXPECT_NEAR(area(build(whole).mesh), slice(1, 64, 2 * pi), 1e-5);
  }
  whole->closureType = "pie";
  EXPECT_EQ(build(whole).diagnostics.warnings(), 1u);
}

TEST(Geometry2d, DisksRingsAndCircles) {
  Made<nodes::Disk2D> disk("Disk2D");
  disk->outerRadius = 2;
  Built built = build(disk, true);
  expectSound(built.mesh);
  EXPECT_FALSE(built.mesh.solid);
  EXPECT_EQ(built.mesh.indices.size(), 3u * 64);
  EXPECT_NEAR(area(built.mesh), slice(2, 64, 2 * pi), 1e-5);
  EXPECT_EQ(built.mesh.texCoords[0], (Vec2f{.5f, .5f}));
  disk->innerRadius = 1;
  disk->solid = true;
  Built ring = build(disk, true);
  expectSound(ring.mesh);
  EXPECT_TRUE(ring.mesh.solid);
  EXPECT_EQ(ring.mesh.indices.size(), 6u * 64);
  EXPECT_NEAR(area(ring.mesh), slice(2, 64, 2 * pi) - slice(1, 64, 2 * pi), 1e-5);
  for (size_t i = 0; i < ring.mesh.points.size(); i++) { // the square around the disk
    EXPECT_NEAR(ring.mesh.texCoords[i].x, .5 + ring.mesh.points[i].x / 4, 1e-6);
    EXPECT_NEAR(ring.mesh.texCoords[i].y, .5 + ring.mesh.points[i].y / 4, 1e-6);
  }
  disk->innerRadius = 2;
  Built line = build(disk);
  Made<nodes::Circle2D> circle("Circle2D");
  circle->radius = 2;
  Built same = build(circle);
  expectSound(line.mesh);
  EXPECT_EQ(line.mesh.kind, Mesh::Kind::lines);
  EXPECT_EQ(line.mesh.indices.size(), 128u);
  EXPECT_TRUE(std::equal(line.mesh.points.begin(), line.mesh.points.end(), same.mesh.points.begin(),
                         same.mesh.points.end()));
}

TEST(Geometry2d, RectanglesAndTriangles) {
  Made<nodes::Rectangle2D> rectangle("Rectangle2D");
  rectangle->size = {3, 5};
  Built built = build(rectangle, true);
  expectSound(built.mesh);
  EXPECT_NEAR(area(built.mesh), 15, 1e-5);
  EXPECT_EQ(built.mesh.points[0], (Vec3f{-1.5f, -2.5f, 0}));
  EXPECT_EQ(built.mesh.texCoords[0], (Vec2f{0, 0}));
  EXPECT_EQ(built.mesh.texCoords[2], (Vec2f{1, 1}));
  Made<nodes::TriangleSet2D> set("TriangleSet2D");
  set->vertices = {{0, 0},  {2, 0}, {0, 2}, {0, 0}, {0, -2},
                   {-2, 0}, {0, 0}, {0, 1}, {1, 0}, {7, 7}};
  Built triangles = build(set, true);
  expectSound(triangles.mesh);
  EXPECT_EQ(triangles.mesh.indices.size(), 9u);
  EXPECT_NEAR(area(triangles.mesh), 4.5, 1e-5) << "all face +z, whichever way they run";
  EXPECT_EQ(triangles.mesh.texCoords[1], (Vec2f{1, .5f}));
  EXPECT_EQ(triangles.diagnostics.list().size(), 0u);
}

TEST(Geometry2d, LinesAndPoints) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  Made<nodes::Polyline2D> line("Polyline2D");
  line->lineSegments = {{0, 0}, {1, 0}, {1, 0}, {1, 2}};
  Built built = build(line);
  expectSound(built.mesh);
  EXPECT_EQ(built.mesh.indices.size(), 4u);
  EXPECT_NEAR(length(built.mesh), 3, 1e-6);
  EXPECT_EQ(built.diagnostics.list().size(), 0u);
  line->lineSegments = {{0, 0}, {1, 0}, {nan, 0}, {5, 0}, {6, 0}};
  Built broken = build(line);
  expectSound(broken.mesh);
  EXPECT_NEAR(length(broken.mesh), 2, 1e-6) << "no line over the gap";
  EXPECT_EQ(broken.diagnostics.warnings(), 1u);
  Made<nodes::Polypoint2D> points("Polypoint2D");
  points->point = {{1, 2}, {nan, 0}, {3, 4}};
  Built dots = build(points);
  expectSound(dots.mesh);
  EXPECT_EQ(dots.mesh.kind, Mesh::Kind::points);
  EXPECT_EQ(dots.mesh.points[1], (Vec3f{3, 4, 0}));
  EXPECT_EQ(dots.diagnostics.warnings(), 1u);
}

TEST(Geometry2d, SizesOutOfRangeDrawNothingAndWarnOnce) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), infinite = INFINITY;
  const auto expectNothing = [](auto& node) {
    Built built = build(node, true);
    EXPECT_EQ(built.mesh.kind, Mesh::Kind::empty);
    EXPECT_EQ(built.diagnostics.warnings(), 1u);
  };
  for (const float bad : {nan, infinite, -1.0f, 0.0f}) {
    Made<nodes::Arc2D> arc("Arc2D");
    arc->radius = bad;
    expectNothing(arc);
    Made<nodes::ArcClose2D> slice("ArcClose2D");
    slice->radius = bad;
    expectNothing(slice);
    Made<nodes::Circle2D> circle("Circle2D");
    circle->radius = bad;
    expectNothing(circle);
    Made<nodes::Disk2D> disk("Disk2D");
    disk->outerRadius = bad;
    expectNothing(disk);
    Made<nodes::Rectangle2D> rectangle("Rectangle2D");
    rectangle->size = {2, bad};
    expectNothing(rectangle);
  }
  for (const float bad : {nan, infinite, -1.0f, 1.5f}) {
    Made<nodes::Disk2D> disk("Disk2D");
    disk->innerRadius = bad;
    expectNothing(disk);
  }
  for (const float bad : {nan, infinite}) {
    Made<nodes::Arc2D> arc("Arc2D");
    arc->endAngle = bad;
    expectNothing(arc);
  }
  for (const float large : {1e30f, 3e38f, 1e-40f}) {
    Made<nodes::Arc2D> arc("Arc2D");
    arc->startAngle = -large;
    arc->radius = large;
    expectSound(build(arc).mesh);
    Made<nodes::Disk2D> disk("Disk2D");
    disk->outerRadius = large;
    disk->innerRadius = large / 3;
    expectSound(build(disk, true).mesh);
    Made<nodes::TriangleSet2D> set("TriangleSet2D");
    set->vertices = {{-large, 0}, {large, 0}, {0, large}};
    expectSound(build(set, true).mesh);
  }
}

} // namespace
} // namespace xvrml::test
