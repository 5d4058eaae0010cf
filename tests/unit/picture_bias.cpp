// picture_bias.cpp: the interval of the bias between two pictures is Student's.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "libpicture/coverage.h"

TEST(Bias, OfFewValuesHasTheQuantileOfTheirNumber) {
  // Six colours differ by -1, 1, -1, 1, -1, 1: mean 0, standard error sqrt(1 / 5).
  const std::vector<float> reference(8, 2), made{1, 3, 1, 1, 3, 1, 3, 1};
  const picture::Difference d = picture::compare(made, reference);
  EXPECT_NEAR(d.bias, 0, 1e-9);
  EXPECT_NEAR(d.biasInterval, 2.57058 * std::sqrt(1 / 5.), 1e-5); // t of 5 degrees, 0.975
}

TEST(Bias, OfManyValuesHasTheNormalQuantile) {
  std::vector<float> reference(40000, 2), made = reference;
  for (size_t i = 0; i < made.size(); i++) made[i] += i / 4 % 2 ? .5f : -.5f;
  const picture::Difference d = picture::compare(made, reference);
  EXPECT_NEAR(d.biasInterval, 1.96 * .5 / std::sqrt(30000.), 1e-5);
}
