// openrt_sampler.cpp: Tests the (0,2) property itself. A wrong scramble looks right but loses the
// advantage.
#include <gtest/gtest.h>

#include <set>
#include <vector>

#include "render/wave/sampler.h"

using namespace openrt;

namespace {

// Returns whether every elementary interval of area 2^-m holds exactly one of 2^m points.
bool isNet(uint32_t pixel, uint32_t pair, uint32_t seed, int m, uint32_t first) {
  for (int a = 0; a <= m; a++) {
    std::set<int> cells;
    for (uint32_t i = 0; i < (1u << m); i++) {
      float x, y;
      PairSampler(pixel, pair, seed)(first + i, x, y);
      cells.insert((int(x * float(1 << a)) << (m - a)) + int(y * float(1 << (m - a))));
    }
    if (cells.size() != size_t(1) << m) return false;
  }
  return true;
}

} // namespace

TEST(Sampler, firstPointsOfAPixelAreANet) {
  for (uint32_t seed = 0; seed < 20; seed++)
    for (int m = 0; m <= 10; m++)
      ASSERT_TRUE(isNet(77 * seed, seed % 3, seed, m, 0)) << seed << " " << m;
}

TEST(Sampler, everyAlignedBlockIsANet) {
  for (uint32_t block = 0; block < 16; block++) ASSERT_TRUE(isNet(5, 0, 9, 4, 16 * block)) << block;
}

TEST(Sampler, valuesAreInTheUnitInterval) {
  for (uint32_t i = 0; i < 100000; i++) {
    float x, y;
    PairSampler(i * 2654435761u, 0, 1)(i, x, y);
    ASSERT_TRUE(x >= 0 && x < 1 && y >= 0 && y < 1);
  }
}

TEST(Sampler, pixelsAndSeedsAndPairsDiffer) {
  std::set<std::pair<float, float>> seen;
  for (uint32_t pixel = 0; pixel < 50; pixel++)
    for (uint32_t seed = 0; seed < 20; seed++)
      for (uint32_t pair = 0; pair < 4; pair++) {
        float x, y;
        PairSampler(pixel, pair, seed)(0, x, y);
        seen.insert({x, y});
      }
  EXPECT_GT(seen.size(), 3990u);
}

TEST(Sampler, integratesASmoothFunctionFasterThanRandomPoints) {
  double worst = 0;
  for (uint32_t pixel = 0; pixel < 64; pixel++) { // integral of x*y over the unit square: 1/4
    double sum = 0;
    for (uint32_t i = 0; i < 256; i++) {
      float x, y;
      PairSampler(pixel, 0, 3)(i, x, y);
      sum += double(x) * y;
    }
    worst = std::max(worst, std::abs(sum / 256 - 0.25));
  }
  EXPECT_LT(worst, 0.002); // random points would have a standard error of 0.0138
}
