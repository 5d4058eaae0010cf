// xvrml_nurbs.cpp: Tests the nodes of NURBS (ISO/IEC 19775-1 clause 27) against circles, cylinders,
// spheres and tori, which rational B-splines are exactly, and with fields that do not fit.
// Longer than 500 lines because all tests make their nodes of the same circle.
#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <numbers>

#include "geometry/nurbs/fields.h"
#include "geometry/nurbs/spline.h"
#include "unit/mesh_checks.h"

namespace xvrml::test {
namespace {

const double half = std::numbers::sqrt2 / 2;

MFDouble numbers(std::initializer_list<double> values) {
  MFDouble result;
  for (const double value : values) result.push_back({value});
  return result;
}

// A circle of nine homogeneous control points, counterclockwise from (1, 0): x, y and weight.
struct Circle {
  std::vector<std::array<double, 3>> points;
  MFDouble knots = numbers({0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4}), weights;

  Circle() {
    const int corners[9][2] = {{1, 0},   {1, 1},  {0, 1},  {-1, 1}, {-1, 0},
                               {-1, -1}, {0, -1}, {1, -1}, {1, 0}};
    for (int i = 0; i < 9; i++) {
      const double w = i % 2 ? half : 1;
      points.push_back({w * corners[i][0], w * corners[i][1], w});
      weights.push_back({w});
    }
  }
};

NodeRef inDouble(MFVec3d points) {
  Made<nodes::CoordinateDouble> node("CoordinateDouble");
  node->point = std::move(points);
  return node;
}

// A circle of the plane, x + shift and y multiplied by radius; turned: clockwise.
NodeRef circle2d(double radius, double shift, bool turned = false, int tessellation = 0) {
  const Circle circle;
  Made<nodes::NurbsCurve2D> curve("NurbsCurve2D");
  for (const auto& [x, y, w] : circle.points)
    curve->controlPoint.push_back({x * radius + shift * w, (turned ? -y : y) * radius});
  curve->knot = circle.knots;
  curve->weight = circle.weights;
  curve->tessellation = tessellation;
  return curve;
}

// Makes a surface of revolution about the y axis of points (distance, height, weight).
template <class Node> void revolve(Node& patch, const std::vector<std::array<double, 3>>& profile,
                                   std::initializer_list<double> knots, int order) {
  const Circle circle;
  MFVec3d points;
  patch.weight.clear();
  for (const auto& [r, y, w] : profile)
    for (const auto& [cx, cz, cw] : circle.points) {
      points.push_back({r * cx, y * cw, -r * cz});
      patch.weight.push_back({w * cw});
    }
  patch.controlPoint = inDouble(points);
  patch.uDimension = 9;
  patch.uKnot = circle.knots;
  patch.uOrder = 3;
  patch.vDimension = int(profile.size());
  patch.vKnot = numbers(knots);
  patch.vOrder = order;
}

double length(const Vec3f& v) { return std::hypot(double(v.x), double(v.y), double(v.z)); }
double dot(const Vec3f& a, const Vec3f& b) {
  return double(a.x) * b.x + double(a.y) * b.y + double(a.z) * b.z;
}

TEST(Nurbs, BasisFunctionsSumToOneAndHaveTheirDerivatives) {
  const KnotVector knots(4, {0, 0, 0, 0, 0.5, 2, 2, 3, 3, 3, 3});
  ASSERT_EQ(knots.pointCount(), 7u);
  constexpr double h = 1e-5;
  for (double t : {0.0, 0.2, 0.5, 1.1, 2.0, 2.7, 3.0}) {
    const BasisValues at = knots.basis(t);
    double sum = 0, first = 0, second = 0;
    for (size_t k = 0; k < 4; k++) {
      sum += at.value[k];
      first += at.first[k];
      second += at.second[k];
    }
    EXPECT_NEAR(sum, 1, 1e-14) << t;
    EXPECT_NEAR(first, 0, 1e-12) << t;
    EXPECT_NEAR(second, 0, 1e-11) << t;
  }
  for (double t : {0.2, 1.1, 2.7}) {
    const BasisValues at = knots.basis(t), before = knots.basis(t - h), after = knots.basis(t + h);
    for (size_t k = 0; k < 4; k++) {
      EXPECT_NEAR(at.first[k], (after.value[k] - before.value[k]) / (2 * h), 1e-7) << t;
      EXPECT_NEAR(at.second[k], (after.first[k] - before.first[k]) / (2 * h), 1e-7) << t;
    }
  }
}

TEST(Nurbs, ACurveOfOrderOfItsPointsIsABezierCurve) {
  Made<nodes::NurbsCurve> curve("NurbsCurve");
  curve->controlPoint = coordinate({{0, 0, 0}, {1, 2, 0}, {3, 2, 0}, {4, 0, 0}});
  curve->order = 4;
  curve->tessellation = 2;
  const Built built = build(curve);
  EXPECT_EQ(built.mesh.kind, Mesh::Kind::lines);
  ASSERT_EQ(built.mesh.points.size(), 3u);
  EXPECT_NEAR(built.mesh.points[1].x, 2, 1e-6); // (0 + 3 + 9 + 4) / 8
  EXPECT_NEAR(built.mesh.points[1].y, 1.5, 1e-6);
  EXPECT_EQ(built.diagnostics.list().size(), 0u);
}

TEST(Nurbs, TheNumberOfStepsIsThatOfTheStandard) {
  EXPECT_EQ(stepsOf(0, 9), 18u);
  EXPECT_EQ(stepsOf(30, 9), 30u);
  EXPECT_EQ(stepsOf(-3, 9), 27u);
  EXPECT_EQ(stepsOf(INT32_MIN, 1u << 30), (uint64_t(1) << 61));
}

TEST(Nurbs, ACircleHasItsRadius) {
  const Circle circle;
  Made<nodes::NurbsCurve> curve("NurbsCurve");
  MFVec3d points;
  for (const auto& [x, y, w] : circle.points) points.push_back({2 * x, 2 * y, 3 * w});
  curve->controlPoint = inDouble(points);
  curve->knot = circle.knots;
  curve->weight = circle.weights;
  curve->tessellation = 100;
  for (const bool closed : {false, true}) {
    curve->closed = closed;
    const Built built = build(curve);
    ASSERT_EQ(built.mesh.points.size(), 101u);
    for (const Vec3f& p : built.mesh.points) {
      EXPECT_NEAR(std::hypot(double(p.x), double(p.y)), 2, 1e-6);
      EXPECT_NEAR(p.z, 3, 1e-6);
    }
  }
  Faults faults;
  const auto exact = curveOf(*curve, faults);
  for (double t = 0; t < 4; t += 0.17) {
    const RationalCurve::Point at = exact->at(t);
    EXPECT_NEAR(at.first.x * at.place.x + at.first.y * at.place.y, 0, 1e-12);
    // Curvature 1 / 2: |C' x C''| = |C'|^3 / 2.
    EXPECT_NEAR(at.first.cross(at.second).length(), std::pow(at.first.length(), 3) / 2, 1e-9);
  }
}

TEST(Nurbs, ACylinderHasItsNormals) {
  Made<nodes::NurbsPatchSurface> patch("NurbsPatchSurface");
  revolve(*patch, {{2, -1, 1}, {2, 1, 1}}, {0, 0, 1, 1}, 2);
  patch->uTessellation = 64;
  patch->vTessellation = 1;
  const Built built = build(patch, true);
  expectSound(built.mesh);
  EXPECT_EQ(built.diagnostics.list().size(), 0u);
  EXPECT_TRUE(normalsFaceFront(built.mesh));
  ASSERT_EQ(built.mesh.points.size(), 68u * 2); // 65, and 3 knots that are there twice
  for (size_t i = 0; i < built.mesh.points.size(); i++) {
    const Vec3f &p = built.mesh.points[i], &n = built.mesh.normals[i];
    EXPECT_NEAR(std::hypot(double(p.x), double(p.z)), 2, 1e-6);
    EXPECT_NEAR(dot(n, {p.x / 2, 0, p.z / 2}), 1, 1e-6);
  }
  EXPECT_EQ(built.mesh.texCoords[0].x, 0);
  EXPECT_EQ(built.mesh.texCoords.back().x, 1);
  EXPECT_EQ(built.mesh.texCoords.back().y, 1);
}

// A half circle turned about its ends, whose parallels shrink to the poles.
TEST(Nurbs, ASphereIsClosedAndHasItsNormalsAtThePolesToo) {
  Made<nodes::NurbsPatchSurface> patch("NurbsPatchSurface");
  revolve(*patch, {{0, -1, 1}, {half, -half, half}, {1, 0, 1}, {half, half, half}, {0, 1, 1}},
          {0, 0, 0, 1, 1, 2, 2, 2}, 3);
  patch->uTessellation = 32;
  patch->vTessellation = 16;
  const Built built = build(patch);
  expectSound(built.mesh);
  EXPECT_EQ(openEdges(built.mesh), 0u);
  EXPECT_NEAR(signedVolume(built.mesh), 4 * std::numbers::pi / 3, 0.15);
  EXPECT_GT(signedVolume(built.mesh), 0) << "the front is outside";
  for (size_t i = 0; i < built.mesh.points.size(); i++) {
    EXPECT_NEAR(length(built.mesh.points[i]), 1, 1e-6);
    EXPECT_GT(dot(built.mesh.points[i], built.mesh.normals[i]), 1 - 1e-6);
  }
}

// A torus of radii 3 and 1: four nodes make it.
double offTorus(const Vec3f& p, const Vec3f& n) {
  const double ring = std::hypot(double(p.x), double(p.z));
  const Vec3f out{float(p.x - 3 * p.x / ring), p.y, float(p.z - 3 * p.z / ring)};
  return std::abs(length(out) - 1) + std::abs(1 - dot(out, n));
}
double mostOffTorus(const Mesh& mesh) {
  double most = 0;
  for (size_t i = 0; i < mesh.points.size(); i++)
    most = std::max(most, offTorus(mesh.points[i], mesh.normals[i]));
  return most;
}

TEST(Nurbs, ASweptCircleIsATorus) {
  const Circle circle;
  Made<nodes::NurbsCurve> spine("NurbsCurve");
  MFVec3d points;
  for (const auto& [x, y, w] : circle.points) points.push_back({3 * x, 0, 3 * y});
  spine->controlPoint = inDouble(points);
  spine->knot = circle.knots;
  spine->weight = circle.weights;
  spine->tessellation = 40;
  Made<nodes::NurbsSweptSurface> swept("NurbsSweptSurface");
  swept->crossSectionCurve = circle2d(1, 0, true, 24); // outside, as in an Extrusion
  swept->trajectoryCurve = spine;
  const Built built = build(swept, true);
  expectSound(built.mesh);
  EXPECT_EQ(built.diagnostics.list().size(), 0u);
  EXPECT_LT(mostOffTorus(built.mesh), 2e-6);
  EXPECT_EQ(openEdges(built.mesh), 0u);
  EXPECT_TRUE(normalsFaceFront(built.mesh));
  EXPECT_NEAR(signedVolume(built.mesh), 6 * std::numbers::pi * std::numbers::pi, 3);
  swept->ccw = false;
  const Built turned = build(swept);
  EXPECT_NEAR(signedVolume(turned.mesh), -6 * std::numbers::pi * std::numbers::pi, 3);
  EXPECT_TRUE(normalsFaceFront(turned.mesh));
}

TEST(Nurbs, ASwungCircleIsATorusAndAHalfOneASphere) {
  Made<nodes::NurbsSwungSurface> swung("NurbsSwungSurface");
  Made<nodes::NurbsCurve2D> profile("NurbsCurve2D"); // (y, z): a circle about z = 3
  const Circle circle;
  for (const auto& [x, y, w] : circle.points) profile->controlPoint.push_back({y, 3 * w + x});
  profile->knot = circle.knots;
  profile->weight = circle.weights;
  swung->profileCurve = profile;
  swung->trajectoryCurve = circle2d(1, 0);
  const Built torus = build(swung);
  expectSound(torus.mesh);
  EXPECT_LT(mostOffTorus(torus.mesh), 2e-6);
  EXPECT_EQ(openEdges(torus.mesh), 0u);
  EXPECT_GT(signedVolume(torus.mesh), 0);

  profile->controlPoint = {{-1, 0}, {-half, half}, {0, 1}, {half, half}, {1, 0}};
  profile->weight = numbers({1, half, 1, half, 1});
  profile->knot = numbers({0, 0, 0, 1, 1, 2, 2, 2});
  const Built sphere = build(swung);
  expectSound(sphere.mesh);
  EXPECT_EQ(openEdges(sphere.mesh), 0u);
  EXPECT_GT(signedVolume(sphere.mesh), 0);
  for (size_t i = 0; i < sphere.mesh.points.size(); i++)
    EXPECT_GT(dot(sphere.mesh.points[i], sphere.mesh.normals[i]), 1 - 2e-6);
}

TEST(Nurbs, CornersOfALineStaySharp) {
  Made<nodes::NurbsSwungSurface> box("NurbsSwungSurface");
  Made<nodes::ContourPolyline2D> profile("ContourPolyline2D"), square("ContourPolyline2D");
  profile->controlPoint = {{-1, 1}, {1, 1}};
  square->controlPoint = {{1, 1}, {-1, 1}, {-1, -1}, {1, -1}, {1, 1}};
  box->profileCurve = profile;
  box->trajectoryCurve = square;
  const Built built = build(box);
  expectSound(built.mesh);
  EXPECT_NEAR(area(built.mesh), 16, 1e-5);
  for (const Vec3f& n : built.mesh.normals)
    EXPECT_NEAR(std::max(std::abs(n.x), std::abs(n.z)), 1, 1e-6);
}

TEST(Nurbs, PiecesOfACurveKeepTheirEnds) {
  Made<nodes::NurbsCurve> curve("NurbsCurve");
  curve->order = 2;
  curve->tessellation = 4;
  for (const double t : {0, 0, 1, 1, 2, 2}) curve->knot.push_back({t});
  curve->controlPoint = coordinate({{0, 0, 0}, {1, 0, 0}, {3, 0, 0}, {4, 0, 0}});
  const Built built = build(curve);
  std::vector<float> x;
  for (const Vec3f& point : built.mesh.points) x.push_back(point.x);
  EXPECT_EQ(x, (std::vector<float>{0, .5f, 1, 3, 3.5f, 4}));
}

// A flat square from -4 to 4 by parameters with the same numbers.
void makeSquare(nodes::NurbsTrimmedSurface& surface) {
  surface.controlPoint = coordinate({{-4, -4, 0}, {4, -4, 0}, {-4, 4, 0}, {4, 4, 0}});
  surface.uDimension = surface.vDimension = surface.uOrder = surface.vOrder = 2;
  surface.uKnot = surface.vKnot = numbers({-4, -4, 4, 4});
  surface.uTessellation = surface.vTessellation = 8; // lines at the contours' outermost points
}
NodeRef contour(NodeRef curve) {
  Made<nodes::Contour2D> node("Contour2D");
  node->children = {std::move(curve)};
  return node;
}
NodeRef circleOfLines(double radius, bool turned) {
  Made<nodes::ContourPolyline2D> line("ContourPolyline2D");
  for (int i = 0; i < 40; i++) {
    const double angle = (turned ? 39 - i : i) * std::numbers::pi / 20;
    line->controlPoint.push_back({radius * std::cos(angle), radius * std::sin(angle)});
  }
  return line;
}
// Puts the triangles of two meshes into one.
Mesh together(const Mesh& a, const Mesh& b) {
  Mesh both;
  both.kind = Mesh::Kind::triangles;
  for (const Mesh* part : {&a, &b}) {
    const uint32_t first = uint32_t(both.ownPoints.size());
    both.ownPoints.insert(both.ownPoints.end(), part->points.begin(), part->points.end());
    for (const uint32_t index : part->indices) both.ownIndices.push_back(first + index);
  }
  both.viewOwn();
  return both;
}

TEST(Nurbs, PiecesOfATrimmedSurfaceKeepTheirEnds) {
  Made<nodes::NurbsTrimmedSurface> surface("NurbsTrimmedSurface");
  surface->uDimension = 4;
  surface->vDimension = surface->uOrder = surface->vOrder = 2;
  surface->uKnot = numbers({0, 0, 1, 1, 2, 2});
  surface->controlPoint = coordinate(
      {{0, 0, 0}, {1, 0, 0}, {5, 0, 0}, {5, 0, 1}, {0, 1, 0}, {1, 1, 0}, {5, 1, 0}, {5, 1, 1}});
  Made<nodes::ContourPolyline2D> outline("ContourPolyline2D");
  outline->controlPoint = {{0.5, 0}, {2, 0}, {2, 1}, {0.5, 1}};
  surface->trimmingContour = {contour(outline)};
  const Built built = build(surface);
  expectSound(built.mesh);
  EXPECT_NEAR(area(built.mesh), 1.5, 1e-5);
  for (size_t i = 0; i < built.mesh.points.size(); i++) {
    const bool isFirst = built.mesh.points[i].x < 1.0001f;
    EXPECT_EQ(built.mesh.points[i].x, isFirst ? built.mesh.points[i].x : 5.0f);
    EXPECT_EQ(std::abs(built.mesh.normals[i].z), isFirst ? 1 : 0);
    EXPECT_EQ(std::abs(built.mesh.normals[i].x), isFirst ? 0 : 1);
  }
}

TEST(Nurbs, ContoursLeaveWhatIsOnTheirLeft) {
  const double disk = 200 * std::sin(2 * std::numbers::pi / 200) / 2 * 4; // a circle's, radius 2
  Made<nodes::NurbsTrimmedSurface> surface("NurbsTrimmedSurface");
  makeSquare(*surface);
  EXPECT_NEAR(area(build(surface).mesh), 64, 1e-4);
  surface->trimmingContour = {contour(circle2d(2, 0, false, 200))};
  EXPECT_NEAR(area(build(surface).mesh), disk, 0.01);
  surface->trimmingContour = {contour(circle2d(2, 0, true, 200))};
  EXPECT_NEAR(area(build(surface).mesh), 64 - disk, 0.01) << "clockwise: a hole";
  Made<nodes::ContourPolyline2D> outer("ContourPolyline2D");
  outer->controlPoint = {{-3, -3}, {3, -3}, {3, 3}, {-3, 3}};
  surface->trimmingContour = {contour(outer), contour(circle2d(2, 0, true, 200))};
  const Built ring = build(surface, true);
  expectSound(ring.mesh);
  EXPECT_NEAR(area(ring.mesh), 36 - disk, 0.01);
  EXPECT_TRUE(normalsFaceFront(ring.mesh));
  for (size_t i = 0; i < ring.mesh.points.size(); i++) {
    EXPECT_NEAR(ring.mesh.texCoords[i].x, (ring.mesh.points[i].x + 4) / 8, 1e-6);
    EXPECT_GE(length(ring.mesh.points[i]), 1.9994);
  }
}

// Both halves of a bent surface that a contour cuts have the same edge, with no gap in the rest.
TEST(Nurbs, ATrimmedSurfaceHasNoGaps) {
  Made<nodes::NurbsTrimmedSurface> surface("NurbsTrimmedSurface");
  makeSquare(*surface);
  MFVec3f points;
  for (int j = 0; j < 3; j++)
    for (int i = 0; i < 3; i++)
      points.push_back({4.0f * float(i - 1), 4.0f * float(j - 1), i == 1 && j == 1 ? 9.0f : 0.0f});
  surface->controlPoint = coordinate(points);
  surface->uDimension = surface->vDimension = surface->uOrder = surface->vOrder = 3;
  surface->uKnot = surface->vKnot = numbers({-4, -4, -4, 4, 4, 4});
  for (const double radius : {1.0, 2.0, 2.3}) { // 1 and 2 touch lines between cells
    surface->trimmingContour = {contour(circleOfLines(radius, false))};
    const Built inner = build(surface);
    surface->trimmingContour = {contour(circleOfLines(radius, true))};
    const Built outer = build(surface);
    expectSound(inner.mesh);
    expectSound(outer.mesh);
    EXPECT_GE(openEdges(inner.mesh), 40u);
    // The outline of the square has 8 edges on each side; all others have a neighbour.
    EXPECT_EQ(openEdges(together(inner.mesh, outer.mesh)), 32u) << radius;
  }
}

TEST(Nurbs, APeriodicSurfaceIsSmoothAtItsSeam) {
  Made<nodes::NurbsCurve> curve("NurbsCurve");
  curve->controlPoint = coordinate({{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}, {1, 0, 0}});
  curve->closed = true;
  curve->tessellation = 8;
  Faults faults;
  const auto closed = curveOf(*curve, faults);
  const auto begin = closed->at(closed->knots.begin()), end = closed->at(closed->knots.end());
  EXPECT_LT((begin.place - end.place).length(), 1e-12);
  EXPECT_LT((begin.first - end.first).length(), 1e-9);
  curve->closed = false;
  const auto open = curveOf(*curve, faults);
  EXPECT_NEAR(open->at(0).place.x, 1, 1e-12);
  EXPECT_GT((open->at(0).first - open->at(1).first).length(), 1);
  EXPECT_FALSE(faults.any());
}

// The knots of a square's corners fall between equal steps.
TEST(Nurbs, BendsAreDrawnWhereTheyAre) {
  const KnotVector knots(2, {0, 0, 0.25, 0.5, 0.75, 1, 1});
  for (const uint64_t count : {1, 2, 3, 4, 10}) {
    const std::vector<ParameterStep> steps = knots.steps(count);
    EXPECT_EQ(std::count_if(steps.begin(), steps.end(),
                            [](const ParameterStep& step) {
                              return step.side == ParameterStep::Side::before;
                            }),
              3);
    EXPECT_EQ(steps.front().t, 0);
    EXPECT_EQ(steps.back().t, 1);
    for (size_t i = 1; i < steps.size(); i++) EXPECT_GE(steps[i].t, steps[i - 1].t);
  }
  EXPECT_EQ(knots.steps(4).size(), 8u); // each inner end is a bend
  EXPECT_EQ(KnotVector(3, {0, 0, 0, 1, 2, 2, 3, 3, 3}).steps(6).size(), 8u);

  Made<nodes::NurbsTrimmedSurface> surface("NurbsTrimmedSurface");
  makeSquare(*surface);
  Made<nodes::NurbsCurve2D> outline("NurbsCurve2D");
  outline->controlPoint = {{-3, -3}, {3, -3}, {3, 3}, {-3, 3}, {-3, -3}};
  outline->order = 2;
  surface->trimmingContour = {contour(outline)};
  EXPECT_NEAR(area(build(surface).mesh), 36, 1e-4);

  Made<nodes::NurbsPatchSurface> roof("NurbsPatchSurface"); // two planes at right angles
  roof->controlPoint =
      coordinate({{-1, 0, 0}, {0, 1, 0}, {1, 0, 0}, {-1, 0, -1}, {0, 1, -1}, {1, 0, -1}});
  roof->uDimension = 3;
  roof->vDimension = roof->uOrder = roof->vOrder = 2;
  roof->uTessellation = 3;
  const Built built = build(roof);
  expectSound(built.mesh);
  EXPECT_NEAR(area(built.mesh), 2 * std::numbers::sqrt2, 1e-5);
  for (const Vec3f& n : built.mesh.normals) EXPECT_NEAR(std::abs(n.x), half, 1e-6);
}

TEST(Nurbs, TextureCoordinatesFollowTheirPoints) {
  Made<nodes::NurbsPatchSurface> patch("NurbsPatchSurface");
  patch->controlPoint = coordinate({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}});
  patch->uDimension = patch->vDimension = patch->uOrder = patch->vOrder = 2;
  patch->uTessellation = patch->vTessellation = 2;
  patch->texCoord = textureCoordinate({{0, 0}, {2, 0}, {0, 3}, {2, 3}});
  const Built four = build(patch, true);
  EXPECT_NEAR(four.mesh.texCoords[4].x, 1, 1e-6);
  EXPECT_NEAR(four.mesh.texCoords[4].y, 1.5, 1e-6);
  Made<nodes::NurbsTextureCoordinate> texture("NurbsTextureCoordinate");
  texture->controlPoint = {{0, 0}, {0.5f, 0}, {1, 0}, {0, 1}, {0.5f, 0.5f}, {1, 1}};
  texture->weight = numbers({1, 0.5, 1, 1, 0.5, 1});
  texture->uDimension = 3;
  texture->vDimension = texture->vOrder = 2;
  patch->texCoord = texture;
  const Built patched = build(patch, true);
  // (0 / 4 + 0.5 / 2 + 1 / 4) / (1 / 4 + 0.5 / 2 + 1 / 4)
  EXPECT_NEAR(patched.mesh.texCoords[4].x, 0.5 / 0.75, 1e-6);
  EXPECT_NEAR(patched.mesh.texCoords[4].y, 0.5, 1e-6);
  patch->texCoord = textureCoordinate({{0, 0}});
  const Built few = build(patch, true);
  EXPECT_EQ(few.mesh.texCoords[8].x, 1);
  EXPECT_EQ(few.diagnostics.list().size(), 1u);
}

TEST(Nurbs, FieldsThatDoNotFitHaveTheStandardsDefaults) {
  Made<nodes::NurbsCurve> curve("NurbsCurve");
  curve->controlPoint = coordinate({{0, 0, 0}, {1, 2, 0}, {2, 0, 0}});
  curve->tessellation = 2;
  const float right = build(curve).mesh.points[1].y;
  EXPECT_FLOAT_EQ(right, 1);
  for (const MFDouble& knots :
       {numbers({0, 1}), numbers({0, 0, 0, 1, 0, 1}), numbers({0, 0, 0, 0, 1, 1}),
        numbers({0, 0, 0, NAN, 1, 1}), numbers({1, 1, 1, 1, 1, 1})}) {
    curve->knot = knots;
    const Built built = build(curve);
    EXPECT_EQ(built.mesh.points[1].y, right);
    EXPECT_EQ(built.diagnostics.list().size(), 1u);
  }
  curve->knot.clear();
  for (const MFDouble& weights : {numbers({1, 2}), numbers({1, 0, 1}), numbers({1, -1, 1})}) {
    curve->weight = weights;
    const Built built = build(curve);
    EXPECT_EQ(built.mesh.points[1].y, right);
    EXPECT_EQ(built.diagnostics.list().size(), 1u);
  }
}

TEST(Nurbs, HostileNumbersDrawNothingAndSaySo) {
  const auto expectNothing = [](auto& node) {
    Limits limits;
    limits.triangles = 100'000;
    const Built built = build(node, true, limits);
    expectSound(built.mesh);
    EXPECT_EQ(built.mesh.kind, Mesh::Kind::empty);
    EXPECT_EQ(built.diagnostics.list().size(), 1u);
  };
  for (const int32_t number : {INT32_MIN, -1, 0, 1, 1'000'000'000, INT32_MAX}) {
    Made<nodes::NurbsPatchSurface> patch("NurbsPatchSurface");
    revolve(*patch, {{2, -1, 1}, {2, 1, 1}}, {0, 0, 1, 1}, 2);
    patch->uOrder = number;
    expectNothing(patch);
    patch->uOrder = 3;
    patch->uDimension = number;
    expectNothing(patch);
  }
  for (const int32_t steps : {1'000'000'000, INT32_MIN}) {
    Made<nodes::NurbsPatchSurface> patch("NurbsPatchSurface");
    revolve(*patch, {{2, -1, 1}, {2, 1, 1}}, {0, 0, 1, 1}, 2);
    patch->uTessellation = steps;
    expectNothing(patch);
    Made<nodes::NurbsCurve> curve("NurbsCurve");
    curve->controlPoint = coordinate({{0, 0, 0}, {1, 2, 0}, {2, 0, 0}});
    curve->tessellation = steps;
    expectNothing(curve);
  }
  Made<nodes::NurbsPatchSurface> wild("NurbsPatchSurface");
  revolve(*wild, {{2, -1, 1}, {INFINITY, 1, 1}}, {0, 0, 1, 1}, 2);
  expectNothing(wild);
  revolve(*wild, {{2, -1, 1}, {1e300, 1, 1}}, {0, 0, 1, 1}, 2);
  expectNothing(wild);
  Made<nodes::NurbsPatchSurface> empty("NurbsPatchSurface");
  EXPECT_EQ(build(empty).diagnostics.list().size(), 0u);
}

// Every line of two combs crosses every line of the other one.
TEST(Nurbs, TangledContoursAreRefused) {
  Made<nodes::NurbsTrimmedSurface> surface("NurbsTrimmedSurface");
  makeSquare(*surface);
  surface->uTessellation = surface->vTessellation = 1;
  for (const bool across : {false, true}) {
    Made<nodes::ContourPolyline2D> comb("ContourPolyline2D");
    for (int i = 0; i < 20000; i++) {
      const double a = -3.9 + 7.8 * i / 20000, b = i % 4 < 2 ? -3.9 : 3.9;
      comb->controlPoint.push_back(across ? Vec2d{a, b} : Vec2d{b, a});
    }
    surface->trimmingContour.push_back(contour(comb));
  }
  const Built built = build(surface);
  expectSound(built.mesh);
  EXPECT_EQ(built.mesh.kind, Mesh::Kind::empty);
  EXPECT_EQ(built.diagnostics.list().size(), 1u);
}

TEST(Nurbs, PointsInDoublePrecisionServeAllGeometry) {
  Made<nodes::IndexedFaceSet> faces("IndexedFaceSet");
  faces->coord = inDouble({{0, 0, 0}, {2, 0, 0}, {0, 2, 0}});
  faces->coordIndex = {0, 1, 2, -1};
  EXPECT_NEAR(area(build(faces).mesh), 2, 1e-6);
  Made<nodes::IndexedTriangleSet> triangles("IndexedTriangleSet");
  triangles->coord = faces->coord;
  triangles->index = {0, 1, 2};
  EXPECT_NEAR(area(build(triangles).mesh), 2, 1e-6);
  Made<nodes::PointSet> points("PointSet");
  points->coord = faces->coord;
  EXPECT_EQ(build(points).mesh.points[1].x, 2);
  Made<nodes::IndexedLineSet> lines("IndexedLineSet");
  lines->coord = faces->coord;
  lines->coordIndex = {0, 1, 2};
  EXPECT_EQ(build(lines).mesh.points[1].x, 2);
}

} // namespace
} // namespace xvrml::test
