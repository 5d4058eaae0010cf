// picture_doubt.cpp: Tests where denoised pictures are not believed.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "libpicture/doubt.h"
#include "openrt/openrt.h"
#include "student.h"

namespace {

using namespace picture;

constexpr int side = 32;

// Grey pixels of the light 1 with so many replicates each: their means and Student's intervals.
Picture noisy(int replicates, uint32_t seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(1, .5);
  Picture picture;
  picture.width = picture.height = side;
  for (int i = 0; i < side * side; ++i) {
    double sum = 0, squares = 0;
    for (int k = 0; k < replicates; ++k) {
      const double x = normal(random);
      sum += x;
      squares += x * x;
    }
    const double mean = sum / replicates,
                 variance = (squares - replicates * mean * mean) / (replicates - 1);
    const double half = student::quantile95(replicates - 1) * std::sqrt(variance / replicates);
    picture.planes[RT_RGBA].insert(picture.planes[RT_RGBA].end(),
                                   {float(mean), float(mean), float(mean), 1});
    picture.planes[RT_ERROR].insert(picture.planes[RT_ERROR].end(), 3, float(half));
    picture.planes[RT_TRUST].push_back(1);
  }
  return picture;
}

std::vector<float> grey(float value) { return std::vector<float>(4 * side * side, value); }

double shareOf(const Picture& raw, const std::vector<float>& denoised) {
  return countDoubt(doubtOf(raw, denoised)).share();
}

// The truth leaves the 99 % intervals in one pixel of a hundred, or in fewer.
TEST(Doubts, HardlyTouchADenoiserThatIsRight) {
  for (const int replicates : {8, 16, 31}) {
    double share = 0;
    for (uint32_t seed = 1; seed <= 10; ++seed)
      share += shareOf(noisy(replicates, seed), grey(1)) / 10;
    EXPECT_LE(share, .013) << replicates;
    EXPECT_GE(share, .001) << replicates;
  }
}

TEST(Doubts, CatchADenoiserThatLies) {
  const Picture raw = noisy(16, 1); // a standard error is .125
  EXPECT_GT(shareOf(raw, grey(2)), .99);
  EXPECT_GT(shareOf(raw, grey(1.5f)), .4);
  std::vector<float> red = grey(1);
  for (size_t i = 0; i < red.size(); i += 4) red[i] = 2;
  EXPECT_GT(shareOf(raw, red), .99) << "one colour is enough";
  std::vector<float> spot = grey(1);
  spot[4 * 100 + 1] = 3;
  const std::vector<float> doubt = doubtOf(raw, spot);
  EXPECT_GT(doubt[100], 1);
}

TEST(Doubts, AreInHalfWidthsOfTheInterval) {
  Picture raw = noisy(16, 1);
  std::fill(raw.planes[RT_RGBA].begin(), raw.planes[RT_RGBA].end(), 1.0f);
  std::fill(raw.planes[RT_ERROR].begin(), raw.planes[RT_ERROR].end(), .1f);
  // the quantiles of 7 degrees of freedom, .995 and .975
  EXPECT_NEAR(doubtOf(raw, grey(1.2f))[0], .2 / (.1 * 3.49948 / 2.36462), 1e-4);
  EXPECT_NEAR(doubtOf(raw, grey(.8f))[0], .2 / (.1 * 3.49948 / 2.36462), 1e-4);
  EXPECT_EQ(doubtOf(raw, grey(1))[0], 0);
}

TEST(Doubts, JudgeTrustedPixelsAlone) {
  Picture raw = noisy(16, 1);
  for (size_t i = 0; i < raw.planes[RT_TRUST].size(); i += 2) raw.planes[RT_TRUST][i] = 0;
  const std::vector<float> doubt = doubtOf(raw, grey(5));
  EXPECT_EQ(doubt[0], notJudged);
  EXPECT_GT(doubt[1], 1);
  const DoubtCounts counts = countDoubt(doubt);
  EXPECT_EQ(counts.pixels, size_t(side * side));
  EXPECT_EQ(counts.judged, size_t(side * side / 2));
  EXPECT_EQ(counts.doubtful, counts.judged);
  std::fill(raw.planes[RT_TRUST].begin(), raw.planes[RT_TRUST].end(), 0.0f);
  EXPECT_EQ(shareOf(raw, grey(1)), 1) << "nothing speaks for the picture";
}

// A pixel whose samples are all equal has an interval without width, and denoisers change it by
// what nobody sees.
TEST(Doubts, OverlookWhatNobodySees) {
  Picture raw = noisy(16, 1);
  std::fill(raw.planes[RT_ERROR].begin(), raw.planes[RT_ERROR].end(), 0.0f);
  std::fill(raw.planes[RT_RGBA].begin(), raw.planes[RT_RGBA].end(), 1.0f);
  EXPECT_EQ(shareOf(raw, grey(1.007f)), 0);
  EXPECT_EQ(shareOf(raw, grey(1.009f)), 1);
  for (size_t k = 0; k < 3; ++k) raw.planes[RT_RGBA][k] = 0; // black beside light
  EXPECT_LE(doubtOf(raw, grey(.0009f))[0], 1);
  EXPECT_GT(doubtOf(raw, grey(.002f))[0], 1);
}

TEST(Doubts, AreFinite) {
  Picture raw = noisy(16, 1);
  raw.planes[RT_ERROR][0] = std::numeric_limits<float>::infinity();
  raw.planes[RT_RGBA][4] = std::numeric_limits<float>::quiet_NaN();
  std::vector<float> made = grey(1);
  made[8] = std::numeric_limits<float>::quiet_NaN();
  made[12] = std::numeric_limits<float>::infinity();
  for (const float v : doubtOf(raw, made)) EXPECT_TRUE(v == notJudged || (v >= 0 && v <= 99));
  EXPECT_GT(doubtOf(raw, made)[2], 1);
  EXPECT_GT(doubtOf(raw, made)[3], 1);
  EXPECT_LE(doubtOf(raw, made)[0], 1);
}

} // namespace
