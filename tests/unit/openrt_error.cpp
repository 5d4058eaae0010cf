// openrt_error.cpp: intervals of pixels from sums of samples.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "render/film/error.h"
#include "render/wave/random_numbers.h"

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

// One pixel by itself, or the first of a row.
PixelError errorOf(std::initializer_list<const PixelSums*> row, const Replicates& replicates) {
  std::vector<PixelError> errors(row.size());
  std::vector<PixelSums> pixels;
  for (const PixelSums* sums : row) pixels.push_back(*sums);
  tileErrors(uint32_t(row.size()), pixels, replicates, errors);
  return errors[0];
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
  const PixelError e = errorOf({&sums}, four);
  EXPECT_NEAR(e.halfWidth[0], 3.18245 * std::sqrt(5.0 / 3 / 4), 1e-5);
  EXPECT_NEAR(e.halfWidth[1], 2 * e.halfWidth[0], 1e-5);
  EXPECT_EQ(e.halfWidth[2], 0);
  EXPECT_FALSE(e.trusted); // four are too few
}

TEST(Error,
     theLastReplicateMayBeShorter) { // sums 3 and 5, and one sample: variance of a sum 2, of the
                                     // mean of 5 samples 2 / (2 * 5)
  const Replicates two{0, 1};
  const PixelSums sums = sumsOf({1, 2, 2, 3, 4}, two);
  EXPECT_NEAR(errorOf({&sums}, two).halfWidth[0], 12.7062 * std::sqrt(.5 * 2 / 5), 1e-5);
}

TEST(Error, largeNumbersWithSmallDifferences) {
  const Replicates two{0, 1};
  const PixelSums sums = sumsOf({1e6f, 1e6f + 2, 1e6f + 1, 1e6f + 3}, two); // means differ by 1
  EXPECT_NEAR(errorOf({&sums}, two).halfWidth[0], 12.7062 * 0.5, 1e-3);
}

TEST(Error, withoutReplicatesItIsThatOfIndependentSamplesAndNotTrusted) {
  const PixelSums sums = sumsOf({0, 1, 0, 1, 0, 1, 0, 1}, {});
  const PixelError e = errorOf({&sums}, {});
  EXPECT_NEAR(e.halfWidth[0], 2.36462 * std::sqrt(2.0 / 7 / 8), 1e-5);
  EXPECT_EQ(e.halfWidth[0], independentError(sums).halfWidth[0]);
  EXPECT_FALSE(e.trusted);
}

TEST(Error, oneSampleSaysNothing) {
  const PixelError e = independentError(sumsOf({1}, {}));
  EXPECT_TRUE(std::isinf(e.halfWidth[0]));
  EXPECT_EQ(e.relative, 1);
  EXPECT_FALSE(e.trusted);
}

// A hundred and twenty-eight samples in sixteen replicates, normal enough; `seed` tells pixels
// apart.
std::vector<float> calmSamples(uint32_t seed, float scale = 1) {
  std::vector<float> samples;
  for (uint32_t i = 0; i < 128; i++) {
    float sum = 0;
    for (uint32_t k = 0; k < 4; k++) sum += toUnit(hash(hash(seed, i), k));
    samples.push_back(scale * sum);
  }
  return samples;
}
const Replicates sixteen{0, 3};

TEST(Error, inTheDarkAnUpperBoundFromThePixelsAround) {
  PixelSums dark = sumsOf(std::vector<float>(128, 0.0f), sixteen),
            lit = sumsOf(calmSamples(1), sixteen);
  dark.random = lit.random = RandomPath::all;
  EXPECT_TRUE(std::isinf(errorOf({&dark}, sixteen).halfWidth[0])); // nothing is known
  // Out of the window's reach: 3 / N of the largest sample, N those of the window's three pixels.
  const PixelError far = errorOf({&dark, &dark, &dark, &lit}, sixteen);
  EXPECT_NEAR(far.halfWidth[0], lit.largest[0] * 2.9957 / 128 / 3, 1e-4);
  EXPECT_FALSE(far.trusted);
}

// A small thing that all paths have missed may still hide some of that light.
TEST(Error, equalLightIsTrustedWithABoundWhereAllRandomPathsHaveFoundIt) {
  PixelSums lit = sumsOf(std::vector<float>(128, 0.3f), sixteen);
  lit.random = RandomPath::all;
  EXPECT_FALSE(errorOf({&lit}, sixteen).trusted); // it may be light that needs no random path
  lit.random = RandomPath::decided;
  const PixelError e = errorOf({&lit}, sixteen);
  EXPECT_TRUE(e.trusted && !e.constant && !e.dark);
  EXPECT_NEAR(e.halfWidth[0], 2.9957 / 128 * .3, 1e-6);
}

