// openrt_film.cpp: sums of samples, channels, and the picture of an unfinished frame.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "render/film/film.h"

using namespace openrt;

TEST(Film, meanAndVarianceOfLargeNumbersWithSmallDifferences) {
  PixelSums sums;
  for (int i = 0; i < 1000; i++) {
    const float x = 1e6f + float(i % 2); // variance 0.25 * 1000 / 999
    const float radiance[3] = {x, 1, float(i)};
    sums.add(radiance, 1);
  }
  Film film(1, 1, RT_RGBA | RT_VARIANCE | RT_SAMPLES);
  film.store(0, 0, sums);
  float rgba[4], variance[3], samples[1];
  ASSERT_TRUE(film.read(RT_RGBA, rgba));
  ASSERT_TRUE(film.read(RT_VARIANCE, variance));
  ASSERT_TRUE(film.read(RT_SAMPLES, samples));
  EXPECT_FLOAT_EQ(rgba[0], 1000000.5f);
  EXPECT_NEAR(variance[0], 0.25 * 1000 / 999, 1e-6);
  EXPECT_EQ(variance[1], 0);
  EXPECT_NEAR(variance[2], 1000.0 * 1001 / 12, 1e-1);
  EXPECT_EQ(samples[0], 1000);
}

TEST(Film, aMillionSmallSamplesAndOneLarge) { // N20
  PixelSums sums;
  const float small[3] = {1e-3f, 0, 0}, large[3] = {1e6f, 0, 0};
  for (int i = 0; i < 1000000; i++) sums.add(small, 1);
  sums.add(large, 1);
  Film film(1, 1, RT_RGBA);
  film.store(0, 0, sums);
  float rgba[4];
  ASSERT_TRUE(film.read(RT_RGBA, rgba));
  const double expected = (1e6 * double(1e-3f) + 1e6) / 1000001;
  EXPECT_NEAR(rgba[0] / expected, 1, 1e-6);
}

TEST(Film, channelsThatWereNotAskedForAreNotThere) {
  Film film(2, 2, RT_RGBA);
  float out[16];
  EXPECT_TRUE(film.read(RT_RGBA, out));
  EXPECT_FALSE(film.read(RT_DEPTH, out));
  EXPECT_FALSE(film.read(RT_RGBA | RT_DEPTH, out));
  EXPECT_FALSE(film.read(RT_RGBA, std::span(out, 15)));
}

TEST(Film, depthIsInfiniteWhereNothingIsHit) {
  Film film(1, 1, RT_DEPTH);
  float depth[1];
  ASSERT_TRUE(film.read(RT_DEPTH, depth));
  EXPECT_TRUE(std::isinf(depth[0]));
}

TEST(Film, unfinishedTilesAreNothing) {
  Film film(3, 2, RT_RGBA | RT_DEPTH);
  PixelSums sums;
  const float radiance[3] = {1, 2, 3};
  sums.add(radiance, 1);
  sums.firstValues[channelInfo(RT_DEPTH).place] = 5;
  for (uint32_t y = 0; y < 2; y++)
    for (uint32_t x = 0; x < 3; x++) film.store(x, y, sums);
  std::vector<float> rgba(24, -1.0f), depth(6, -1.0f);
  ASSERT_TRUE(film.clear(RT_RGBA, rgba));
  ASSERT_TRUE(film.clear(RT_DEPTH, depth));
  const Tile finished{1, 0, 3, 1};
  film.copy(RT_RGBA, finished, rgba);
  film.copy(RT_DEPTH, finished, depth);
  EXPECT_EQ(std::vector<float>(rgba.begin(), rgba.begin() + 8),
            (std::vector<float>{0, 0, 0, 0, 1, 2, 3, 1}));
  for (size_t i = 12; i < 24; i++) EXPECT_EQ(rgba[i], 0);
  EXPECT_TRUE(std::isinf(depth[0]) && depth[1] == 5 && depth[2] == 5 && std::isinf(depth[3]) &&
              std::isinf(depth[5]));
  EXPECT_FALSE(film.clear(RT_NORMAL, rgba));
  EXPECT_FALSE(film.clear(RT_RGBA, std::span(rgba).first(23)));
}
