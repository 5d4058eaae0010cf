// openrt_analytic_area.cpp: samples of analytic surfaces by area: points lie on the surface, and
// the elements add up to its area.
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "scene/analytic.h"

using namespace openrt;

namespace {

using Numbers = std::vector<double>;
constexpr auto quadric = edit::Primitive::Quadric, asphere = edit::Primitive::Asphere;

void expectArea(edit::Primitive kind, const Numbers& numbers, double expected) {
  ASSERT_EQ(AnalyticSurface::problemOf(kind, numbers), "");
  const AnalyticSurface surface(kind, numbers);
  ASSERT_TRUE(surface.samplable());
  constexpr int along = 2000, around = 16;
  double sum = 0;
  for (int i = 0; i < along; i++)
    for (int j = 0; j < around; j++) {
      const Vec3d p = surface.pointAt((i + .5) / along, (j + .5) / around);
      const double area = surface.areaAt(p);
      sum += area / (along * around);
      if (area == 0) continue;
      Vec3d gradient;
      EXPECT_NEAR(surface.valueAt(p, gradient) / length(gradient), 0, 1e-12);
    }
  EXPECT_NEAR(sum, expected, 1e-5 * expected);
}

} // namespace

TEST(AnalyticArea, ofCylindersAboutEveryAxis) {
  expectArea(quadric, {1, 0, 1, 0, 0, 0, 0, 0, 0, -4, -2, -1, -2, 2, 5, 2}, 2 * M_PI * 2 * 6);
  expectArea(quadric, {0, 3, 3, 0, 0, 0, 0, 0, 0, -3, -1, -1, -1, 2, 1, 1}, 2 * M_PI * 3);
  expectArea(quadric, {-1, -1, 0, 0, 0, 0, 0, 0, 0, 1, -1, -1, 0, 1, 1, 1}, 2 * M_PI); // inside out
}

TEST(AnalyticArea, ofCones) { // r = 1 - y / 2 from y = 0 to 2, and to 1
  const Numbers cone{1, -.25, 1, 0, 0, 0, 0, 1, 0, -1, -1, 0, -1, 1, 2, 1};
  expectArea(quadric, cone, M_PI * std::sqrt(5.0));
  Numbers cut = cone;
  cut[14] = 1;
  expectArea(quadric, cut, M_PI * 1.5 * std::sqrt(1.25));
}

TEST(AnalyticArea, ofSpheresAndTheirZones) { // Archimedes: a zone has the area 2 pi R h
  expectArea(quadric, {1, 1, 1, 0, 0, 0, 0, 0, 0, -9, -3, -3, -3, 3, 3, 3}, 4 * M_PI * 9);
  expectArea(quadric, {1, 1, 1, 0, 0, 0, 0, 0, 0, -9, -3, -1, -3, 3, 2, 3}, 2 * M_PI * 3 * 3);
  // The box reaches beyond the sphere: there is no surface, and the area stays.
  expectArea(quadric, {1, 1, 1, 0, 0, 0, 0, 0, 0, -9, -3, -6, -3, 3, 6, 3}, 4 * M_PI * 9);
}

TEST(AnalyticArea, ofAspheres) {
  expectArea(asphere, {0, 0, 1, 2}, 3 * M_PI); // a ring
  constexpr double c = .5, r = 1.5;
  expectArea(asphere, {c, -1, 0, r},
             2 * M_PI / (3 * c * c) * (std::pow(1 + c * c * r * r, 1.5) - 1)); // a paraboloid
  // A spherical cap: 2 pi R h.
  const double h = 2 - std::sqrt(4 - r * r);
  expectArea(asphere, {.5, 0, 0, r}, 2 * M_PI * 2 * h);
}

TEST(AnalyticArea, OtherQuadricsAreNotSampled) {
  for (const Numbers& numbers :
       {Numbers{1, 0, 2, 0, 0, 0, 0, 0, 0, -1, -1, -1, -1, 1, 1, 1}, // elliptic
        {1, 0, 1, .1, 0, 0, 0, 0, 0, -1, -1, -1, -1, 1, 1, 1},       // askew
        {1, 0, 1, 0, 0, 0, .2, 0, 0, -1, -1, -1, -1, 1, 1, 1}})      // beside the axis
    EXPECT_FALSE(AnalyticSurface(quadric, numbers).samplable());
}

// A box that cuts off a side: no area there.
TEST(AnalyticArea, PointsOutsideTheBoxHaveNone) {
  const AnalyticSurface half(quadric, Numbers{1, 0, 1, 0, 0, 0, 0, 0, 0, -1, 0, -1, -1, 1, 1, 1});
  ASSERT_TRUE(half.samplable());
  double sum = 0;
  for (int j = 0; j < 1000; j++) sum += half.areaAt(half.pointAt(.5, (j + .5) / 1000)) / 1000;
  EXPECT_NEAR(sum, 2 * M_PI, 1e-6);
}
