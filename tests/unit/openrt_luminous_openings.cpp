// openrt_luminous_openings.cpp: Tests that the rays which meet a luminous opening are as many as
// its projected area says, from all sides.
#include <gtest/gtest.h>

#include <cmath>

#include "../../plugins/shaders/photometry.h"

namespace {

using photometry::Coordinates;
using photometry::Opening;
using photometry::Shape;

// Returns the area of a square across parallel rays on which they meet the opening. to: a unit
// vector from the opening to where the rays come from.
double areaThatRaysMeet(const Opening& opening, const Coordinates& to) {
  constexpr int n = 600;
  constexpr double size = 3, cell = size / n;
  const double flat = std::hypot(to[0], to[1]);
  const Coordinates u{-to[1] / flat, to[0] / flat, 0},
      v{-u[1] * to[2], u[0] * to[2], u[1] * to[0] - u[0] * to[1]};
  int met = 0;
  for (int i = 0; i < n; i++)
    for (int k = 0; k < n; k++) {
      const double x = (i + .5) * cell - size / 2, y = (k + .5) * cell - size / 2;
      Coordinates from;
      for (size_t c = 0; c < 3; c++) from[c] = 5 * to[c] + x * u[c] + y * v[c];
      const double distance = opening.meet(from, {-2 * to[0], -2 * to[1], -2 * to[2]});
      met += std::isfinite(distance);
      if (std::isfinite(distance)) { EXPECT_NEAR(distance, 2.5, .75); }
    }
  return met * cell * cell;
}

void expectSameArea(const Opening& opening) {
  for (const double axis : {.9, .4, .05, -.3, -.8})
    for (const double turn : {.1, 1.3, 2.2, 3.5, 4.6, 5.9}) {
      const double aside = std::sqrt(1 - axis * axis);
      const Coordinates to{axis, aside * std::cos(turn), aside * std::sin(turn)};
      EXPECT_NEAR(areaThatRaysMeet(opening, to), opening.projected(to[0], to[1], to[2]), .012)
          << axis << " " << turn;
    }
}

TEST(LuminousOpening, ARectangle) { expectSameArea({1.2, .7}); }
TEST(LuminousOpening, ABox) { expectSameArea({1.2, .7, {.4, .4, .4, .4}}); }
TEST(LuminousOpening, ABoxWithSidesOfUnequalHeights) { expectSameArea({.8, 1, {.5, .2, 0, .3}}); }
TEST(LuminousOpening, ADisc) { expectSameArea({1.1, 1.1, {}, Shape::cylinder}); }
TEST(LuminousOpening, ACylinder) { expectSameArea({.9, .9, {.6, .6, .6, .6}, Shape::cylinder}); }
TEST(LuminousOpening, ALyingEllipticCylinder) {
  expectSameArea({.9, .5, {.6, .6, .6, .6}, Shape::cylinder, 1});
  expectSameArea({.9, .5, {.6, .6, .6, .6}, Shape::cylinder, 2});
}
TEST(LuminousOpening, AnEllipsoid) {
  expectSameArea({.9, 1.2, {.6, .6, .6, .6}, Shape::ellipsoid});
}

TEST(LuminousOpening, IsNotMetFromInsideNorByRaysThatLeaveIt) {
  const Opening box{1, 1, {1, 1, 1, 1}}, cylinder{1, 1, {1, 1, 1, 1}, Shape::cylinder};
  for (const Opening& opening : {box, cylinder}) {
    EXPECT_FALSE(std::isfinite(opening.meet({0, .1, .2}, {.3, .5, -.7})));
    EXPECT_FALSE(std::isfinite(opening.meet({2, 0, 0}, {1, 0, 0})));
    EXPECT_DOUBLE_EQ(opening.meet({2, .1, .1}, {-3, 0, 0}), .5);
    EXPECT_FALSE(std::isfinite(opening.meet({2, .6, 0}, {-1, 0, 0})));
  }
}

} // namespace
