// sparse_light.cpp: RT_LIGHT_STRIDE with paths from lamps: the light of a pixel that is lit, and
// the mean of what paths from lamps leave in the others, add up to the light of the whole picture.
#include <algorithm>
#include <vector>

#include "drawing.h"
#include "numeric/support.h"

namespace numeric {
namespace {

constexpr int width = 24, height = 18, quadrants = 4;
using Quadrants = std::array<double, quadrants>;

class SparseLampPaths : public testing::Test {
 protected:
  // A floor that fills the picture, under a small lamp whose light a glass ball gathers and a
  // mirror sends on. No pixel sees the environment, which would be light of its own in every frame.
  static void draw() {
    using namespace drawing;
    rtLoadIdentity();
    at(0, 0, 0, square(colored("Diffuse", "reflectance", {.7f, .7f, .7f}), 20));
    at(.8, .6, 3, square(colored("Diffuse", "emission", {20, 20, 20}), .3f), 180);
    at(-.3, .2, .8, ball(colored("Glass", nullptr, {}), .5f));
    at(.6, -.9, .6, square(colored("Mirror", nullptr, {}), .5f), -80);
    lookFrom(0, -2, 5);
    rtFrameBuffer(width, height, RT_RGBA | RT_SAMPLES);
    rtQuality(RT_TRANSPORT, RT_TRANSPORT_LIGHT);
    rtQuality(RT_SAMPLES_PER_PIXEL, 1);
    rtQuality(RT_JITTER, 1);
    rtQuality(RT_MAX_DEPTH, 6);
  }

  // One frame: colour and samples of each pixel.
  struct Frame {
    std::vector<float> rgba, samples;
    double lightOf(size_t pixel) const {
      return double(rgba[4 * pixel]) + double(rgba[4 * pixel + 1]) + double(rgba[4 * pixel + 2]);
    }
  };
  static Frame render(int stride, int seed) {
    rtQuality(RT_LIGHT_STRIDE, stride);
    rtQuality(RT_SEED, seed);
    rtRender();
    return {drawing::readChannel(RT_RGBA, width, height),
            drawing::readChannel(RT_SAMPLES, width, height)};
  }
  static size_t quadrantOf(size_t pixel) {
    return size_t(pixel % width >= width / 2) + 2 * size_t(pixel / width >= height / 2);
  }

  // The light of quadrants of the picture, from frames of consecutive seeds in which every pixel is
  // lit once.
  struct Round {
    Quadrants lit{}, others{}, dense{};
  };
  static Round renderRound(int stride, int firstSeed) {
    Round round;
    const int frames = stride * stride;
    const double pixels = width * height / double(quadrants);
    std::vector<int> times(width * height);
    for (int seed = firstSeed; seed < firstSeed + frames; seed++) {
      const Frame sparse = render(stride, seed), dense = render(1, seed);
      for (size_t pixel = 0; pixel < times.size(); pixel++) {
        const size_t k = quadrantOf(pixel);
        const bool lit = sparse.samples[pixel] > 0;
        times[pixel] += lit;
        if (lit)
          round.lit[k] += sparse.lightOf(pixel) / pixels;
        else
          round.others[k] += sparse.lightOf(pixel) / pixels / (frames - 1);
        round.dense[k] += dense.lightOf(pixel) / pixels / frames;
      }
    }
    for (const int count : times) EXPECT_EQ(count, 1);
    return round;
  }

  // Renders rounds and compares the two ways to add up the light, by four standard errors.
  static void expectEqualLight(int stride, int rounds) {
    Quadrants sum{}, squares{}, dense{}, others{};
    for (int i = 0; i < rounds; i++) {
      const Round round = renderRound(stride, 1000 + i * stride * stride);
      for (size_t k = 0; k < quadrants; k++) {
        const double d = round.lit[k] + round.others[k] - round.dense[k];
        sum[k] += d / rounds;
        squares[k] += d * d / rounds;
        dense[k] += round.dense[k] / rounds;
        others[k] += round.others[k] / rounds;
      }
    }
    double clearest = 0; // light of paths from lamps, in standard errors
    for (size_t k = 0; k < quadrants; k++) {
      SCOPED_TRACE(testing::Message() << "stride " << stride << ", quadrant " << k);
      const double error = std::sqrt((squares[k] - sum[k] * sum[k]) / (rounds - 1));
      EXPECT_LT(std::fabs(sum[k]), 4 * error);
      EXPECT_LT(error, .02 * dense[k]);
      clearest = std::max(clearest, others[k] / error);
    }
    EXPECT_GT(clearest, 16) << "the light of paths from lamps would not be missed";
  }
};

TEST_F(SparseLampPaths, AndLitPixelsAddUpToTheWholeLight) {
  drawing::drawIn(drawing::contextWith(1), [] {
    draw();
    expectEqualLight(2, 200);
    expectEqualLight(3, 200);
    RTstats stats{};
    stats.size = sizeof stats;
    rtGetStats(&stats);
    EXPECT_EQ(stats.transport.chosen, RTenum(RT_TRANSPORT_LIGHT));
  });
}

} // namespace
} // namespace numeric
