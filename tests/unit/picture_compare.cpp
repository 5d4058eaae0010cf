// picture_compare.cpp: Tests vv compare's statistics: noise is not called a difference, differences
// are found, and FLIP is that of the paper.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include "libpicture/compare/drawing.h"
#include "libpicture/compare/flip.h"
#include "libpicture/compare/noise_test.h"
#include "openrt/openrt.h"

namespace {

using namespace picture;

constexpr int side = 48;

Picture made(const std::function<float()>& value, int width = side, int height = side) {
  Picture picture;
  picture.width = width;
  picture.height = height;
  std::vector<float>& rgba = picture.planes[RT_RGBA];
  rgba.resize(4 * size_t(width) * size_t(height), 1);
  for (size_t i = 0; i < rgba.size(); ++i)
    if (i % 4 < 3) rgba[i] = value();
  return picture;
}

class Noises : public testing::Test {
 public:
  std::mt19937 random{1};
  // Means of so many samples with the mean 1 and the standard deviation .5.
  Picture normal(int samples) {
    std::normal_distribution<float> one(1, .5f / std::sqrt(float(samples)));
    return made([&] { return one(random); });
  }
  // Means of samples of which one in a thousand is 100 and the others are .2.
  Picture fireflies(int samples) {
    std::binomial_distribution<int> hits(samples, .001);
    return made([&] { return .2f + 100 * float(hits(random)) / float(samples); });
  }
  // Returns in how many of the pairs noise is called a difference.
  int falseAlarms(int pairs, const std::function<Picture()>& a, const std::function<Picture()>& b,
                  Noise noise, double rate = falseAlarmRate) {
    int wrong = 0;
    for (int i = 0; i < pairs; ++i) wrong += !testNoise(a(), b(), noise, rate).isSame;
    return wrong;
  }
};

// As a reconstruction filter of 3x3 pixels spreads samples.
Picture filtered(const Picture& picture) {
  constexpr float weights[] = {.157f, .686f, .157f};
  Picture out = picture;
  std::vector<float>& to = out.planes[RT_RGBA];
  const std::vector<float>& from = picture.planes.at(RT_RGBA);
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x)
      for (size_t k = 0; k < 3; ++k) {
        float sum = 0;
        for (int j = -1; j <= 1; ++j)
          for (int i = -1; i <= 1; ++i) {
            const int column = std::clamp(x + i, 0, picture.width - 1),
                      row = std::clamp(y + j, 0, picture.height - 1);
            sum += weights[i + 1] * weights[j + 1] *
                   from[4 * (size_t(row) * size_t(picture.width) + size_t(column)) + k];
          }
        to[4 * (size_t(y) * size_t(picture.width) + size_t(x)) + k] = sum;
      }
  return out;
}

void add(Picture& picture, int x, int y, int width, int height, float value) {
  for (int j = y; j < y + height; ++j)
    for (int i = x; i < x + width; ++i)
      for (size_t k = 0; k < 3; ++k)
        picture.planes[RT_RGBA][4 * (size_t(j) * size_t(picture.width) + size_t(i)) + k] += value;
}

// --- Noise is no difference ---

TEST_F(Noises, OfEqualPicturesIsNoDifference) {
  EXPECT_EQ(falseAlarms(
                100, [&] { return normal(16); }, [&] { return normal(16); }, Noise::equal),
            0);
  EXPECT_EQ(falseAlarms(
                100, [&] { return fireflies(16); }, [&] { return fireflies(16); }, Noise::equal),
            0);
}

TEST_F(Noises, OfFewSamplesAgainstManyIsNoDifference) {
  EXPECT_EQ(falseAlarms(
                100, [&] { return normal(4); }, [&] { return normal(4096); }, Noise::unknown),
            0);
  EXPECT_EQ(
      falseAlarms(
          100, [&] { return fireflies(16); }, [&] { return fireflies(4096); }, Noise::unknown),
      0);
  EXPECT_EQ(
      falseAlarms(
          100, [&] { return fireflies(4096); }, [&] { return fireflies(16); }, Noise::unknown),
      0);
}