TEST(Error, whereNothingIsRandomEqualSamplesAreExact) {
  const PixelSums sums = sumsOf(std::vector<float>(128, 0.3f), sixteen);
  const PixelError e = errorOf({&sums}, sixteen);
  EXPECT_EQ(e.halfWidth[0], 0);
  EXPECT_TRUE(e.trusted && e.constant);
}

TEST(Error, pixelsThatDifferByChanceShareTheirVariance) {
  std::vector<PixelSums> sums;
  for (uint32_t i = 0; i < 25; i++) {
    sums.push_back(sumsOf(calmSamples(i), sixteen));
    sums.back().random = RandomPath::all;
  }
  std::vector<PixelError> errors(25);
  tileErrors(5, sums, sixteen, errors);
  // Standard deviation of a sample sqrt(4 / 12); of the middle pixel's interval little is left to
  // chance.
  EXPECT_NEAR(errors[12].halfWidth[0], 1.96 * std::sqrt(4.0 / 12 / 128),
              .15 * errors[12].halfWidth[0]);
  for (const PixelError& e : errors) EXPECT_TRUE(e.trusted);
}

TEST(Error,
     whereNoiseIsAsStrongAsTheLightVariancesArePooledRelativeToIt) { // a quarter from row to row
  std::vector<PixelSums> sums;
  float scale = 1;
  for (uint32_t y = 0; y < 5; y++, scale /= 4)
    for (uint32_t x = 0; x < 5; x++) {
      std::vector<float> samples = calmSamples(5 * y + x, scale);
      sums.push_back(sumsOf(samples, sixteen));
      sums.back().random = RandomPath::all;
    }
  std::vector<PixelError> errors(25);
  tileErrors(5, sums, sixteen, errors);
  scale = 1;
  for (uint32_t y = 0; y < 5; y++, scale /= 4) {
    const float right = scale * 1.96f * std::sqrt(4.0f / 12 / 128);
    EXPECT_NEAR(errors[5 * y + 2].halfWidth[0], right, .35 * right) << y;
  }
}

TEST(Error, pixelsThatReallyDifferKeepTheirOwn) {
  PixelSums calm = sumsOf(calmSamples(1), sixteen), wild = sumsOf(calmSamples(2, 50), sixteen);
  calm.random = wild.random = RandomPath::all;
  const float alone = errorOf({&wild}, sixteen).halfWidth[0];
  EXPECT_NEAR(errorOf({&wild, &calm, &calm}, sixteen).halfWidth[0], alone, .25 * alone);
}

TEST(Error, oneBrightSampleIsNotTrusted) {
  PixelSums calm = sumsOf(calmSamples(1), sixteen);
  std::vector<float> samples = calmSamples(2);
  samples[20] = 10000;
  PixelSums wild = sumsOf(samples, sixteen);
  calm.random = wild.random = RandomPath::all;
  EXPECT_TRUE(errorOf({&calm, &calm}, sixteen).trusted);
  EXPECT_FALSE(errorOf({&wild, &calm}, sixteen).trusted);
  EXPECT_FALSE(errorOf({&calm, &wild}, sixteen).trusted)
      << "its neighbour may have missed what it met";
  EXPECT_FALSE(errorOf({&calm, &calm, &calm, &wild}, sixteen).trusted)
      << "also out of the window's reach";
}

// Its interval is a bound, so it keeps its trust.
TEST(Error, aConstantPixelBesideAnEdgeGetsABound) {
  ErrorMap map(5, 3, ErrorMap::Kind::full);
  for (size_t i = 0; i < 15; i++) {
    PixelError e;
    e.mean[0] = i % 5 < 3 ? 0.0f : 1.0f;
    e.samples = 30;
    e.trusted = e.constant = true;
    e.relative = 0;
    e.noise.finished = true;
    e.noise.scale = 1;
    map.store(i, e);
  }
  std::vector<size_t> changed;
  map.doubtConstants([&](size_t pixel, const float half[3], bool known) {
    EXPECT_TRUE(known);
    changed.push_back(pixel);
    EXPECT_NEAR(half[0], 2.9957 / 30, 1e-6);
    EXPECT_EQ(half[1], 0);
  });
  // All but one; also those at the border, whose neighbours are not known.
  EXPECT_EQ(changed, (std::vector<size_t>{0, 1, 2, 3, 4, 5, 7, 8, 9, 10, 11, 12, 13, 14}));
  EXPECT_EQ(map.summary().trusted, 15u);
  EXPECT_EQ(map.summary().pixels, 15u);
  EXPECT_GT(map.summary().halfWidth, 0);
}

