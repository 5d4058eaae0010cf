// openrt_picture_error.cpp: the error of a picture as a whole, for synthetic pixels whose errors
// are known.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "render/film/error.h"
#include "render/film/ledger.h"
#include "render/film/picture_error.h"

using namespace openrt;

namespace {

constexpr uint32_t edge = 16, pixels = edge * edge, perPixel = 64;
const Replicates sixteen{0, 2};

struct Outcome {
  int inside = 0, above = 0; // pictures off by at most the stated error, and by more
  double said = 0, was = 0;
};

// Makes pictures of white pixels whose samples have a mean of `truth(pixel)`.
template <class Sample> Outcome pictures(int count, Sample sample, double (*truth)(uint32_t)) {
  Outcome out;
  std::mt19937 random(7);
  for (int n = 0; n < count; n++) {
    std::vector<PixelSums> sums(pixels);
    double off = 0;
    for (uint32_t i = 0; i < pixels; i++) {
      for (uint32_t s = 0; s < perPixel; s++) {
        const auto x = float(sample(random, i));
        const float radiance[3] = {x, x, x};
        sums[i].add(radiance, 1);
        sums[i].addTails(radiance);
        if (sixteen.indexOf(s + 1) == 0) sums[i].closeReplicate();
      }
      sums[i].random = true;
      const double mean = sums[i].rgba[0] / perPixel;
      off += std::min(1.0, 3 * std::fabs(mean - truth(i)) / (3 * mean + .03)) / pixels;
    }
    std::vector<PixelError> errors(pixels);
    tileErrors(edge, sums, sixteen, errors);
    std::vector<PixelNoise> noise;
    for (const PixelError& e : errors) noise.push_back(e.noise);
    const std::vector<float> doubted(pixels, std::numeric_limits<float>::quiet_NaN());
    const PictureError e = pictureError(edge, noise, doubted);
    out.inside += std::fabs(off - e.mean) <= e.interval;
    out.above += off > e.mean + e.interval;
    out.said += e.mean / count;
    out.was += off / count;
  }
  printf("said %.4f, was %.4f, %d of %d inside, %d above\n", out.said, out.was, out.inside, count,
         out.above);
  return out;
}

void expectHeld(const Outcome& o, int count, double slack) {
  EXPECT_GE(o.inside, int(.88 * count));
  EXPECT_NEAR(o.said, o.was, slack * o.was);
}

} // namespace

TEST(PictureError, ofNormalNoise) {
  const auto sample = [](std::mt19937& r, uint32_t) {
    return std::uniform_real_distribution<>(.5, 1.5)(r);
  };
  expectHeld(pictures(60, sample, [](uint32_t) { return 1.0; }), 60, .03);
}

// One sample in every few is bright, over an evenly lit floor.
TEST(PictureError, ofLightThatOnePixelInAFewHasMet) {
  for (const double chance : {.02, .005, .001}) {
    const auto sample = [=](std::mt19937& r, uint32_t) {
      return std::bernoulli_distribution(chance)(r) ? 20.0 : .2;
    };
    static double mean;
    mean = .2 + chance * (20 - .2);
    expectHeld(pictures(40, sample, [](uint32_t) { return mean; }), 40, .15);
  }
}

TEST(PictureError, ofJumpsAmongNormalNoise) {
  const auto sample = [](std::mt19937& r, uint32_t) {
    return std::uniform_real_distribution<>(0, 2)(r) +
           (std::bernoulli_distribution(.002)(r) ? 25.0 : 0);
  };
  expectHeld(pictures(40, sample, [](uint32_t) { return 1.05; }), 40, .15);
}

TEST(PictureError, ofLightOverManyDecades) {
  const auto sample = [](std::mt19937& r, uint32_t i) {
    return std::pow(3.0, -double(i % edge)) * std::uniform_real_distribution<>(0, 2)(r);
  };
  expectHeld(pictures(40, sample, [](uint32_t i) { return std::pow(3.0, -double(i % edge)); }), 40,
             .05);
}