// The same where the rare light is weaker than the rest, which has no noise; and at the edge of a
// lamp there is noise that is no rare light.
TEST_F(Noises, OfWeakRareLightIsNoDifference) {
  const auto weak = [&](int samples) {
    std::binomial_distribution<int> hits(samples, .001);
    return made([&] { return 1 + 4.8f * float(hits(random)) / float(samples); });
  };
  EXPECT_EQ(falseAlarms(
                100, [&] { return weak(16); }, [&] { return weak(4096); }, Noise::unknown),
            0);
}

TEST_F(Noises, AnEdgeHidesNoDifference) {
  const auto withLamp = [&](float level) {
    Picture picture = normal(64);
    add(picture, 0, 0, side, side, level);
    std::uniform_real_distribution<float> cover(8, 16); // pixels that the lamp covers in part
    for (int x = 8; x < 16; ++x) add(picture, x, 7, 1, 1, cover(random));
    add(picture, 8, 8, 8, 8, 16);
    return picture;
  };
  EXPECT_EQ(falseAlarms(
                60, [&] { return withLamp(0); }, [&] { return withLamp(0); }, Noise::unknown),
            0);
  EXPECT_FALSE(testNoise(withLamp(0), withLamp(.05f), Noise::unknown).isSame);
}

// Few samples miss rare light nearly everywhere, which equal noise cannot. Whoever says that the
// noise is equal where it is not is told of a difference.
TEST_F(Noises, MustBeEqualWhereThatIsSaid) {
  EXPECT_GT(falseAlarms(
                10, [&] { return fireflies(16); }, [&] { return fireflies(4096); }, Noise::equal),
            5);
}

TEST_F(Noises, ThatAFilterSpreadsIsNoDifference) {
  EXPECT_EQ(falseAlarms(
                60, [&] { return filtered(normal(16)); }, [&] { return filtered(normal(16)); },
                Noise::equal),
            0);
  EXPECT_EQ(falseAlarms(
                60, [&] { return filtered(fireflies(16)); },
                [&] { return filtered(fireflies(16)); }, Noise::equal),
            0);
  EXPECT_NEAR(testNoise(filtered(normal(16)), filtered(normal(16)), Noise::equal).correlation, 3.7,
              .5);
}

// The rate is an upper bound: it holds for other rates, too, where it can be counted.
TEST_F(Noises, HasTheStatedRate) {
  const int wrong = falseAlarms(
      400, [&] { return normal(16); }, [&] { return normal(16); }, Noise::equal, .05);
  EXPECT_LE(wrong, 33); // three standard deviations above 20
}

// Promised by --variance and by error bars: pixels, too.
TEST_F(Noises, OfPixelsWithErrorBarsIsNoDifference) {
  const auto barred = [&] {
    Picture picture = normal(16);
    picture.planes[RT_ERROR].assign(3 * side * side, 2.13f * .125f);
    picture.planes[RT_TRUST].assign(side * side, 1);
    return picture;
  };
  EXPECT_EQ(falseAlarms(60, barred, barred, Noise::unknown), 0);
  EXPECT_EQ(testNoise(barred(), barred(), Noise::unknown).pixels, size_t(side * side));
}

// --- Differences are found ---

TEST_F(Noises, ABrighterSquareIsFoundAndNamed) {
  const Picture a = normal(16);
  Picture b = normal(16);
  add(b, 16, 12, 16, 16, .25f); // two standard deviations of a pixel
  for (const Noise noise : {Noise::equal, Noise::unknown}) {
    const NoiseTest test = testNoise(a, b, noise);
    ASSERT_FALSE(test.isSame);
    const ChangedPlace& place = test.changes.at(0);
    EXPECT_LT(place.x, 32);
    EXPECT_GT(place.x + place.width, 16);
    EXPECT_LT(place.y, 28);
    EXPECT_GT(place.y + place.height, 12);
    EXPECT_GT(place.change, .05);
    EXPECT_LT(place.chance, 1e-9);
    EXPECT_NEAR(place.before, 1, .1);
  }
}