// With n rays and m light paths that have found nothing, light is missing that three of all n + m
// would find.
TEST(Error, lightPathsLowerTheBoundOfWhatRaysHaveNotFound) {
  Ledger ledger;
  constexpr double paths = 1000;
  for (int i = 0; i < 500; i++) ledger.unsampled.send({1, 1, 1}, 8);
  const double rays = ledger.missedByTile(paths);
  const double about = .02 * rays; // the bound of rays is an approximation
  EXPECT_NEAR(rays, ruleOfThree * 8 / paths, about);
  EXPECT_EQ(rays, ledger.missedRadiance(ledger, paths));
  ledger.unsampled.byLightPath = 8; // each tells as much as a ray
  EXPECT_NEAR(ledger.missedByTile(paths), rays / 2, about);
  ledger.unsampled.byLightPath = 8e-3;
  EXPECT_NEAR(ledger.missedByTile(paths), rays / 1001, about / 1001);
  EXPECT_EQ(ledger.missedRadiance(ledger, paths), rays) << "the picture's own bound";
  for (int i = 0; i < 40; i++) ledger.unsampledSky.send({1, 1, 1}, 2);
  EXPECT_NEAR(ledger.missedByTile(paths), rays / 1001 + ruleOfThree * 2 / paths, about)
      << "no light paths come from the sky";
  ledger.unsampledSky.byLightPath = 2;
  EXPECT_NEAR(ledger.missedByTile(paths), rays / 1001 + ruleOfThree / paths, .2 * about)
      << "light paths come from its sun";
}

TEST(Error, whatMayBeMissingTakesTheTrustOfNarrowIntervalsAndWidensThatOfTheMean) {
  constexpr size_t pixels = 400;
  ErrorMap map(20, 20, ErrorMap::Kind::full);
  for (size_t i = 0; i < pixels; i++) {
    PixelError e;
    e.samples = 64;
    e.trusted = true;
    e.relative = i == 0 ? .5f : .1f;
    e.noise.finished = e.noise.random = true;
    e.noise.scale = 2;
    e.noise.own = .02f;
    e.noise.second = .001f;
    e.noise.square = 1e-6f;
    e.noise.largest = .02f;
    map.store(i, e);
  }
  const double before = map.summary().meanInterval;
  ASSERT_LT(before, .3);
  EXPECT_EQ(map.summary().trusted, pixels);
  // The bound is more than a tenth of 2, and less than the half that it is at pixel 0. A tile that
  // begins elsewhere reports the picture's own numbers of its pixels.
  std::vector<size_t> distrusted;
  const auto add = [&](size_t pixel) { distrusted.push_back(pixel); };
  map.addMissing({0, 0, 20, 8}, .3, .2, add);
  EXPECT_EQ(distrusted.size(), 159u);
  EXPECT_EQ(distrusted.front(), 1u);
  map.addMissing({12, 8, 20, 20}, .3, .2, add);
  EXPECT_EQ(distrusted.at(159), 8u * 20 + 12);
  map.addMissing({0, 8, 12, 20}, .3, .2, add);
  EXPECT_EQ(distrusted.size(), pixels - 1);
  EXPECT_EQ(map.summary().trusted, 1u);
  EXPECT_NEAR(map.summary().meanInterval, std::hypot(before, .1), 1e-6);
}

TEST(Error, whatChanceMayHaveMissedDoesNotDependOnTheColourOfALamp) {
  const Vec3f white{.5f, .5f, .5f}, tinted{.5f, .2f, .1f}, blue{0, 0, 9}, weakest{0, 0, 4.4f};
  UnsampledLight a, b;
  a.send(white, 9);
  b.send(tinted, 9);
  EXPECT_DOUBLE_EQ(a.light, 4.5);
  EXPECT_DOUBLE_EQ(b.light, 4.5); // the lamp may be red
  a.meet(blue, 9);
  EXPECT_EQ(a.met, 1);
  a.meet(weakest, 9); // less than half
  EXPECT_EQ(a.met, 1);
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
  frame.channels = RT_RGBA;
  frame.replicates = 8;
  EXPECT_EQ(replicatesOf(frame, 64, 0).size(), 8u);
}
