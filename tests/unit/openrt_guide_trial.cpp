// openrt_guide_trial.cpp: Tests where a trial keeps the photons that guide rays.
#include <vector>

#include <gtest/gtest.h>

#include "render/path/guide_trial.h"

namespace openrt {
namespace {

constexpr uint32_t cells = 8, raysOfACell = 1000;

// Two pixels of the given mean and variance of the samples.
std::vector<PixelSums> pixels(double mean, double variance) {
  std::vector<PixelSums> sums(2);
  for (PixelSums& s : sums) {
    s.samples = 16;
    for (int k = 0; k < 3; k++) {
      s.rgba[k] = 16 * mean;
      s.delta2[k] = 15 * variance;
    }
  }
  return sums;
}

RayCounters rays(uint64_t n) {
  RayCounters counters;
  counters.secondary = n;
  return counters;
}

void sendFromAll(GuideTrial& trial) {
  for (uint32_t c = 0; c < cells; c++)
    for (uint32_t r = 0; r < raysOfACell; r++) trial.send(c);
}

// A few rays are enough for light that is very rare: they are as good as many.
TEST(GuideTrials, RareLightGetsAFewRays) {
  GuideTrial trial(cells);
  sendFromAll(trial);
  for (uint32_t c = 0; c < cells; c++) trial.meet(c, {1, 1, 1}, 1e-4);
  trial.endBlock(pixels(1, 1));
  for (const float share : trial.choose(rays(20'000))) {
    EXPECT_GT(share, 0);
    EXPECT_LT(share, 1);
  }
}

TEST(GuideTrials, MuchLightThatIsNotSoRareGetsARayAtEveryHit) {
  GuideTrial trial(cells);
  sendFromAll(trial);
  for (uint32_t c = 0; c < cells; c++)
    for (int i = 0; i < 400; i++) trial.meet(c, {1, 1, 1}, .05);
  trial.endBlock(pixels(1, 1));
  EXPECT_EQ(trial.choose(rays(20'000)), std::vector<float>(cells, 1));
}

// Light that BSDF sampling finds as often is not worth another ray.
TEST(GuideTrials, RaysThatFindWhatOthersFindAreNot) {
  GuideTrial trial(cells);
  sendFromAll(trial);
  for (uint32_t c = 0; c < cells; c++) trial.meet(c, {.1f, .1f, .1f}, .5);
  trial.endBlock(pixels(1, 1));
  EXPECT_EQ(trial.choose(rays(20'000)), std::vector<float>(cells, 0));
}

TEST(GuideTrials, TheCellsThatGainGetTheMostRays) {
  GuideTrial trial(cells);
  sendFromAll(trial);
  trial.meet(3, {1, 1, 1}, 1e-2);
  trial.endBlock(pixels(1, 1));
  const std::vector<float> chosen = trial.choose(rays(20'000));
  for (uint32_t c = 0; c < cells; c++) {
    if (c == 3) continue;
    EXPECT_LT(chosen[c], chosen[3]);
  }
}

// Errors count relative to the brightness, so the unit of radiance has no influence.
TEST(GuideTrials, TheUnitOfLightDoesNotMatter) {
  std::vector<std::vector<float>> chosen;
  for (const float unit : {1.f, 1000.f}) {
    GuideTrial trial(cells);
    sendFromAll(trial);
    trial.meet(0, {unit, unit, unit}, 1e-2);
    trial.meet(1, {unit, unit, unit}, 1e-2);
    trial.endBlock(pixels(double(unit), double(unit) * double(unit)));
    chosen.push_back(trial.choose(rays(20'000)));
  }
  EXPECT_EQ(chosen[0], chosen[1]);
  EXPECT_GT(chosen[0][0], 0);
  EXPECT_EQ(chosen[0][0], chosen[0][1]);
}

// Where every cell must send rays, those without gain send the fewest.
TEST(GuideTrials, EveryCellSendsRaysIfItMust) {
  GuideTrial trial(cells);
  sendFromAll(trial);
  trial.meet(3, {1, 1, 1}, 1e-2);
  trial.endBlock(pixels(1, 1));
  const std::vector<float> chosen = trial.choose(rays(20'000), true);
  for (uint32_t c = 0; c < cells; c++) {
    EXPECT_GE(chosen[c], GuideTrial::shares[GuideTrial::leastAlways]);
    EXPECT_LE(chosen[c], chosen[3]);
  }
  GuideTrial none(cells);
  none.endBlock(pixels(1, 1));
  EXPECT_EQ(none.choose(rays(1000), true),
            std::vector<float>(cells, GuideTrial::shares[GuideTrial::leastAlways]));
}

TEST(GuideTrials, NoRaysAndBlackPicturesKeepNothing) {
  GuideTrial none(cells);
  none.endBlock(pixels(1, 1));
  EXPECT_EQ(none.choose(rays(1000)), std::vector<float>(cells, 0));
  GuideTrial black(cells);
  sendFromAll(black);
  black.endBlock(pixels(0, 0));
  EXPECT_EQ(black.choose(rays(20'000)), std::vector<float>(cells, 0));
}

} // namespace
} // namespace openrt
