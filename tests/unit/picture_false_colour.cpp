// picture_false_colour.cpp: tests pictures of luminance in false colours: scale, colours, isolines
// and legend.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "libpicture/false_colour.h"
#include "openrt/openrt.h"

using namespace picture;

namespace {

// A picture whose luminance rises from left to right, from 0 to `most`.
Picture ramp(int width, int height, float most) {
  Picture p;
  p.width = width;
  p.height = height;
  std::vector<float>& rgba = p.planes[RT_RGBA];
  for (int i = 0; i < width * height; i++) {
    const float value = most * (float(i % width) + .5f) / float(width);
    rgba.insert(rgba.end(), {value, value, value, 1});
  }
  return p;
}

std::vector<float> at(const Picture& p, int x, int y) {
  const auto* c = &p.planes.at(RT_RGBA)[size_t(4 * (y * p.width + x))];
  return {c[0], c[1], c[2]};
}

const std::vector<float> black{0, 0, 0};

} // namespace

TEST(FalseColour, ScalesHaveRoundSteps) {
  for (const auto& [most, step, top] : {std::array{100.0, 10.0, 100.0},
                                        {101.0, 20.0, 120.0},
                                        {420.0, 50.0, 450.0},
                                        {.003, .0005, .003},
                                        {7e6, 1e6, 7e6}}) {
    const LuminanceScale scale = luminanceScale(most);
    EXPECT_NEAR(scale.step, step, 1e-9 * step) << most;
    EXPECT_NEAR(scale.top, top, 1e-9 * top) << most;
  }
}

TEST(FalseColour, IsolinesAreWhereTheLuminanceIsRound) {
  const Picture p = falseColours(ramp(400, 64, 100), 100);
  EXPECT_FALSE(p.linear);
  EXPECT_GT(p.width, 400);
  EXPECT_EQ(p.height, 64);
  for (int level = 1; level < 10; level++) {
    int lines = 0;
    for (int x = 40 * level - 3; x < 40 * level + 3; x++) lines += at(p, x, 32) == black;
    EXPECT_EQ(lines, 1) << level;
    EXPECT_NE(at(p, 40 * level + 20, 32), black);
  }
}

TEST(FalseColour, ColoursFollowTheScale) {
  const Picture p = falseColours(ramp(400, 64, 100), 100);
  const std::vector<float> low = at(p, 30, 32), middle = at(p, 190, 32), high = at(p, 390, 32);
  EXPECT_GT(low[2], low[0]) << "blue at the lower end";
  EXPECT_GT(middle[1], middle[2]) << "green in the middle";
  EXPECT_GT(high[0], high[2]) << "red at the upper end";
  const Picture wider = falseColours(ramp(400, 64, 100), 1000);
  EXPECT_GT(at(wider, 390, 32)[2], at(wider, 390, 32)[1]) << "the same value is low on this scale";
}

TEST(FalseColour, TheLegendHasTheColoursOfTheScale) {
  const Picture p = falseColours(ramp(400, 300, 100), 100);
  int dark = 0;
  for (int x = 400; x < p.width; x++)
    for (int y = 0; y < 14; y++) dark += at(p, x, y) == black;
  EXPECT_GT(dark, 30) << "the unit is written above the bar";
  EXPECT_GT(at(p, 408, 20)[0], at(p, 408, 20)[2]) << "the bar is red at its upper end";
  EXPECT_GT(at(p, 408, 270)[2], at(p, 408, 270)[1]) << "and blue at its lower end";
}

// A window draws the legend over its picture, whose size changes.
TEST(FalseColour, TheLegendCanBeDrawnByItself) {
  const Picture rising = ramp(200, 240, 100);
  const Picture whole = falseColours(rising, 100), left = falseColours(rising, 100, Legend::apart),
                right = falseColourLegend(100, 240);
  ASSERT_EQ(left.width, 200);
  ASSERT_EQ(left.width + right.width, whole.width);
  ASSERT_EQ(right.height, 240);
  EXPECT_FALSE(left.linear || right.linear);
  int different = 0;
  for (int y = 0; y < 240; y++)
    for (int x = 0; x < whole.width; x++)
      different += at(whole, x, y) != (x < 200 ? at(left, x, y) : at(right, x - 200, y));
  EXPECT_EQ(different, 0);
}

// Previews are smaller than the window.
TEST(FalseColour, IsolinesOfAnEnlargedPictureAreAsFineAsItsPixels) {
  const Picture p = falseColours(ramp(100, 16, 100), 100, Legend::apart, 400, 64);
  ASSERT_EQ(p.width, 400);
  ASSERT_EQ(p.height, 64);
  for (int level = 1; level < 10; level++) {
    int lines = 0;
    for (int x = 40 * level - 8; x < 40 * level + 8; x++) lines += at(p, x, 32) == black;
    EXPECT_EQ(lines, 1) << level;
  }
}

TEST(FalseColour, OddPicturesAreShown) {
  Picture tiny = ramp(1, 1, 0);
  EXPECT_EQ(falseColours(tiny, {}).height, 1);
  EXPECT_EQ(falseColourLegend(1, 1).height, 1);
  Picture wrong = ramp(8, 8, 1);
  wrong.planes[RT_RGBA][4] = std::nanf("");
  wrong.planes[RT_RGBA][8] = INFINITY;
  const Picture shown = falseColours(wrong, {});
  for (const float value : shown.planes.at(RT_RGBA)) EXPECT_TRUE(value >= 0 && value <= 1);
}
