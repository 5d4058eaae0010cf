// picture_pixel_reading.cpp: Tests what is read of one pixel.
#include <limits>

#include <gtest/gtest.h>

#include "libpicture/pixel_reading.h"

namespace picture {
namespace {

TEST(PixelReading, TheRightPixelIsRead) {
  Picture picture;
  picture.width = 2;
  picture.height = 2;
  for (int i = 0; i < 16; ++i) picture.planes[RT_RGBA].push_back(float(i));
  for (int i = 0; i < 12; ++i) picture.planes[RT_ERROR].push_back(float(i) / 100);
  picture.planes[RT_TRUST] = {0, 0, 1, 0};
  picture.planes[RT_SAMPLES] = {1, 2, 3, 4};
  const PixelReading left = readPixel(picture, 0, 1);
  EXPECT_EQ(left.radiance[0], 8);
  EXPECT_EQ(left.radiance[2], 10);
  EXPECT_EQ(left.halfWidth[1], .07f);
  EXPECT_FLOAT_EQ(left.luminance, .2126f * 8 + .7152f * 9 + .0722f * 10);
  EXPECT_FLOAT_EQ(left.luminanceHalfWidth, .2126f * .06f + .7152f * .07f + .0722f * .08f);
  EXPECT_EQ(left.samples, 3u);
  EXPECT_TRUE(left.trusted);
  EXPECT_FALSE(readPixel(picture, 1, 1).trusted);
}

TEST(PixelReading, UnknownErrorsAreInfinite) {
  Picture picture;
  picture.width = picture.height = 1;
  picture.planes = {{RT_RGBA, {1, 1, 1, 1}},
                    {RT_ERROR, {0, std::numeric_limits<float>::infinity(), 0}},
                    {RT_TRUST, {0}},
                    {RT_SAMPLES, {1}}};
  EXPECT_EQ(readPixel(picture, 0, 0).luminanceHalfWidth, std::numeric_limits<float>::infinity());
}

} // namespace
} // namespace picture