// Most of it is without noise, and a change is not taken for samples that a filter has spread.
TEST_F(Noises, AShadowIsFoundInAPictureWithHardlyAnyNoise) {
  std::normal_distribution<float> tiny(0, 1e-3f);
  const auto smooth = [&] {
    int i = 0;
    return made([&] { return 1 + float(i++ / 3 % side) / side + tiny(random); });
  };
  for (const int size : {12, 20, 30}) {
    Picture b = smooth();
    add(b, 4, 5, size, 10, -.9f);
    for (const Noise noise : {Noise::equal, Noise::unknown}) {
      const NoiseTest test = testNoise(smooth(), b, noise);
      EXPECT_FALSE(test.isSame) << size;
      EXPECT_LT(test.correlation, 2.5) << size;
    }
  }
}

// A change as large as those that the test says it would have found.
TEST_F(Noises, ChangesAreFoundThatWouldBe) {
  const SmallestChange least = testNoise(normal(16), normal(16), Noise::equal).least.back();
  EXPECT_EQ(least.width, side);
  EXPECT_EQ(least.height, side);
  EXPECT_LT(least.change, .05);
  int found = 0;
  for (int i = 0; i < 20; ++i) {
    Picture b = normal(16);
    add(b, 0, 0, side, side, float(1.3 * least.change));
    found += !testNoise(normal(16), b, Noise::equal).isSame;
  }
  EXPECT_GE(found, 18);
}

TEST_F(Noises, APixelIsFoundByItsErrorBars) {
  Picture a = made([] { return 1.0f; });
  a.planes[RT_ERROR].assign(3 * side * side, .01f);
  a.planes[RT_TRUST].assign(side * side, 1);
  Picture b = a;
  add(b, 7, 9, 1, 1, 2);
  const NoiseTest test = testNoise(a, b, Noise::unknown);
  ASSERT_EQ(test.changes.size(), 1u);
  EXPECT_EQ(test.changes[0].x, 7);
  EXPECT_EQ(test.changes[0].y, 9);
  EXPECT_EQ(test.changes[0].width, 1);
  EXPECT_EQ(test.changes[0].colour, 3);
  b.planes[RT_TRUST][9 * side + 7] = 0;
  EXPECT_TRUE(testNoise(a, b, Noise::unknown).isSame) << "not trusted";
}

TEST_F(Noises, OneColourIsEnough) {
  const Picture a = normal(16);
  Picture b = normal(16);
  for (size_t i = 1; i < b.planes[RT_RGBA].size(); i += 4) b.planes[RT_RGBA][i] *= 1.1f;
  const NoiseTest test = testNoise(a, b, Noise::equal);
  ASSERT_FALSE(test.isSame);
  EXPECT_EQ(test.changes[0].colour, 1);
}

TEST_F(Noises, SmoothDifferencesAreTold) {
  const Picture a = made([] { return 1.0f; });
  Picture b = a;
  int i = 0;
  for (float& v : b.planes[RT_RGBA]) v += .1f * std::sin(.05f * float(i++ / 4 % side));
  const NoiseTest test = testNoise(a, b, Noise::equal);
  EXPECT_FALSE(test.isSame);
  EXPECT_TRUE(test.isSmooth);
  EXPECT_FALSE(testNoise(normal(4), normal(4), Noise::equal).isSmooth);
}

// --- What files do to numbers ---

TEST_F(Noises, RoundingIsNoDifference) {
  Picture a = normal(16), b = a;
  for (float& v : b.planes[RT_RGBA]) { // to the 11 bits of a half
    int exponent = 0;
    const float mantissa = std::frexp(v, &exponent);
    v = std::ldexp(std::floor(mantissa * 2048) / 2048, exponent);
  }
  EXPECT_TRUE(testNoise(a, b, Noise::equal).isSame);
  EXPECT_EQ(testNoise(a, b, Noise::equal).different, 0u);
  a = made([] { return 100 / 255.f; });
  a.linear = false;
  b = a;
  add(b, 0, 0, side, side, 1 / 255.f);
  EXPECT_TRUE(testNoise(a, b, Noise::equal).isSame) << "one step of 8 bits";
  add(b, 0, 0, side, side, 1 / 255.f);
  EXPECT_FALSE(testNoise(a, b, Noise::equal).isSame) << "two steps";
}

