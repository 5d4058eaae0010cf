// openrt_error.cpp: intervals of pixels from sums of samples.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "render/error.h"

using namespace openrt;

namespace {

PixelSums sumsOf(const std::vector<float>& samples, const Replicates& replicates) {
  PixelSums sums;
  for (size_t i = 0; i < samples.size(); i++) {
    const float radiance[3] = {samples[i], 2 * samples[i], 0};
    sums.add(radiance, 1);
    sums.addTails(radiance);
    if (replicates.many() && replicates.indexOf(uint32_t(i) + 1) == 0) sums.closeReplicate();
  }
  return sums;
}

Tails tailsOf(const PixelSums& sums) {
  Tails tails;
  tails.add(sums);
  return tails;
}

} // namespace

TEST(Error, studentsQuantiles) { // tables of the t distribution, 0.975
  EXPECT_NEAR(student95(1), 12.706, 1e-3);
  EXPECT_NEAR(student95(7), 2.365, 1e-3);
  EXPECT_NEAR(student95(10), 2.228, 1e-3);
  EXPECT_NEAR(student95(15), 2.131, 1e-3);
  EXPECT_NEAR(student95(31), 2.040, 1e-3);
  EXPECT_NEAR(student95(1000000), 1.960, 1e-3);
}

TEST(Error, intervalOverTheMeansOfReplicates) { // means 1, 2, 3, 4: standard deviation sqrt(5/3)
  const Replicates four{0, 1};
  const PixelSums sums = sumsOf({0, 2, 1, 3, 2, 4, 3, 5}, four);
  const Tails tails = tailsOf(sums);
  const PixelError e = pixelError(sums, four, &tails);
  EXPECT_NEAR(e.halfWidth[0], 3.18245 * std::sqrt(5.0 / 3 / 4), 1e-5);
  EXPECT_NEAR(e.halfWidth[1], 2 * e.halfWidth[0], 1e-5);
  EXPECT_EQ(e.halfWidth[2], 0);
  EXPECT_FALSE(e.trusted); // four are too few
}

TEST(Error, theLastReplicateMayBeShorter) { // sums 3, 5 and of one sample 4: mean 12/5, weights 2/5, 2/5, 1/5
  const Replicates two{0, 1};
  const PixelSums sums = sumsOf({1, 2, 2, 3, 4}, two);
  const double m = 2.4, squares = std::pow(3 - 2 * m, 2) + std::pow(5 - 2 * m, 2) + std::pow(4 - m, 2);
  EXPECT_NEAR(pixelError(sums, two, nullptr).halfWidth[0], 4.30265 * std::sqrt(squares / 25 * 3 / 2), 1e-5);
}

TEST(Error, largeNumbersWithSmallDifferences) {
  const Replicates two{0, 1};
  const PixelSums sums = sumsOf({1e6f, 1e6f + 2, 1e6f + 1, 1e6f + 3}, two); // means differ by 1
  EXPECT_NEAR(pixelError(sums, two, nullptr).halfWidth[0], 12.7062 * 0.5, 1e-3);
}

TEST(Error, withoutReplicatesItIsThatOfIndependentSamplesAndNotTrusted) {
  const PixelSums sums = sumsOf({0, 1, 0, 1, 0, 1, 0, 1}, {});
  const Tails tails = tailsOf(sums);
  const PixelError e = pixelError(sums, {}, &tails);
  EXPECT_NEAR(e.halfWidth[0], 2.36462 * std::sqrt(2.0 / 7 / 8), 1e-5);
  EXPECT_FALSE(e.trusted);
}

TEST(Error, oneSampleSaysNothing) {
  const PixelError e = pixelError(sumsOf({1}, {}), {}, nullptr);
  EXPECT_TRUE(std::isinf(e.halfWidth[0]));
  EXPECT_EQ(e.relative, 1);
  EXPECT_FALSE(e.trusted);
}

