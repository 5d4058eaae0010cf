// common_values.cpp: the small functions that libraries share: sRGB, sizes of pictures, case.
#include <cmath>
#include <gtest/gtest.h>

#include "lower_case.h"
#include "picture_size.h"
#include "srgb.h"

namespace {

// IEC 61966-2-1, with the numbers as the standard prints them.
TEST(Srgb, isTheCurveOfTheStandardInEachPrecision) {
  EXPECT_NEAR(encodeSrgb(.5), 1.055 * std::exp(std::log(.5) / 2.4) - .055, 1e-15);
  EXPECT_NEAR(decodeSrgb(.5), std::exp(2.4 * std::log(.555 / 1.055)), 1e-15);
  EXPECT_DOUBLE_EQ(encodeSrgb(.001), .01292);
  EXPECT_DOUBLE_EQ(decodeSrgb(.01292), .001);
  EXPECT_EQ(encodeSrgb(0.f), 0);
  EXPECT_FLOAT_EQ(encodeSrgb(1.f), 1);
  for (int i = 0; i <= 255; i++) {
    const double v = i / 255.0;
    EXPECT_NEAR(encodeSrgb(decodeSrgb(v)), v, 1e-7) << i; // the printed thresholds differ by 3e-8
    EXPECT_NEAR(decodeSrgb(float(v)), decodeSrgb(v), 2e-7) << i;
    EXPECT_NEAR(encodeSrgb(float(v)), encodeSrgb(v), 2e-7) << i;
  }
}

TEST(PictureSize, hasALimitOfEachSideAndOfAll) {
  EXPECT_TRUE(isPictureSize(1, 1));
  EXPECT_TRUE(isPictureSize(65536, 4096));
  EXPECT_TRUE(isPictureSize(16384, 16384));
  EXPECT_FALSE(isPictureSize(16385, 16384));
  EXPECT_FALSE(isPictureSize(65537, 1));
  EXPECT_FALSE(isPictureSize(0, 1));
  EXPECT_FALSE(isPictureSize(-1, -1));
  EXPECT_FALSE(isPictureSize(INT64_MAX, INT64_MAX));
}

TEST(LowerCase, knowsTheLettersOfAsciiOnly) {
  EXPECT_EQ(lowerCase("AbZ[@\xc4"), "abz[@\xc4");
  EXPECT_TRUE(beginsWithoutCase("HTTP://x", "http://"));
  EXPECT_FALSE(beginsWithoutCase("htt", "http://"));
  EXPECT_TRUE(beginsWithoutCase("", ""));
}

} // namespace
