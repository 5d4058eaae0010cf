// picture_bias.cpp: the interval of the bias between two pictures is Student's, over their pixels.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "libpicture/coverage.h"

namespace {

TEST(Bias, OfFewPixelsHasTheQuantileOfTheirNumber) {
  // Four pixels differ by -1, 1, -1, 1: mean 0, standard error sqrt(1 / 3).
  const std::vector<float> reference(16, 2);
  std::vector<float> made = reference;
  for (size_t i = 0; i < made.size(); i++) made[i] += i / 4 % 2 ? 1 : -1;
  const picture::Difference d = picture::compare(made, reference);
  EXPECT_NEAR(d.bias, 0, 1e-9);
  EXPECT_NEAR(d.biasInterval, 3.18245 * std::sqrt(1 / 3.), 1e-5); // t of 3 degrees, 0.975
}

TEST(Bias, OfManyPixelsHasTheNormalQuantile) {
  std::vector<float> reference(40000, 2), made = reference;
  for (size_t i = 0; i < made.size(); i++) made[i] += i / 4 % 2 ? .5f : -.5f;
  const picture::Difference d = picture::compare(made, reference);
  EXPECT_NEAR(d.biasInterval, 1.96 * .5 / std::sqrt(10000.), 1e-5);
}

// The colours of grey noise are one reading, not three.
TEST(Bias, OfGreyNoiseHoldsInNinetyFivePercent) {
  std::mt19937 random(1);
  std::normal_distribution<float> normal;
  int held = 0;
  constexpr int pictures = 1000;
  for (int i = 0; i < pictures; ++i) {
    const std::vector<float> reference(4 * 100, 1);
    std::vector<float> made = reference;
    for (size_t k = 0; k < made.size(); k += 4) {
      const float e = normal(random);
      for (size_t c = k; c < k + 3; ++c) made[c] += e;
    }
    const picture::Difference d = picture::compare(made, reference);
    held += std::abs(d.bias) <= d.biasInterval;
  }
  EXPECT_NEAR(held / double(pictures), .95, .021); // three standard deviations
}

} // namespace