TEST(Error, inTheDarkAnUpperBoundFromThePixelsAround) {
  const Replicates r{0, 2};
  PixelSums dark = sumsOf(std::vector<float>(64, 0.0f), r), lit = sumsOf({5, 0, 0, 0}, r);
  dark.random = lit.random = true;
  Tails tails = tailsOf(dark);
  EXPECT_TRUE(std::isinf(pixelError(dark, r, &tails).halfWidth[0])); // nothing is known
  tails.add(lit);
  const PixelError e = pixelError(dark, r, &tails);
  EXPECT_NEAR(e.halfWidth[0], 5 * 2.9957 / 64, 1e-4);
  EXPECT_FALSE(e.trusted);
}

TEST(Error, whereNothingIsRandomEqualSamplesAreExact) {
  const Replicates r{0, 2};
  const PixelSums sums = sumsOf(std::vector<float>(64, 0.3f), r);
  const Tails tails = tailsOf(sums);
  const PixelError e = pixelError(sums, r, &tails);
  EXPECT_EQ(e.halfWidth[0], 0);
  EXPECT_TRUE(e.trusted && e.constant);
}

TEST(Error, oneBrightSampleIsNotTrusted) {
  const Replicates r{0, 2};
  std::vector<float> samples(64);
  for (size_t i = 0; i < 64; i++) samples[i] = float(i % 7);
  const PixelSums calm = sumsOf(samples, r);
  samples[20] = 1000;
  const PixelSums wild = sumsOf(samples, r);
  const Tails around = tailsOf(calm);
  EXPECT_TRUE(pixelError(calm, r, &around).trusted);
  Tails tails = tailsOf(wild);
  tails.add(calm);
  EXPECT_FALSE(pixelError(wild, r, &tails).trusted);
  EXPECT_FALSE(pixelError(calm, r, &tails).trusted) << "its neighbour may have missed what it met";
}

TEST(Error, aConstantPixelBesideAnEdgeIsInDoubt) {
  ErrorMap map(5, 1, ErrorMap::Kind::full);
  for (size_t i = 0; i < 5; i++) {
    PixelError e;
    e.mean[0] = i < 3 ? 0.0f : 1.0f;
    e.samples = 30, e.trusted = e.constant = true, e.relative = e.expected = 0;
    map.store(i, e);
  }
  std::vector<size_t> changed;
  map.doubtConstants([&](size_t pixel, const float half[3]) {
    changed.push_back(pixel);
    EXPECT_NEAR(half[0], 2.9957 / 30, 1e-6);
    EXPECT_EQ(half[1], 0);
  });
  EXPECT_EQ(changed, (std::vector<size_t>{2, 3}));
  EXPECT_EQ(map.summary().trusted, 3u);
  EXPECT_EQ(map.summary().pixels, 5u);
}

TEST(Error, numberOfSamplesForATarget) {
  EXPECT_EQ(samplesFor(0.1, 0.1, 32, 4096), 32u);
  EXPECT_EQ(samplesFor(0.05, 0.1, 32, 4096), 128u);
  EXPECT_EQ(samplesFor(0.04, 0.1, 32, 4096), 256u);
  EXPECT_EQ(samplesFor(0.1, 0, 32, 4096), 32u);
  EXPECT_EQ(samplesFor(0.001, 1, 32, 4000), 4000u);
}

TEST(Error, replicatesOnlyWhereTheErrorIsAskedFor) {
  edit::FrameSettingsT frame;
  frame.channels = RT_RGBA;
  EXPECT_FALSE(replicatesOf(frame, 1024, 0).many());
  frame.channels = RT_RGBA | RT_ERROR;
  EXPECT_FALSE(replicatesOf(frame, 31, 0).many());
  EXPECT_EQ(replicatesOf(frame, 32, 0).size(), 2u);
  EXPECT_EQ(replicatesOf(frame, 1000, 0).size(), 32u); // 31 and a part
  frame.replicates = 1;
  EXPECT_FALSE(replicatesOf(frame, 1024, 0).many());
  frame.channels = RT_RGBA, frame.replicates = 8;
  EXPECT_EQ(replicatesOf(frame, 64, 0).size(), 8u);
}