TEST_F(Noises, NumbersThatAreNotFiniteAreLeftOut) {
  Picture a = normal(16);
  Picture b = normal(16);
  b.planes[RT_RGBA][0] = std::numeric_limits<float>::quiet_NaN();
  b.planes[RT_RGBA][4] = std::numeric_limits<float>::infinity();
  b.planes[RT_RGBA][8] = -3e38f;
  const NoiseTest test = testNoise(a, b, Noise::unknown);
  EXPECT_EQ(test.found, 0u);
  EXPECT_EQ(test.notFinite, 3u);
  EXPECT_EQ(test.oneSided, 3u);
  EXPECT_FALSE(test.isSame) << "no noise makes a pixel that is not finite";
  EXPECT_TRUE(std::isfinite(flipOf(a, b).mean));
  for (const float z : standardErrors(a, b)) EXPECT_TRUE(std::isfinite(z));
  for (const size_t i : {0, 4, 8}) a.planes[RT_RGBA][i] = b.planes[RT_RGBA][i];
  EXPECT_TRUE(testNoise(a, b, Noise::unknown).isSame) << "they are so in both";
}

TEST_F(Noises, StandardErrorsAreThoseOfTheNoise) {
  const std::vector<float> z = standardErrors(normal(16), normal(16));
  double square = 0;
  for (const float v : z) square += double(v) * double(v) / double(z.size());
  EXPECT_NEAR(square, 1, .1);
  const Picture drawn = drawErrors(made([] { return 0.0f; }), z, true);
  for (const float v : drawn.planes.at(RT_RGBA)) EXPECT_TRUE(v >= 0 && v <= 1);
}

// --- FLIP ---

TEST(Flips, OfEqualPicturesAreZero) {
  int i = 0;
  Picture a = made([&] { return float(i++ % 7) / 7; }, 20, 10);
  EXPECT_EQ(flipOf(a, a).mean, 0);
  EXPECT_GE(flipOf(a, a).exposures, 2);
  a.linear = false;
  EXPECT_EQ(flipOf(a, a).mean, 0);
  EXPECT_EQ(flipOf(a, a).exposures, 0);
}

// The largest colour difference is that of blue and green.
TEST(Flips, OfGreenAndBlueAreOne) {
  int i = 0, j = 0;
  Picture green = made([&] { return i++ % 3 == 1 ? 1.0f : 0.0f; }, 32, 32),
          blue = made([&] { return j++ % 3 == 2 ? 1.0f : 0.0f; }, 32, 32);
  green.linear = blue.linear = false;
  EXPECT_NEAR(flipOf(green, blue).mean, 1, 1e-4);
}

// The numbers are those of the authors' program (flip-evaluator 1.7).
TEST(Flips, AreThoseOfTheAuthors) {
  constexpr int width = 60, height = 40;
  Picture pictures[2];
  for (Picture& picture : pictures) {
    picture.width = width;
    picture.height = height;
    picture.linear = false;
    for (int i = 0; i < width * height * 4; ++i) {
      const int x = i / 4 % width, y = i / 4 / width, k = i % 4;
      const float plain = float((x / 4 * 7 + y / 5 * 13 + k * 29) % 32) / 31,
                  noise = (float((x * 31 + y * 17 + k * 11) % 23) / 23 - .5f) * .3f;
      const float value = &picture == pictures ? plain : std::clamp(plain + noise, 0.0f, 1.0f);
      picture.planes[RT_RGBA].push_back(k < 3 ? value : 1);
    }
  }
  EXPECT_NEAR(flipOf(pictures[0], pictures[1]).mean, .127718, 2e-6);
  for (Picture& picture : pictures) {
    picture.linear = true;
    for (float& v : picture.planes[RT_RGBA]) v = v * v * 20;
  }
  const Flip flip = flipOf(pictures[0], pictures[1]);
  EXPECT_NEAR(flip.mean, .135840, 2e-6);
  EXPECT_EQ(flip.exposures, 2);
}

} // namespace