TEST(PictureError, ofWhatIsCompletelyUnknownAnythingIsSaid) {
  std::vector<PixelNoise> noise(4);
  for (PixelNoise& p : noise) {
    p.finished = p.random = true;
    p.scale = .03f;
  }
  const std::vector<float> doubted(4, std::numeric_limits<float>::quiet_NaN());
  const PictureError e = pictureError(2, noise, doubted);
  EXPECT_DOUBLE_EQ(e.mean, .5);
  EXPECT_DOUBLE_EQ(e.interval, .5);
}

// Equal samples on random paths.
TEST(PictureError, aPlainBackgroundBehindALensIsNotAnError) {
  std::vector<PixelNoise> noise(256);
  for (PixelNoise& p : noise) {
    p.finished = p.random = true;
    p.scale = 1.03f;
    p.largest = 1.0f / 64;
  }
  noise[17].own = .1f;
  noise[17].second = .004f;
  const std::vector<float> doubted(256, std::numeric_limits<float>::quiet_NaN());
  const PictureError e = pictureError(16, noise, doubted);
  EXPECT_NEAR(e.mean, .1 / 1.03 / 256, 1e-4);
  EXPECT_LT(e.mean + e.interval, .01);
}

// A tenth of the pixels hold an edge and are then entirely wrong.
TEST(PictureError, pixelsInDoubtHoldAnEdgeOrNone) {
  std::vector<PixelNoise> noise(256);
  for (PixelNoise& p : noise) {
    p.finished = true;
    p.scale = .03f;
    p.own = 1;
  }
  const std::vector<float> doubted(256, .1f);
  const PictureError e = pictureError(16, noise, doubted);
  EXPECT_NEAR(e.mean, .1, 1e-6);
  EXPECT_GE(e.interval, .1); // there may be none
  EXPECT_LT(e.interval, .15);
}

TEST(PictureError, whatNoPathHasMetIsBoundByTheRuleOfThree) {
  Ledger ledger;
  const auto missed = [&ledger] { return ledger.missedRadiance(ledger, 1000); };
  EXPECT_EQ(missed(), 0);
  const Vec3f grey{.1f, .1f, .1f}, bright{40, 40, 40}, dim{20, 20, 20};
  for (int i = 0; i < 100; i++)
    ledger.unsampled.send(grey, 150); // .1 of radiance 150 for each of 100 rays in 1000 samples
  ledger.unsampled.meet(dim, 150);
  EXPECT_NEAR(missed(), 2.996 * .1 * 150 / 1000, 5e-4);
  // One path has hit it: with 95 % confidence at most 4.74 are expected.
  ledger.unsampled.meet(bright, 150);
  EXPECT_NEAR(missed(), 3.744 * .1 * 150 / 1000, 5e-4);
  // Enough hits: the samples show the light.
  for (int i = 0; i < 31; i++) ledger.unsampled.meet(bright, 150);
  EXPECT_EQ(missed(), 0);
  ledger.unsampledSky.send(grey, 30);          // no ray of another kind has hit anything
  EXPECT_NEAR(missed(), .1 * 30 / 1000, 1e-3); // at most all of them
  Ledger tile;
  tile.unsampledSky.send(grey, 30);
  EXPECT_NEAR(tile.missedRadiance(ledger, 10), .1 * 30 / 10, 1e-3);
}

// E|K - a| / (sqrt(2/pi) E sqrt(K)) for a Poisson variable K, summed by hand.
TEST(PictureError, theShapeOfPureJumps) {
  EXPECT_NEAR(tailShape(0, 1).factor, .7358 / (.79788 * .7733), .003);
  EXPECT_NEAR(tailShape(0, .01).factor, 2 / .79788, .03);
  EXPECT_NEAR(tailShape(0, .01).missing, .5, .01);
  EXPECT_NEAR(tailShape(0, 20).factor, 1, .01);
  EXPECT_NEAR(tailShape(0, 20).missing, 0, 1e-4);
  EXPECT_NEAR(tailShape(1000, .1).factor, 1, .01); // almost no jumps
}
