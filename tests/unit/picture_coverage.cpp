// picture_coverage.cpp: how audits count error bars that hold, on pictures that were made up.
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "libpicture/coverage.h"

namespace {

using picture::Coverage;
using picture::Shot;

constexpr int edge = 20, pixels = edge * edge;

// A black picture whose pixels are exact, and a reference that is black, too.
Shot blackShot() {
  Shot shot;
  shot.rgba.assign(4 * pixels, 0);
  shot.half.assign(3 * pixels, 0);
  shot.trust.assign(pixels, 1);
  shot.variance.assign(3 * pixels, 0);
  return shot;
}

void set(Shot& shot, size_t pixel, float value, float half, float variance) {
  for (size_t k = 0; k < 3; k++) {
    shot.rgba[4 * pixel + k] = value;
    shot.half[3 * pixel + k] = half;
    shot.variance[3 * pixel + k] = variance;
  }
}

Coverage count(const std::vector<Shot>& shots, int tileEdge = edge) {
  picture::Reference reference;
  reference.colours.assign(3 * pixels, 0);
  return picture::countCoverage(shots, reference, edge, edge, tileEdge);
}

TEST(Coverage, ExactPixelsAreNoIntervals) {
  Shot shot = blackShot();
  set(shot, 3, 1, 0, 0); // wrong, and called exact
  const Coverage c = count({shot});
  EXPECT_EQ(c.exact, uint64_t(pixels));
  EXPECT_EQ(c.exactHeld, uint64_t(pixels - 1));
  EXPECT_EQ(c.intervals(), 0u);
}

// In a world of direct light most bars that have a width are bounds of pixels without variation.
// They hold nearly always, and say nothing about the intervals.
TEST(Coverage, BoundsOfPixelsWithoutVariationAreCountedApart) {
  Shot shot = blackShot();
  for (size_t i = 0; i < 100; i++) set(shot, i, 0, 1, 0);
  for (size_t i = 100; i < 300; i++) set(shot, i, i % 20 == 0 ? 2.f : .5f, 1, .25f);
  const Coverage c = count({shot});
  EXPECT_EQ(c.bounds, 100u);
  EXPECT_EQ(c.boundsHeld, 100u);
  EXPECT_EQ(c.exact, 100u);
  EXPECT_EQ(c.intervals(), 200u);
  EXPECT_DOUBLE_EQ(c.share(), .95);
  EXPECT_DOUBLE_EQ(c.worstTiles, .95);
  EXPECT_DOUBLE_EQ(c.halfWidth, 1);
}

TEST(Coverage, APixelThatVariesInOneColourHasAnInterval) {
  Shot shot = blackShot();
  set(shot, 0, 0, 1, 0);
  shot.variance[2] = 1;
  const Coverage c = count({shot});
  EXPECT_EQ(c.bounds, 0u);
  EXPECT_EQ(c.intervals(), 1u);
}

TEST(Coverage, TilesWithFewIntervalsSayNothing) {
  Shot shot = blackShot();
  for (size_t i = 0; i < 99; i++) set(shot, i, 2, 1, 1); // all wrong
  EXPECT_EQ(count({shot}).worstTiles, 1);
  set(shot, 99, 2, 1, 1);
  EXPECT_EQ(count({shot}).worstTiles, 0);
}

TEST(Coverage, UntrustedPixelsAreLeftOut) {
  Shot shot = blackShot();
  set(shot, 5, 3, 1, 1);
  shot.trust[5] = 0;
  const Coverage c = count({shot});
  EXPECT_EQ(c.trusted, uint64_t(pixels - 1));
  EXPECT_EQ(c.held, uint64_t(pixels - 1));
  EXPECT_EQ(c.share(), 0);
}

} // namespace
