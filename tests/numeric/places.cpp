// places.cpp: RT_PLACE tells where in its pixel the first sample was taken: the position of what it
// has hit says the same.
#include "numeric/support.h"

namespace numeric {
namespace {

constexpr int width = 9, height = 6;
constexpr double viewHeight = 3;

class Places : public Scene {
 protected:
  // Looks straight down -z at a square whose right edge is in the middle of the picture.
  void SetUp() override {
    Scene::SetUp();
    rtPushMatrix();
    rtTranslated(-10, 0, 0);
    placeAt(0, square(matt(.5)));
    rtPopMatrix();
    rtPushMatrix();
    rtTranslated(0, 0, 20);
    rtOrtho(viewHeight);
    rtPopMatrix();
    rtFrameBuffer(width, height, RT_RGBA | RT_POSITION | RT_DEPTH | RT_PLACE);
  }
  static std::vector<float> read(RTenum channel, size_t numbers) {
    std::vector<float> v(numbers * width * height);
    rtReadPixels(channel, v.data(), v.size());
    return v;
  }
};

} // namespace

TEST_F(Places, AgreeWithThePositionsOfHits) {
  rtQuality(RT_JITTER, 1);
  int hits = 0, misses = 0;
  for (int seed = 0; seed < 8; seed++) {
    rtQuality(RT_SEED, seed);
    rtRender();
    const std::vector<float> place = read(RT_PLACE, 2), position = read(RT_POSITION, 3),
                             depth = read(RT_DEPTH, 1);
    for (size_t i = 0; i < depth.size(); i++) {
      ASSERT_GE(place[2 * i], 0);
      ASSERT_LE(place[2 * i], 1);
      ASSERT_GE(place[2 * i + 1], 0);
      ASSERT_LE(place[2 * i + 1], 1);
      const double x = (double(i % width) + double(place[2 * i]) - width / 2.0),
                   y = (height / 2.0 - double(i / width) - double(place[2 * i + 1]));
      if (std::isfinite(depth[i])) {
        hits++;
        EXPECT_NEAR(position[3 * i], x * viewHeight / height, 1e-5);
        EXPECT_NEAR(position[3 * i + 1], y * viewHeight / height, 1e-5);
      } else {
        misses++;
        EXPECT_GT(x, -1e-5) << "the square ends in the middle";
      }
    }
  }
  EXPECT_GT(hits, 100);
  EXPECT_GT(misses, 100);
}

// Sixteen seeds in a row have one place in each sixteenth of a pixel, however that is divided.
TEST_F(Places, OfConsecutiveSeedsFillThePixels) {
  rtQuality(RT_JITTER, 1);
  for (const int first : {0, 48}) {
    std::vector<std::vector<float>> places;
    for (int seed = first; seed < first + 16; seed++) {
      rtQuality(RT_SEED, seed);
      rtRender();
      places.push_back(read(RT_PLACE, 2));
    }
    for (const int columns : {1, 2, 4, 8, 16})
      for (size_t pixel = 0; pixel < width * height; pixel++) {
        std::vector<int> counts(16);
        for (const std::vector<float>& place : places) {
          const int x = std::min(int(place[2 * pixel] * float(columns)), columns - 1),
                    rows = 16 / columns,
                    y = std::min(int(place[2 * pixel + 1] * float(rows)), rows - 1);
          counts[size_t(y * columns + x)]++;
        }
        EXPECT_EQ(counts, std::vector<int>(16, 1)) << columns << ", pixel " << pixel;
      }
  }
}

TEST_F(Places, AreTheMiddlesWithoutJitter) {
  rtRender();
  for (const float v : read(RT_PLACE, 2)) EXPECT_EQ(v, .5f);
}

} // namespace numeric
