// openrt_light_image.cpp: what light paths tell of a picture's error where few of them have come.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "render/film/light_image.h"

using namespace openrt;

namespace {

constexpr uint32_t edge = 32;
const Tile whole{0, 0, edge, edge};

// Returns a picture to which light paths of brightness 1 have come: `paths` for each pixel in the
// mean, between the columns `from` and `to`. power: 1 for even light; more for light that falls
// off.
std::vector<LightSums> rainOf(double paths, uint32_t seed, uint32_t from = 0, uint32_t to = edge,
                              double power = 1) {
  LightImage image(edge, edge);
  std::mt19937 random(seed);
  const auto drops = uint32_t(std::lround(paths * edge * (to - from) / LightImage::parts));
  for (uint32_t part = 0; part < LightImage::parts; part++) {
    std::vector<float> light(3 * edge * edge);
    for (uint32_t d = 0; d < drops; d++) {
      const double place = std::pow(random() / 4294967296., power);
      const uint32_t x = from + uint32_t(place * (to - from)), y = random() % edge;
      for (uint32_t k = 0; k < 3; k++) light[3 * (y * edge + x) + k] += LightImage::parts;
    }
    image.add(part, std::move(light));
  }
  std::vector<LightSums> out;
  image.read(whole, out);
  return out;
}

// Returns the error of a pixel whose camera paths have found nothing that varies.
PixelError withLight(const LightSums& light) {
  PixelError e;
  e.trusted = true;
  e.samples = 64;
  addLight(light, e);
  return e;
}

// Counts the intervals of pixels that are trusted, and those that contain the true value.
struct Intervals {
  int held = 0, trusted = 0, all = 0;
  void add(const LightSums& light, double truth) {
    const PixelError e = withLight(light);
    all++;
    trusted += e.trusted;
    held += e.trusted && std::fabs(double(e.mean[0]) - truth) <= double(e.halfWidth[0]);
  }
};

TEST(LightImage, evenLightOfFewPathsIsTrustedAndItsIntervalsHold) {
  constexpr double paths = .25; // 6 in 5x5 pixels
  Intervals intervals;
  for (uint32_t seed = 1; seed <= 8; seed++)
    for (const LightSums& light : rainOf(paths, seed)) intervals.add(light, paths);
  EXPECT_GT(intervals.trusted, .99 * intervals.all);
  EXPECT_GT(intervals.held, .93 * intervals.trusted);
}

// The light at the left edge is 30 times that at the right, and falls off within a few pixels.
TEST(LightImage, intervalsHoldWhereLightFallsOff) {
  constexpr double paths = .25, power = 3;
  Intervals intervals;
  for (uint32_t seed = 1; seed <= 32; seed++) {
    const std::vector<LightSums> light = rainOf(paths, seed, 0, edge, power);
    for (uint32_t i = 0; i < light.size(); i++) {
      const double left = i % edge / double(edge), right = left + 1. / edge;
      intervals.add(light[i],
                    paths * edge * (std::pow(right, 1 / power) - std::pow(left, 1 / power)));
    }
  }
  EXPECT_GT(intervals.trusted, .8 * intervals.all);
  EXPECT_GT(intervals.held, .93 * intervals.trusted);
}

TEST(LightImage, lightOfTooFewPathsIsNotTrusted) {
  const std::vector<LightSums> few = rainOf(1. / 32, 1); // 9 in 17x17 pixels
  for (const LightSums& light : few) {
    if (std::isinf(light.hits)) continue; // none in 5x5 pixels
    EXPECT_FALSE(withLight(light).trusted);
  }
}

// A window that finds too few paths grows, and one that finds enough does not. So the light of one
// half of a picture does not make the intervals of the other half wide.
TEST(LightImage, brightLightBesideDoesNotWidenIntervals) {
  const std::vector<LightSums> half = rainOf(4, 1, 0, edge / 2);
  for (uint32_t y = 0; y < edge; y++)
    for (uint32_t x = 0; x < edge; x++) {
      const LightSums& light = half[y * edge + x];
      if (x < edge / 2 - 2) { EXPECT_GE(light.hits, fewestPaths); }
      if (x >= edge / 2 + 2) { EXPECT_EQ(light.variance[0], 0); }
    }
}

TEST(LightImage, aPathThatIsAloneHasTheVarianceOfThePixelsAround) {
  LightImage image(edge, edge);
  for (uint32_t part = 0; part < LightImage::parts; part++) {
    std::vector<float> light(3 * edge * edge);
    if (part == 3) light[3 * (16 * edge + 16)] = LightImage::parts;
    image.add(part, std::move(light));
  }
  std::vector<LightSums> sums;
  image.read(whole, sums);
  EXPECT_NEAR(sums[16 * edge + 16].variance[0], 1, 1e-9);
  EXPECT_NEAR(sums[16 * edge + 18].variance[0], 1. / 25, 1e-9);
  EXPECT_EQ(sums[16 * edge + 19].variance[0], 0);
}

} // namespace
