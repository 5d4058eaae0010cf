// picture_glare.cpp: Tests the position index and the unified glare rating against published
// values.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "libpicture/glare.h"

using namespace picture;

namespace {

const Observer observer{{0, 1.2, 0}, {0, 0, -1}, {0, 1, 0}};

Vec unit(Vec v) { return v / length(v); }
// Returns the index of a source at a distance of 1: t to the side, h above.
double indexAt(double t, double h) { return positionIndex(observer, unit({t, h, -1})); }

} // namespace

// CIE 117:1995, table 4.1, has these for T/R and H/R.
TEST(Glare, positionIndicesAreThoseOfTheTable) {
  EXPECT_NEAR(indexAt(0, 0), 1, 1e-9);
  const std::pair<double, double> above[] = {{.1, 1.26}, {.2, 1.53}, {.3, 1.90}, {.4, 2.35},
                                             {.5, 2.86}, {.6, 3.50}, {.7, 4.20}, {.8, 5.00},
                                             {.9, 6.00}, {1, 7.00}};
  for (const auto& [h, expected] : above) EXPECT_NEAR(indexAt(0, h) / expected, 1, .03) << h;
  EXPECT_NEAR(indexAt(1, 1), indexAt(-1, 1), 1e-12); // both sides are alike
  EXPECT_LT(indexAt(1, 0), indexAt(0, 1));           // a source beside the eye disturbs more
}

TEST(Glare, sourcesBehindAreNone) {
  EXPECT_TRUE(std::isinf(positionIndex(observer, {0, 0, 1})));
  GlareSources sources;
  sources.add(observer, {{0, 0, 1}, 2, 100, .36});
  EXPECT_EQ(sources.sum, 0);
  EXPECT_EQ(sources.illuminance, 0);
}

// UGR = 8 log10(0.25 / Lb x L^2 w / p^2), by hand: L = 1000 cd/m2, w = .01 sr, p = 1, Lb = 25
// cd/m2.
TEST(Glare, aSourceStraightAheadHasTheRatingOfTheFormula) {
  const double area = .04, distance = 2, luminance = 1000;
  GlareSources sources;
  sources.add(observer, {{0, 0, -1}, distance, luminance * area, area});
  EXPECT_NEAR(sources.sum, luminance * luminance * .01, 1e-9);
  EXPECT_NEAR(sources.illuminance, luminance * .01, 1e-9);
  const double background = 25;
  const GlareRating rating = glareRating(
      sources, sources.illuminance + std::numbers::pi * background, std::numbers::pi * 1);
  EXPECT_NEAR(rating.value, 8 * std::log10(.25 / background * 1e4), 1e-9); // 16
  EXPECT_NEAR(rating.halfWidth, 8 * std::log10(25.0 / 24), 1e-6);
}

TEST(Glare, edgesOfTheFormula) {
  GlareSources none, one;
  EXPECT_EQ(glareRating(none, 100, 1).value, 0); // nothing glares
  EXPECT_EQ(glareRating(none, 100, 1).halfWidth, 0);
  one.add(observer, {{0, 0, -1}, 2, 40, .04});
  EXPECT_TRUE(std::isinf(glareRating(one, one.illuminance, 0).halfWidth)); // a black background
  EXPECT_TRUE(std::isinf(glareRating(one, one.illuminance + 1, 2).halfWidth));
  EXPECT_EQ(glareRating(one, 1e9, 1).value, 0); // below 0
}
