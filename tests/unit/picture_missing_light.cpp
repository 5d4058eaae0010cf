// picture_missing_light.cpp: light that light samples miss, and series that differ by chance.
#include <random>

#include <gtest/gtest.h>

#include "libpicture/missing_light.h"

namespace {

using Series = std::vector<std::vector<float>>;
constexpr int width = 40, height = 24, tile = 16; // 3 x 2 tiles, some of which are cut

// Returns pictures whose pixels are `bright` with a probability, else 0; their mean is `mean`.
Series noisy(int count, double probability, double mean, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform;
  Series all;
  for (int i = 0; i < count; i++) {
    std::vector<float> rgba(4 * width * height, 1);
    for (size_t k = 0; k < rgba.size(); k += 4)
      rgba[k] = rgba[k + 1] = rgba[k + 2] =
          uniform(random) < probability ? float(mean / probability) : 0;
    all.push_back(rgba);
  }
  return all;
}

TEST(MissingLight, EqualLightIsNotMissing) {
  for (unsigned seed = 0; seed < 200; seed++)
    for (const double probability : {1e-4, 1e-3, .03, .9}) {
      const auto found = picture::findMissingLight(
          noisy(6, .9, 1, 1000 + seed), noisy(16, probability, 1, seed), width, height, tile);
      EXPECT_FALSE(found.any()) << seed << " " << probability;
      EXPECT_EQ(found.tiles, 6u);
    }
}

TEST(MissingLight, MoreLightIs) {
  const auto found =
      picture::findMissingLight(noisy(6, .9, 1, 1), noisy(16, .1, 1.5, 2), width, height, tile);
  EXPECT_TRUE(found.inPicture);
  EXPECT_NEAR(found.more, .5, 2 * found.interval);
  EXPECT_LT(found.interval, .2);
  const auto fromNothing =
      picture::findMissingLight(noisy(6, .9, 0, 1), noisy(16, .1, .2, 2), width, height, tile);
  EXPECT_TRUE(fromNothing.any());
  EXPECT_NEAR(fromNothing.more, 3 * .2, .1);
  EXPECT_FALSE(
      picture::findMissingLight(noisy(6, .9, 1, 1), noisy(16, .1, .5, 2), width, height, tile)
          .any())
      << "less light means nothing";
}

TEST(MissingLight, OneTileIsFound) {
  Series sampled = noisy(6, .9, 1, 3), hit = noisy(16, .5, 1, 4);
  for (auto& rgba : hit)
    for (size_t y = 0; y < 16; y++)
      for (size_t x = 0; x < 16; x++) rgba[4 * (y * width + x)] += 2;
  const auto found = picture::findMissingLight(sampled, hit, width, height, tile);
  EXPECT_EQ(found.inTiles, 1u);
}

} // namespace
